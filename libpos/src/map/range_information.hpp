#pragma once
/// What one range tells about a position in the plane.

#include "pos/map/tunnel_map.hpp"

namespace pos::map {

/// Fisher information (1/m^2) of a range from `p_map` to the anchor about [along, across] of a roadway with
/// this heading, the height being known: h h' / sigma^2, h the horizontal part of the unit vector.
Eigen::Matrix2d rangeInformation(const Eigen::Vector3d& p_map, double heading, const Anchor& anchor,
                                 double range_sigma);

}  // namespace pos::map
