#include "pos/sim/ray_cast.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pos::sim {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The part of a ray o + s d (in cells) that lies in the box [0, columns] x [0, rows].
struct Clip {
  double enter = 0.0;
  double leave = kNever;
};

Clip clipped(const Eigen::Vector2d& o, const Eigen::Vector2d& d, const Eigen::Vector2d& size) {
  Clip clip;
  for (int axis = 0; axis < 2; ++axis) {
    if (d[axis] == 0.0) {
      if (o[axis] < 0.0 || o[axis] > size[axis]) clip.leave = -1.0;
      continue;
    }
    const double s0 = -o[axis] / d[axis];
    const double s1 = (size[axis] - o[axis]) / d[axis];
    clip.enter = std::max(clip.enter, std::min(s0, s1));
    clip.leave = std::min(clip.leave, std::max(s0, s1));
  }
  return clip;
}

/// Progress of the ray along one axis of the grid.
struct Walk {
  int cell = 0;
  int step = 0;
  double next = kNever;   // s at which the next cell of this axis begins
  double every = kNever;  // s per cell

  Walk(double o, double d, double enter, int cells) {
    cell = std::clamp(static_cast<int>(std::floor(o + enter * d)), 0, cells - 1);
    if (d == 0.0) return;
    step = d > 0.0 ? 1 : -1;
    next = (cell + (d > 0.0 ? 1 : 0) - o) / d;
    every = 1.0 / std::abs(d);
  }
};

}  // namespace

std::optional<double> rayCast(const map::OccupancyGrid& grid, const Eigen::Vector2d& origin, double heading,
                              double range_max, int rock_from) {
  const Eigen::Vector2d corner(grid.x_min, grid.y_min);
  const Eigen::Vector2d o = (inverse(grid.T_map_grid) * origin - corner) / grid.resolution;
  const Eigen::Vector2d d(std::cos(heading - grid.T_map_grid.yaw), std::sin(heading - grid.T_map_grid.yaw));
  const Clip clip = clipped(o, d, {grid.columns, grid.rows});
  const double last = std::min(clip.leave, range_max / grid.resolution);

  Walk x(o.x(), d.x(), clip.enter, grid.columns);
  Walk y(o.y(), d.y(), clip.enter, grid.rows);
  double s = clip.enter;
  while (s <= last && x.cell >= 0 && x.cell < grid.columns && y.cell >= 0 && y.cell < grid.rows) {
    const std::uint8_t occupancy = grid.at(x.cell, y.cell);
    if (occupancy != map::OccupancyGrid::kUnknown && occupancy >= rock_from) return s * grid.resolution;
    Walk& nearer = x.next < y.next ? x : y;
    s = nearer.next;
    nearer.next += nearer.every;
    nearer.cell += nearer.step;
  }
  return {};
}

}  // namespace pos::sim
