#pragma once
/// The plan of a mine as a surveyor would hang it on the wall: roadways with their true width, chambers,
/// anchors, lock intervals, chainage, north arrow, scale bar and legend. North (the map's y axis) is up and
/// both axes have one scale.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "pos/map/lock_intervals.hpp"
#include "pos/map/tunnel_map.hpp"
#include "pos/report/drawing.hpp"

namespace pos::report {

/// A scanned plan under the drawing.
struct PlanBackground {
  std::string bytes = {};  ///< PNG or JPEG
  int columns = 0;
  int rows = 0;
  /// map = matrix * [column, row, 1], pixels from the upper left corner of the picture, m.
  Eigen::Matrix<double, 2, 3> T_map_pixel = Eigen::Matrix<double, 2, 3>::Zero();
};

struct PlanOptions {
  double width = 0.0;      ///< px of the whole sheet; 0 = as the map needs, 1000 to 3600
  std::string level = {};  ///< only roadways of this level and what belongs to them; empty = all
  std::vector<map::LockInterval> intervals = {};
  std::optional<PlanBackground> background = {};
};

struct MapPlan {
  Drawing drawing = {};
  double metres_per_pixel = 0.0;
  std::size_t labels_left_out = 0;  ///< for lack of room; the sheet says so too
  bool widened = false;             ///< roadways too narrow to be seen are drawn 3 px wide; the sheet says so
};

/// Throws ConfigError for a map without roadways and anchors, for a level that no roadway has, and for a
/// width that is neither 0 nor 400 to 20000.
MapPlan mapPlan(const map::TunnelMap& map, const PlanOptions& options);

}  // namespace pos::report
