#pragma once
/// Shapes in plan for drawings and rasters: roadways between their walls, chambers, stretches.

#include <vector>

#include "pos/map/centreline.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::map {

/// A closed polygon or an open line in plan, m.
using PlanLine = std::vector<Eigen::Vector2d>;

/// Chainages from `from` to `to` (also the other way round) with both ends and every surveyed point between,
/// so close that straight lines between them leave a line drawn at `reach` (m) beside the centreline by no
/// more than `tolerance` (m).
std::vector<double> sampleChainages(const Centreline& centreline, double from, double to, double tolerance,
                                    double reach = 0.0);

/// The line at an offset (m, to the left positive) from the centreline. At a kink between two segments it
/// follows the mitre, so that walls stay parallel to the centreline.
PlanLine offsetLine(const Centreline& centreline, const std::vector<double>& chainages, double offset);

/// Polygon between two offsets along a stretch.
PlanLine strip(const Centreline& centreline, double from, double to, double left_offset, double right_offset,
               double tolerance);

/// The niche of a chamber, from the wall into the rock; it starts `overlap` (m) inside the roadway.
PlanLine chamberOutline(const Roadway& roadway, const Centreline& centreline, const Chamber& chamber,
                        double tolerance, double overlap = 0.0);

}  // namespace pos::map
