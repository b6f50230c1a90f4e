#include "pos/eval/association.hpp"

#include <algorithm>

namespace pos::eval {

namespace {

Pose3 between(const TruthPose& a, const TruthPose& b, Stamp stamp) {
  const double s = seconds(stamp - a.stamp) / seconds(b.stamp - a.stamp);
  return {(1.0 - s) * a.T_map_body.translation + s * b.T_map_body.translation,
          a.T_map_body.rotation.slerp(s, b.T_map_body.rotation)};
}

bool finite(const Pose3& pose) {
  return pose.translation.allFinite() && pose.rotation.coeffs().allFinite();
}

struct Gaps {
  double coverage = 0.0;
  Duration largest{0};
};

/// Coverage and largest gap of sorted moments inside [first, last].
Gaps gapsIn(const std::vector<Stamp>& moments, Stamp first, Stamp last, Duration max_gap) {
  Duration covered{0};
  Duration largest =
      moments.empty() ? last - first : std::max(moments.front() - first, last - moments.back());
  for (std::size_t i = 1; i < moments.size(); ++i) {
    const Duration gap = moments[i] - moments[i - 1];
    largest = std::max(largest, gap);
    if (gap <= max_gap) covered += gap;
  }
  const double of_a_point = moments.empty() ? 0.0 : 1.0;
  return {last > first ? seconds(covered) / seconds(last - first) : of_a_point,
          std::max(largest, Duration{0})};
}

}  // namespace

std::optional<Pose3> interpolate(const Truth& truth, Stamp stamp, Duration max_gap) {
  const auto& poses = truth.poses;
  const auto next = std::lower_bound(poses.begin(), poses.end(), stamp,
                                     [](const TruthPose& pose, Stamp t) { return pose.stamp < t; });
  if (next == poses.end()) return std::nullopt;
  if (next->stamp == stamp) return next->T_map_body;
  if (next == poses.begin()) return std::nullopt;
  const auto previous = std::prev(next);
  if (next->stamp - previous->stamp > max_gap) return std::nullopt;
  return between(*previous, *next, stamp);
}

Matches associate(const std::vector<Estimate>& estimates, const Truth& truth,
                  const AssociationOptions& options) {
  Matches matches;
  matches.association.total = estimates.size();
  matches.association.time_offset = options.time_offset;
  std::vector<Stamp> moments;
  for (const Estimate& estimate : estimates) {
    if (!finite(estimate.T_map_body)) {
      ++matches.association.not_finite;
      continue;
    }
    const Stamp moment = estimate.stamp + options.time_offset;
    const auto T_map_truth = interpolate(truth, moment, options.max_truth_gap);
    if (!T_map_truth) continue;
    matches.pairs.push_back({estimate, moment, *T_map_truth});
    moments.push_back(moment);
  }
  matches.association.matched = matches.pairs.size();
  if (!truth.poses.empty()) {
    const Stamp first = truth.poses.front().stamp;
    const Stamp last = truth.poses.back().stamp;
    const Gaps gaps = gapsIn(moments, first, last, options.max_estimate_gap);
    matches.association.truth_span = last - first;
    matches.association.coverage = gaps.coverage;
    matches.association.largest_gap = gaps.largest;
  }
  return matches;
}

}  // namespace pos::eval
