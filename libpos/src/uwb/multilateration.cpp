#include "pos/uwb/multilateration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gauss_newton.hpp"
#include "linear_start.hpp"

namespace pos::uwb {
namespace {

using detail::Weights;

constexpr double kSamePlace = 1e-3;  // m

struct TagModel {
  std::span<const TagRange> ranges;

  auto at(const Eigen::Vector2d& p) const {
    return [this, p](int i) {
      const TagRange& range = ranges[static_cast<std::size_t>(i)];
      const Eigen::Vector2d between = p - range.anchor;
      const double distance = std::max(std::sqrt(between.squaredNorm() + range.height * range.height), 1e-9);
      return detail::Linearised<2>{range.range - distance, between / distance};
    };
  }

  Eigen::Vector2d start(const Eigen::Vector2d& x, const Weights& weights) const {
    return detail::linearStart(ranges, weights).value_or(x);
  }
};

/// Adds the place next to `start`.
void add(TagFixes& fixes, const TagModel& model, const Weights& weights, const Eigen::Vector2d& start,
         const ResidualTest& test) {
  if (fixes.count == 2) return;
  const auto robust = detail::robustFit<2>(model, start, weights, test);
  TagFix fix;
  if (!robust.fit.solved || !detail::invert<2>(robust.fit.normal.information, fix.covariance)) return;
  for (const TagFix& other : fixes.all()) {
    if ((other.p_map - robust.fit.x).norm() < kSamePlace) return;
  }
  fix.p_map = robust.fit.x;
  fix.covariance *= robust.inflation;
  fix.chi_square = robust.fit.normal.cost;
  fix.dof = robust.used - 2;
  fix.used = detail::maskOf(robust.weights);
  fix.consistent = robust.consistent;
  fixes.fixes[static_cast<std::size_t>(fixes.count++)] = fix;
}

TagFixes judged(TagFixes fixes, std::size_t ranges) {
  if (fixes.count == 0) {
    fixes.verdict = FixVerdict::Degenerate;
    return fixes;
  }
  if (fixes.count == 2) {
    if (detail::against(fixes.fixes[1], ranges) < detail::against(fixes.fixes[0], ranges)) {
      std::swap(fixes.fixes[0], fixes.fixes[1]);
    }
    const bool ruled_out =
        detail::against(fixes.fixes[1], ranges) > detail::against(fixes.fixes[0], ranges) + kRuledOut;
    if (ruled_out) fixes.count = 1;
  }
  fixes.verdict = fixes.count == 1 ? FixVerdict::Solved : FixVerdict::Ambiguous;
  return fixes;
}

/// On the line of the anchors: the distance from it is known by its square only, either way.
void addOnLine(TagFixes& fixes, const TagModel& model, const Weights& weights,
               const detail::AnchorShape& shape, const detail::LineStart& start) {
  TagFix fix;
  fix.p_map = shape.centre + start.along * shape.along;
  const double across = std::max(start.across_squared, 0.0) + start.sigma_of_square;
  fix.covariance = std::pow(start.sigma_of_along, 2) * shape.along * shape.along.transpose() +
                   across * shape.across * shape.across.transpose();
  const Eigen::Vector2d aside = std::sqrt(std::max(start.across_squared, 0.0)) * shape.across;
  fix.chi_square = detail::normalEquations<2>(model, fix.p_map + aside, weights).cost;
  fix.dof = static_cast<int>(model.ranges.size()) - 2;
  fix.used = detail::maskOf(weights);
  fixes.fixes[0] = fix;
  fixes.count = 1;
}

/// Both sides of the line; too near to it to tell them apart, the line itself.
void addBothSides(TagFixes& fixes, const TagModel& model, const Weights& weights,
                  const detail::AnchorShape& shape, const ResidualTest& test) {
  const detail::LineStart start = detail::lineStart(model.ranges, shape);
  if (start.across_squared < 2.0 * start.sigma_of_square) {
    addOnLine(fixes, model, weights, shape, start);
    return;
  }
  const auto sides = detail::bothSides(shape, start);
  for (const Eigen::Vector2d& side : sides.all()) add(fixes, model, weights, side, test);
}

}  // namespace

TagFixes multilaterated(std::span<const TagRange> ranges, const ResidualTest& test) {
  TagFixes fixes;
  if (ranges.size() < 2) return fixes;
  const TagModel model{ranges};
  const Weights weights = detail::weightsOf(ranges);
  const detail::AnchorShape shape = detail::shapeOf(ranges);
  fixes.verdict = FixVerdict::Degenerate;
  if (shape.onePlace()) return fixes;
  if (shape.inLine(ranges.size())) {
    addBothSides(fixes, model, weights, shape, test);
    return judged(fixes, ranges.size());
  }
  if (const auto start = detail::linearStart(ranges, weights)) add(fixes, model, weights, *start, test);
  if (fixes.count == 1 && (shape.nearlyInLine() || !fixes.fixes[0].consistent)) {
    add(fixes, model, weights, shape.mirrored(fixes.fixes[0].p_map), test);
  }
  return judged(fixes, ranges.size());
}

Dilution dilutionAt(const Eigen::Vector2d& p_map, std::span<const TagRange> ranges) {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  const TagModel model{ranges};
  const auto view = model.at(p_map);
  for (int i = 0; i < static_cast<int>(ranges.size()); ++i) {
    information += view(i).row * view(i).row.transpose();
  }
  Eigen::Matrix2d inverse;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (!detail::invert<2>(information, inverse)) return {kNone, kNone, kNone};
  return {std::sqrt(inverse(0, 0)), std::sqrt(inverse(1, 1)), std::sqrt(inverse.trace())};
}

}  // namespace pos::uwb
