#pragma once
/// How late one path is against another of the same vehicle, when their frames are not tied to each other.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "pos/core/stamp.hpp"

namespace pos::eval {

struct TimedPosition {
  Stamp stamp;
  Eigen::Vector2d p = Eigen::Vector2d::Zero();  ///< m
};

struct LatencyFit {
  double latency = 0.0;           ///< s, `late` tells of this long before its stamps
  double residual = 0.0;          ///< m, RMS distance after the best shift and a rigid alignment
  double residual_at_zero = 0.0;  ///< m, the same without a shift
  std::size_t pairs = 0;
};

/// Tries latencies from -window to +window (s) in steps of 10 ms: shifts `late` by it, lays it on `reference`
/// by a plane rigid motion (least squares), and takes the shift with the smallest residual, refined by a
/// parabola. `reference` is interpolated, never over more than a second. The vehicle has to move, and to turn
/// or change speed: throws DataError when fewer than ten pairs overlap or the residual hardly depends on the
/// shift.
LatencyFit fittedLatency(const std::vector<TimedPosition>& late, const std::vector<TimedPosition>& reference,
                         double window);

}  // namespace pos::eval
