#include "linear_start.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace pos::uwb::detail {
namespace {

constexpr double kInLine = 0.1;  // spread across over spread along below which anchors count as one line
constexpr double kNearlyInLine = 0.5;  // below this the mirror image is tried as well
constexpr double kOnePlace = 1e-3;     // m, spread of anchors that are all in one place

double levelSquared(const TagRange& range) {
  return std::max(range.range * range.range - range.height * range.height, 0.0);
}

}  // namespace

bool AnchorShape::onePlace() const {
  return !(spread_along > kOnePlace);
}

bool AnchorShape::inLine(std::size_t ranges) const {
  return ranges == 2 || spread_across < kInLine * spread_along;
}

bool AnchorShape::nearlyInLine() const {
  return spread_across < kNearlyInLine * spread_along;
}

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

/// 2 (a_j - a)' p = |a_j|^2 - rho_j^2 less its mean, weighted by how sure rho_j^2 is. Written about the
/// centre of the anchors, so that no anchor is special and map coordinates of a million metres lose no
/// digits.
std::optional<Eigen::Vector2d> linearStart(std::span<const TagRange> ranges, const Weights& weights) {
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

Starts bothSides(const AnchorShape& shape, const LineStart& start) {
  const Eigen::Vector2d foot = shape.centre + start.along * shape.along;
  const Eigen::Vector2d aside =
      std::sqrt(std::max(start.across_squared, start.sigma_of_square)) * shape.across;
  return {{foot + aside, foot - aside}, 2};
}

Starts startingPlaces(std::span<const TagRange> ranges, const Weights& weights) {
  if (ranges.size() < 2) return {};
  const AnchorShape shape = shapeOf(ranges);
  if (shape.onePlace()) return {};
  const auto place = shape.inLine(ranges.size()) ? std::nullopt : linearStart(ranges, weights);
  if (!place) return bothSides(shape, lineStart(ranges, shape));
  return {{*place, shape.mirrored(*place)}, shape.nearlyInLine() ? 2 : 1};
}

}  // namespace pos::uwb::detail
