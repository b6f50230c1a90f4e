#include "pos/uwb/multilateration.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "gauss_newton.hpp"
#include "linear_start.hpp"
#include "pos/core/error.hpp"

namespace pos::uwb {
namespace {

using detail::Weights;

constexpr double kInLine = 0.1;  // spread across over spread along below which anchors count as one line
constexpr double kNearlyInLine = 0.5;  // below this the mirror image is tried as well
constexpr double kOnePlace = 1e-3;     // m, spread of anchors that are all in one place
constexpr double kSamePlace = 1e-3;    // m
constexpr double kAmbiguous =
    13.8;  // difference of chi^2 from which the worse place is ruled out (1 in 1000)

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

  Eigen::Vector2d start(const Eigen::Vector2d& x, const Weights& weights) const;
};

Weights weightsOf(std::span<const TagRange> ranges) {
  ensure(ranges.size() <= static_cast<std::size_t>(kMaxRanges), "too many ranges in one fit");
  Weights weights(static_cast<Eigen::Index>(ranges.size()));
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    weights[static_cast<Eigen::Index>(i)] = 1.0 / (ranges[i].sigma * ranges[i].sigma);
  }
  return weights;
}

double levelSquared(const TagRange& range) {
  return std::max(range.range * range.range - range.height * range.height, 0.0);
}

/// Weighted centre of the anchors and their principal axes.
struct AnchorShape {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  Eigen::Vector2d across = Eigen::Vector2d::UnitY();
  double spread_along = 0.0;   ///< m
  double spread_across = 0.0;  ///< m

  double ratio() const { return spread_across / spread_along; }
};

AnchorShape shapeOf(std::span<const TagRange> ranges) {
  AnchorShape shape;
  const double n = static_cast<double>(ranges.size());
  for (const TagRange& range : ranges) shape.centre += range.anchor / n;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const TagRange& range : ranges) {
    const Eigen::Vector2d d = range.anchor - shape.centre;
    scatter += d * d.transpose() / n;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(scatter);
  shape.along = axes.eigenvectors().col(1).normalized();
  shape.across = {-shape.along.y(), shape.along.x()};
  shape.spread_along = std::sqrt(std::max(axes.eigenvalues()[1], 0.0));
  shape.spread_across = std::sqrt(std::max(axes.eigenvalues()[0], 0.0));
  return shape;
}

}  // namespace

/// 2 (a_j - a)' p = |a_j|^2 - rho_j^2 less its mean, weighted by how sure rho_j^2 is. Written about the
/// centre of the anchors, so that no anchor is special and map coordinates of a million metres lose no
/// digits.
std::optional<Eigen::Vector2d> detail::linearStart(std::span<const TagRange> ranges, const Weights& weights) {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const TagRange& r : ranges) centre += r.anchor / static_cast<double>(ranges.size());
  const auto weight = [&](std::size_t i) {
    return weights[static_cast<Eigen::Index>(i)] / std::pow(2.0 * std::max(ranges[i].range, 0.1), 2);
  };
  const auto rhs = [&](const TagRange& r) { return (r.anchor - centre).squaredNorm() - levelSquared(r); };
  double total = 0.0;
  double mean_rhs = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    total += weight(i);
    mean += weight(i) * (ranges[i].anchor - centre);
    mean_rhs += weight(i) * rhs(ranges[i]);
  }
  mean /= total;
  mean_rhs /= total;
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const Eigen::Vector2d row = 2.0 * (ranges[i].anchor - centre - mean);
    A += weight(i) * row * row.transpose();
    b += weight(i) * (rhs(ranges[i]) - mean_rhs) * row;
  }
  const Eigen::LLT<Eigen::Matrix2d> factor(A);
  if (factor.info() != Eigen::Success || factor.rcond() < kInLine * kInLine) return std::nullopt;
  const Eigen::Vector2d p = factor.solve(b);
  return p.allFinite() ? std::optional<Eigen::Vector2d>(centre + p) : std::nullopt;
}

