#include "pos/sim/rock_plan.hpp"

#include <cmath>

namespace pos::sim {
namespace {

constexpr double kTouch = 1e-6;  // m: closer than this to an end of the view does not block it

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Whether the wall cuts the view p-q: with d = q - p and e = b - a, the crossing is p + s d = a + u e.
bool blocks(const Wall& wall, const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  const Eigen::Vector2d d = (q - p).head<2>();
  const Eigen::Vector2d e = wall.b - wall.a;
  const double area = cross(d, e);
  if (std::abs(area) <= 1e-12 * d.norm() * e.norm()) return false;  // along the wall
  const Eigen::Vector2d to_wall = wall.a - p.head<2>();
  const double s = cross(to_wall, e) / area;
  const double u = cross(to_wall, d) / area;
  const double touch = kTouch / d.norm();
  if (s <= touch || s >= 1.0 - touch || u < 0.0 || u > 1.0) return false;
  const double z = p.z() + s * (q.z() - p.z());
  return wall.z_low <= z && z <= wall.z_high;
}

}  // namespace

RockPlan RockPlan::around(const Outline& open_space, double z_low, double z_high) {
  std::vector<Wall> walls;
  walls.reserve(open_space.size());
  for (std::size_t i = 0; i < open_space.size(); ++i) {
    walls.push_back(
        {.a = open_space[i], .b = open_space[(i + 1) % open_space.size()], .z_low = z_low, .z_high = z_high});
  }
  return RockPlan(std::move(walls));
}

bool RockPlan::lineOfSight(const Eigen::Vector3d& p, const Eigen::Vector3d& q) const {
  for (const Wall& wall : walls_) {
    if (blocks(wall, p, q)) return false;
  }
  return true;
}

LineOfSight RockPlan::predicate() const {
  return
      [plan = *this](const Eigen::Vector3d& p, const Eigen::Vector3d& q) { return plan.lineOfSight(p, q); };
}

RockPlan RockPlan::joined(const RockPlan& other) const {
  std::vector<Wall> walls = walls_;
  walls.insert(walls.end(), other.walls_.begin(), other.walls_.end());
  return RockPlan(std::move(walls));
}

}  // namespace pos::sim
