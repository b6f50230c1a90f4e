#pragma once
/// The direction the truth moves in, for splitting an error into along-track and cross-track.

#include <optional>
#include <vector>

#include "pos/core/estimate.hpp"

namespace pos::eval {

struct PathTangentOptions {
  Duration half_window = durationFromSeconds(0.5);  ///< positions this long before and after are compared
  double standing_speed = 0.1;                      ///< m/s; slower than this the last direction is held
  Duration max_truth_gap = durationFromSeconds(1.0);
};

/// Unit vector of horizontal motion over the truth's path. It comes from positions, not from the heading, so
/// it needs no yaw, and points backward while the vehicle reverses.
class PathTangent {
 public:
  explicit PathTangent(const Truth& truth, const PathTangentOptions& options = {});

  /// Direction at `stamp`; while standing the last one before it, before the first motion the first one to
  /// come. Nothing for a truth that never moves.
  std::optional<Eigen::Vector2d> at(Stamp stamp) const;

 private:
  std::optional<Eigen::Vector2d> moving(Stamp stamp) const;

  struct Direction {
    Stamp stamp;
    Eigen::Vector2d unit;
  };
  Truth truth_;
  PathTangentOptions options_;
  std::vector<Direction> directions_;  ///< at truth poses where the vehicle moves
};

}  // namespace pos::eval