namespace {

Eigen::Vector2d TagModel::start(const Eigen::Vector2d& x, const Weights& weights) const {
  return detail::linearStart(ranges, weights).value_or(x);
}

/// Coordinates about the line of anchors: along it from differenced squares, the square of the distance from
/// it from what remains.
struct LineStart {
  double along = 0.0;
  double across_squared = 0.0;
  double sigma_of_along = 0.0;   ///< m
  double sigma_of_square = 0.0;  ///< m^2, of across_squared
};

LineStart lineStart(std::span<const TagRange> ranges, const AnchorShape& shape) {
  const auto u = [&](const TagRange& r) { return shape.along.dot(r.anchor - shape.centre); };
  const auto weight = [](const TagRange& r) {
    return 1.0 / std::pow(2.0 * std::max(r.range, 0.1) * r.sigma, 2);  // of a squared range
  };
  double total = 0.0;
  double mean_u = 0.0;
  double mean_rhs = 0.0;
  for (const TagRange& r : ranges) total += weight(r);
  for (const TagRange& r : ranges) {
    mean_u += weight(r) / total * u(r);
    mean_rhs += weight(r) / total * (u(r) * u(r) - levelSquared(r));
  }
  double numerator = 0.0;
  double denominator = 0.0;
  for (const TagRange& r : ranges) {
    const double row = 2.0 * (u(r) - mean_u);
    numerator += weight(r) * row * (u(r) * u(r) - levelSquared(r) - mean_rhs);
    denominator += weight(r) * row * row;
  }
  LineStart start;
  start.along = numerator / denominator;
  start.sigma_of_along = std::sqrt(1.0 / denominator);
  start.sigma_of_square = std::sqrt(1.0 / total);
  for (const TagRange& r : ranges) {
    start.across_squared += weight(r) / total * (levelSquared(r) - std::pow(start.along - u(r), 2));
  }
  return start;
}

double hdopOf(const TagModel& model, const Eigen::Vector2d& p, const Weights& weights) {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  const auto view = model.at(p);
  for (int i = 0; i < static_cast<int>(weights.size()); ++i) {
    if (weights[i] > 0.0) information += view(i).row * view(i).row.transpose();
  }
  Eigen::Matrix2d inverse;
  if (!detail::invert<2>(information, inverse)) return std::numeric_limits<double>::infinity();
  return std::sqrt(inverse.trace());
}

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
  fix.hdop = hdopOf(model, fix.p_map, robust.weights);
  fix.used = detail::maskOf(robust.weights);
  fix.consistent = robust.consistent;
  fixes.fixes[static_cast<std::size_t>(fixes.count++)] = fix;
}

/// What speaks against a place: its residuals, and every range that it has to leave out.
double against(const TagFix& fix, std::size_t ranges) {
  const auto left_out = static_cast<double>(ranges) - std::popcount(fix.used);
  return fix.chi_square + kAmbiguous * left_out + (fix.consistent ? 0.0 : kAmbiguous * kMaxRanges);
}

TagFixes judged(TagFixes fixes, std::size_t ranges) {
  if (fixes.count == 0) {
    fixes.verdict = FixVerdict::Degenerate;
    return fixes;
  }
  if (fixes.count == 2) {
    if (against(fixes.fixes[1], ranges) < against(fixes.fixes[0], ranges)) {
      std::swap(fixes.fixes[0], fixes.fixes[1]);
    }
    const bool ruled_out = against(fixes.fixes[1], ranges) > against(fixes.fixes[0], ranges) + kAmbiguous;
    if (ruled_out) fixes.count = 1;
  }
  fixes.verdict = fixes.count == 1 ? FixVerdict::Solved : FixVerdict::Ambiguous;
  return fixes;
}

