#pragma once
/// Between the coordinates of an Earth model and the map.

#include <memory>
#include <optional>

#include "pos/ins/earth.hpp"
#include "pos/map/geodesy.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::estimation {

/// Flat: coordinates are the map's metres. Ellipsoid: through the map's tie to the Earth.
class MapEarth {
 public:
  /// Throws ConfigError when the ellipsoid is wanted and the map has no origin; `key` names the option.
  MapEarth(const ins::Earth& earth, const map::TunnelMap& map, const std::string& key);

  const ins::Earth& earth() const { return earth_; }
  Eigen::Vector3d coordinates(const Eigen::Vector3d& p_map) const;
  Eigen::Vector3d position(const Eigen::Vector3d& coordinates) const;
  /// Axes of n (east north up there) seen in the map: grid rotation and meridian convergence.
  Eigen::Matrix3d R_map_n(const Eigen::Vector3d& coordinates) const;

 private:
  ins::Earth earth_;
  std::optional<map::LocalFrame> frame_;
};

}  // namespace pos::estimation
