#pragma once
/// Multilateration without iterating, from differences of squared ranges.

#include <optional>

#include "gauss_newton.hpp"
#include "pos/uwb/multilateration.hpp"

namespace pos::uwb::detail {

/// Centre of the anchors and their principal axes.
struct AnchorShape {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  Eigen::Vector2d across = Eigen::Vector2d::UnitY();
  double spread_along = 0.0;   ///< m
  double spread_across = 0.0;  ///< m

  bool onePlace() const;
  /// The anchors of `ranges` count as one line; two of them always do.
  bool inLine(std::size_t ranges) const;
  /// Wider than a line, yet narrow enough for a fit to end on the wrong side.
  bool nearlyInLine() const;
  /// The other side of the line.
  Eigen::Vector2d mirrored(const Eigen::Vector2d& p) const {
    return p - 2.0 * across.dot(p - centre) * across;
  }
};
AnchorShape shapeOf(std::span<const TagRange> ranges);

/// The place that the squared ranges with a weight agree on best; nothing when their anchors are in line.
std::optional<Eigen::Vector2d> linearStart(std::span<const TagRange> ranges, const Weights& weights);

/// Coordinates about the line of anchors: along it from differenced squares, the square of the distance from
/// it from what remains.
struct LineStart {
  double along = 0.0;
  double across_squared = 0.0;
  double sigma_of_along = 0.0;   ///< m
  double sigma_of_square = 0.0;  ///< m^2, of across_squared
};
LineStart lineStart(std::span<const TagRange> ranges, const AnchorShape& shape);

/// Places to start a fit from.
struct Starts {
  std::array<Eigen::Vector2d, 2> places;
  int count = 0;

  std::span<const Eigen::Vector2d> all() const { return {places.data(), static_cast<std::size_t>(count)}; }
};
/// Both sides of the line of anchors, a sigma apart from it at least.
Starts bothSides(const AnchorShape& shape, const LineStart& start);
/// The linear place and its mirror image where the anchors are nearly in line, both sides of their line where
/// they are in line. None for fewer than two anchors.
Starts startingPlaces(std::span<const TagRange> ranges, const Weights& weights);

}  // namespace pos::uwb::detail
