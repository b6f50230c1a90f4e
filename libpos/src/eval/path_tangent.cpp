#include "pos/eval/path_tangent.hpp"

#include <algorithm>

#include "pos/eval/association.hpp"

namespace pos::eval {

PathTangent::PathTangent(const Truth& truth, const PathTangentOptions& options)
    : truth_(truth), options_(options) {
  for (const TruthPose& pose : truth_.poses) {
    if (const auto unit = moving(pose.stamp)) directions_.push_back({pose.stamp, *unit});
  }
}

std::optional<Eigen::Vector2d> PathTangent::moving(Stamp stamp) const {
  const Stamp from = std::max(stamp - options_.half_window, truth_.poses.front().stamp);
  const Stamp to = std::min(stamp + options_.half_window, truth_.poses.back().stamp);
  const auto centre = interpolate(truth_, stamp, options_.max_truth_gap);
  const auto before = interpolate(truth_, from, options_.max_truth_gap);
  const auto after = interpolate(truth_, to, options_.max_truth_gap);
  const auto& a = before ? before : centre;
  const auto& b = after ? after : centre;
  if (!a || !b) return std::nullopt;
  const double elapsed = seconds((after ? to : stamp) - (before ? from : stamp));
  const Eigen::Vector2d moved = (b->translation - a->translation).head<2>();
  if (elapsed <= 0.0 || moved.norm() <= options_.standing_speed * elapsed) return std::nullopt;
  return moved.normalized();
}

std::optional<Eigen::Vector2d> PathTangent::at(Stamp stamp) const {
  if (directions_.empty()) return std::nullopt;
  if (const auto unit = moving(stamp)) return unit;
  const auto later = std::upper_bound(directions_.begin(), directions_.end(), stamp,
                                      [](Stamp t, const Direction& d) { return t < d.stamp; });
  return later == directions_.begin() ? directions_.front().unit : std::prev(later)->unit;
}

}  // namespace pos::eval
