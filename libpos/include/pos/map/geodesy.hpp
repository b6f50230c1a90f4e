#pragma once
/// The map's tie to the Earth.

#include <Eigen/Core>

#include "pos/map/tunnel_map.hpp"

namespace pos::map {

/// WGS84 to the map's local frame and back: east-north-up about the origin, turned by the grid's rotation.
/// Exact (GeographicLib), not a flat-earth approximation. Angles in radians, heights in m above the
/// ellipsoid.
class LocalFrame {
 public:
  explicit LocalFrame(const GeodeticOrigin& origin) : origin_(origin) {}

  /// Map coordinates (m).
  Eigen::Vector3d fromGeodetic(double latitude, double longitude, double altitude) const;
  /// Latitude, longitude (rad) and altitude (m) of a map point; fields of a GeodeticOrigin, rotation zero.
  GeodeticOrigin toGeodetic(const Eigen::Vector3d& p_map) const;

 private:
  GeodeticOrigin origin_;
};

}  // namespace pos::map
