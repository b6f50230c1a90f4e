#pragma once
/// Rays through an occupancy grid.

#include <optional>

#include "pos/map/tunnel_map.hpp"

namespace pos::sim {

/// Distance (m) from `origin` (map) along `heading` (rad, map) to the boundary of the first rock cell, 0 when
/// `origin` lies in one; nothing within `range_max`, or when the ray leaves the grid first. Rock is occupancy
/// of `rock_from` percent or more; cells never seen are passed like free ones. Exact: every cell the ray
/// crosses is visited (Amanatides and Woo 1987), O(cells crossed).
std::optional<double> rayCast(const map::OccupancyGrid& grid, const Eigen::Vector2d& origin, double heading,
                              double range_max, int rock_from = 50);

}  // namespace pos::sim
