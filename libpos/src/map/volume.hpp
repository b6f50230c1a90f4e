#pragma once
/// The open space of a mine as convex pieces: slices of roadways and chambers with upright walls.

#include <optional>
#include <vector>

#include "box_tree.hpp"
#include "pos/map/centreline.hpp"
#include "pos/map/furniture.hpp"

namespace pos::map {

/// Points with s in [s_min, s_max], n in [n_min, n_max] and h in [0, height], where s runs along `axis` in
/// plan, n to its left and h is the height above a floor that starts at origin.z() and rises by `grade`.
struct Volume {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();
  double s_min = 0.0;
  double s_max = 0.0;
  double n_min = 0.0;
  double n_max = 0.0;
  double grade = 0.0;
  double height = 0.0;
  double arch_radius = 0.0;  ///< of the roof over n = 0; 0 for a flat roof

  /// (s, n, h) of a point.
  Eigen::Vector3d local(const Eigen::Vector3d& p_map) const;
  Box box() const;
  bool holds(const Eigen::Vector3d& p_map, double slack) const;
};

/// The part of a line inside a volume, as shares of its length.
struct Part {
  double begin = 0.0;
  double end = 1.0;
};
/// The part of the line from `a` to `b` inside the volume grown by `slack` (m); a flat roof is assumed.
std::optional<Part> partInside(const Volume& volume, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               double slack);

/// A roadway's slices: one a line, several an arc (1 cm off at most), mitred at kinks.
std::vector<Volume> slices(const Roadway& roadway, const Centreline& centreline);
/// The niche from the middle of its roadway to its back.
Volume niche(const Chamber& chamber, const Roadway& roadway, const Centreline& centreline);

}  // namespace pos::map
