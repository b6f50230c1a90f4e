#pragma once
/// What blocks the view between two points: walls in plan.

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "pos/sim/zone.hpp"

namespace pos::sim {

/// True when nothing stands between two points of the map (m).
using LineOfSight = std::function<bool(const Eigen::Vector3d&, const Eigen::Vector3d&)>;

/// An upright wall over the plan segment a-b.
struct Wall {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();  ///< m
  Eigen::Vector2d b = Eigen::Vector2d::Zero();  ///< m
  double z_low = -1e9;                          ///< m
  double z_high = 1e9;                          ///< m
};

/// Walls of a site. A view is blocked when it crosses a wall, or touches one other than with its own ends:
/// anchors bolted to a wall see out of it. A view along a wall is free. O(walls).
class RockPlan {
 public:
  RockPlan() = default;
  explicit RockPlan(std::vector<Wall> walls) : walls_(std::move(walls)) {}
  /// The walls along the outline of an open space (a roadway, a hall), from `z_low` to `z_high`.
  static RockPlan around(const Outline& open_space, double z_low = -1e9, double z_high = 1e9);

  bool lineOfSight(const Eigen::Vector3d& p, const Eigen::Vector3d& q) const;
  /// The same as a function object, which keeps its own copy of the walls.
  LineOfSight predicate() const;

  const std::vector<Wall>& walls() const { return walls_; }
  /// Both plans' walls: a loop is the outline of its outside and that of its pillar.
  RockPlan joined(const RockPlan& other) const;

 private:
  std::vector<Wall> walls_ = {};
};

}  // namespace pos::sim
