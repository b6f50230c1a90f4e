#include "pos/lidar/circle_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "pos/core/square.hpp"

namespace pos::lidar {
namespace {

constexpr double kHuber = 1.345;
/// A beam's noise across the circle is never taken for less than this share of its range noise: at the edge
/// of a leg the first-order figure goes to zero, the true one does not.
constexpr double kLeastShare = 0.5;
/// Weights follow the centre so often, then they stay: they could go to and fro for ever.
constexpr int kReweightings = 5;

/// A point's part in the normal equations about centre c.
struct Row {
  double e = 0.0;  // m
  Eigen::Vector2d J = Eigen::Vector2d::Zero();
  double weight = 1.0;    // 1 / m^2
  double variance = 1.0;  // m^2, of e under the beam's noise
};

/// Residual about `centre`, weight as seen from `weights_at`.
Row rowOf(const Eigen::Vector2d& p, const Eigen::Vector2d& centre, const Eigen::Vector2d& weights_at,
          const CircleFitConfig& config) {
  const CircleResidual at = circleResidual(p, weights_at, config.radius);
  const double range_squared = std::max(p.squaredNorm(), 1e-12);
  const double along = std::min(square(at.J.dot(p)) / range_squared, 1.0);  // cos^2 of incidence
  const double variance =
      square(config.sigma_range) * along + range_squared * square(config.sigma_angle) * (1.0 - along);
  const double floored = std::max(variance, square(kLeastShare * config.sigma_range));
  const CircleResidual here = circleResidual(p, centre, config.radius);
  Row row{.e = here.e, .J = here.J, .weight = 1.0 / square(config.sigma_range), .variance = variance};
  if (config.weights != ArcWeights::Even) row.weight = 1.0 / floored;
  if (config.weights == ArcWeights::Huber) {
    const double whitened = std::abs(at.e) / std::sqrt(floored);
    if (whitened > kHuber) row.weight *= kHuber / whitened;
  }
  return row;
}

/// A = J'WJ, g = J'We, B = J'WVWJ
struct Normal {
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  Eigen::Matrix2d B = Eigen::Matrix2d::Zero();
  double squares = 0.0;
};

Normal normalEquations(std::span<const Eigen::Vector2d> points, const Eigen::Vector2d& centre,
                       const Eigen::Vector2d& weights_at, const CircleFitConfig& config) {
  Normal normal;
  for (const Eigen::Vector2d& p : points) {
    const Row row = rowOf(p, centre, weights_at, config);
    const Eigen::Vector2d weighted = row.weight * row.J;
    normal.A.noalias() += weighted * row.J.transpose();
    normal.B.noalias() += row.variance * weighted * weighted.transpose();
    normal.g += row.e * weighted;
    normal.squares += row.e * row.e;
  }
  return normal;
}

/// Smallest over largest eigenvalue of a symmetric 2x2 matrix; 0 or NaN where it is singular.
double conditionOf(const Eigen::Matrix2d& A) {
  const double mean = 0.5 * A.trace();
  const double half = std::hypot(0.5 * (A(0, 0) - A(1, 1)), A(0, 1));
  return (mean - half) / (mean + half);
}

Eigen::Vector2d startOf(std::span<const Eigen::Vector2d> points, double radius) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double nearest_squared = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& p : points) {
    sum += p;
    nearest_squared = std::min(nearest_squared, p.squaredNorm());
  }
  return sum.normalized() * (std::sqrt(nearest_squared) + radius);
}

}  // namespace

CircleResidual circleResidual(const Eigen::Vector2d& p, const Eigen::Vector2d& centre, double radius) {
  const Eigen::Vector2d away = p - centre;
  const double distance = std::max(away.norm(), 1e-12);
  return {.e = distance - radius, .J = -away / distance};
}

std::optional<CircleFit> fittedCircle(std::span<const Eigen::Vector2d> points,
                                      const CircleFitConfig& config) {
  if (points.size() < 2) return {};
  CircleFit fit{.centre = startOf(points, config.radius)};
  Eigen::Vector2d weights_at = fit.centre;
  Normal normal = normalEquations(points, fit.centre, weights_at, config);
  bool settled = false;
  while (!settled) {
    if (fit.iterations == config.iterations_max || !(conditionOf(normal.A) > config.condition_min)) return {};
    const Eigen::Vector2d step = -normal.A.llt().solve(normal.g);
    fit.centre += step;
    settled = step.squaredNorm() < square(config.step_small);
    if (++fit.iterations < kReweightings) weights_at = fit.centre;
    normal = normalEquations(points, fit.centre, weights_at, config);
  }
  if (!(conditionOf(normal.A) > config.condition_min)) return {};
  const Eigen::Matrix2d inverse = normal.A.llt().solve(Eigen::Matrix2d::Identity());
  fit.covariance = inverse * normal.B * inverse;
  fit.rms = std::sqrt(normal.squares / static_cast<double>(points.size()));
  return fit;
}

}  // namespace pos::lidar
