#pragma once
/// Pairs recorded estimates with the truth at the same moment.

#include <cstddef>
#include <optional>
#include <vector>

#include "pos/core/estimate.hpp"

namespace pos::eval {

struct AssociationOptions {
  /// Truth poses further apart than this are not bridged: an estimate between them has no truth.
  Duration max_truth_gap = durationFromSeconds(1.0);
  /// Estimates further apart than this leave the time between them uncovered.
  Duration max_estimate_gap = durationFromSeconds(2.0);
  /// Added to an estimate's stamp before the truth is asked (clock of the truth - clock of the log).
  Duration time_offset{0};
};

/// The truth at `stamp`: position linear, rotation by slerp (the short way round). Nothing before the first
/// pose, after the last, or between two poses further apart than `max_gap`. O(log n).
std::optional<Pose3> interpolate(const Truth& truth, Stamp stamp, Duration max_gap);

/// How much of the run the comparison with the truth rests on.
struct Association {
  std::size_t total = 0;       ///< estimates recorded
  std::size_t matched = 0;     ///< of these, with a truth to compare to
  std::size_t not_finite = 0;  ///< of these, left out because the pose holds a NaN or infinity
  /// Share of the truth's time span with matched estimates no further apart than max_estimate_gap, 0..1.
  double coverage = 0.0;
  Duration largest_gap{0};  ///< longest time inside the truth's span without a matched estimate
  Duration truth_span{0};
  Duration time_offset{0};  ///< the one that was applied
};

struct MatchedPose {
  Estimate estimate;
  Stamp truth_stamp;  ///< the estimate's stamp on the truth's clock
  Pose3 T_map_truth;  ///< truth at that moment
};

struct Matches {
  std::vector<MatchedPose> pairs;
  Association association;
};

/// Every estimate with the truth at its stamp. Estimates in the order of their stamps.
Matches associate(const std::vector<Estimate>& estimates, const Truth& truth,
                  const AssociationOptions& options = {});

}  // namespace pos::eval