/// On the line of the anchors: the distance from it is known by its square only, either way.
void addOnLine(TagFixes& fixes, const TagModel& model, const Weights& weights, const AnchorShape& shape,
               const LineStart& start) {
  TagFix fix;
  fix.p_map = shape.centre + start.along * shape.along;
  const double across = std::max(start.across_squared, 0.0) + start.sigma_of_square;
  fix.covariance = std::pow(start.sigma_of_along, 2) * shape.along * shape.along.transpose() +
                   across * shape.across * shape.across.transpose();
  const Eigen::Vector2d aside = std::sqrt(std::max(start.across_squared, 0.0)) * shape.across;
  fix.chi_square = detail::normalEquations<2>(model, fix.p_map + aside, weights).cost;
  fix.dof = static_cast<int>(model.ranges.size()) - 2;
  fix.hdop = std::numeric_limits<double>::infinity();
  fix.used = detail::maskOf(weights);
  fixes.fixes[0] = fix;
  fixes.count = 1;
}

/// Both sides of the line; too near to it to tell them apart, the line itself.
void addBothSides(TagFixes& fixes, const TagModel& model, const Weights& weights, const AnchorShape& shape,
                  const ResidualTest& test) {
  const LineStart start = lineStart(model.ranges, shape);
  if (start.across_squared < 2.0 * start.sigma_of_square) {
    addOnLine(fixes, model, weights, shape, start);
    return;
  }
  const Eigen::Vector2d foot = shape.centre + start.along * shape.along;
  const Eigen::Vector2d aside = std::sqrt(start.across_squared) * shape.across;
  add(fixes, model, weights, foot + aside, test);
  add(fixes, model, weights, foot - aside, test);
}

}  // namespace

detail::Starts detail::startingPlaces(std::span<const TagRange> ranges, const Weights& weights) {
  Starts starts;
  const auto add = [&](const Eigen::Vector2d& p) {
    starts.places[static_cast<std::size_t>(starts.count++)] = p;
  };
  const AnchorShape shape = shapeOf(ranges);
  if (ranges.size() < 2 || !(shape.spread_along > kOnePlace)) return starts;
  const bool in_line = ranges.size() == 2 || shape.ratio() < kInLine;
  const auto place = in_line ? std::nullopt : linearStart(ranges, weights);
  if (!place) {
    const LineStart start = lineStart(ranges, shape);
    const Eigen::Vector2d foot = shape.centre + start.along * shape.along;
    const double aside = std::sqrt(std::max(start.across_squared, start.sigma_of_square));
    add(foot + aside * shape.across);
    add(foot - aside * shape.across);
  } else {
    add(*place);
    if (shape.ratio() < kNearlyInLine) {
      add(*place - 2.0 * shape.across.dot(*place - shape.centre) * shape.across);
    }
  }
  return starts;
}

TagFixes multilaterated(std::span<const TagRange> ranges, const ResidualTest& test) {
  TagFixes fixes;
  if (ranges.size() < 2) return fixes;
  const TagModel model{ranges};
  const Weights weights = weightsOf(ranges);
  const AnchorShape shape = shapeOf(ranges);
  fixes.verdict = FixVerdict::Degenerate;
  if (!(shape.spread_along > kOnePlace)) return fixes;
  if (ranges.size() == 2 || shape.ratio() < kInLine) {
    addBothSides(fixes, model, weights, shape, test);
    return judged(fixes, ranges.size());
  }
  if (const auto start = detail::linearStart(ranges, weights)) add(fixes, model, weights, *start, test);
  if (fixes.count == 1 && (shape.ratio() < kNearlyInLine || !fixes.fixes[0].consistent)) {
    const double aside = shape.across.dot(fixes.fixes[0].p_map - shape.centre);
    add(fixes, model, weights, fixes.fixes[0].p_map - 2.0 * aside * shape.across, test);
  }
  return judged(fixes, ranges.size());
}

TagFixes multilateratedNear(std::span<const TagRange> ranges, const Eigen::Vector2d& start,
                            const ResidualTest& test) {
  TagFixes fixes;
  if (ranges.size() < 2) return fixes;
  add(fixes, TagModel{ranges}, weightsOf(ranges), start, test);
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
