#pragma once
/// Where on the way under ground a vehicle is, by the portals of the map.

#include <memory>
#include <optional>
#include <vector>

#include "pos/map/network.hpp"

namespace pos::estimation {

enum class Zone {
  Unknown,      ///< the map has no portals, or the place is not sure enough
  Surface,      ///< satellites
  Handover,     ///< satellites and radio
  Underground,  ///< radio
};

/// On a roadway with a portal the rock begins at the end of the hand-over zone that is further from the
/// portal itself; a roadway without one is under ground.
class PortalZones {
 public:
  explicit PortalZones(const std::shared_ptr<const map::TunnelMap>& map);

  /// `sigma` (m) is how sure the place is along the road: three times that and `margin` (m) are kept off the
  /// borders of darkness. More than 10 m: Unknown.
  Zone at(const Eigen::Vector3d& p_map, double sigma, double margin) const;
  /// Height of the floor at the place (m, map); nothing away from the roadways.
  std::optional<double> floorAt(const Eigen::Vector3d& p_map) const;

 private:
  std::optional<map::Network> network_;  // none for a map without roadways
};

}  // namespace pos::estimation
