#pragma once
/// Relative pose error: how far the estimate drifts over a stretch of path or time.

#include <vector>

#include "pos/eval/errors.hpp"
#include "pos/eval/statistics.hpp"

namespace pos::eval {

/// Errors over all stretches of one length or duration. Planar: x, y, yaw.
struct RelativeError {
  double length = 0.0;     ///< m along the truth; 0 for a stretch of time
  double duration = 0.0;   ///< s; 0 for a stretch of path
  Statistics translation;  ///< m
  Statistics yaw;          ///< rad; count 0 where the truth has no heading
};

struct RelativeErrorOptions {
  std::vector<double> lengths{10.0, 50.0, 100.0};  ///< m
  std::vector<double> durations{1.0, 10.0, 60.0};  ///< s
};

/// For every sample i and the first sample j at least the stretch later: the difference between the estimated
/// and the true motion from i to j. With a heading in the truth the motions are compared in the body frame at
/// i (so a wrong heading at i does not count); without one in map axes (so it does). Stretches that do not
/// fit have count 0. O(n) per stretch.
std::vector<RelativeError> relativeErrors(const ErrorSeries& series, const RelativeErrorOptions& options);

}  // namespace pos::eval
