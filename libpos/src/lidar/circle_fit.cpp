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

/// Weight of a point, and what its noise does with that weight: w and w^2 v, v = variance of its e.
struct Weight {
  double w = 1.0;          // 1 / m^2
  double squared_v = 1.0;  // 1 / m^2
};

/// v = sigma_range^2 cos^2 + (range sigma_angle)^2 sin^2 of the beam's incidence, without dividing more than
/// once: num = v range^2.
class Weigher {
 public:
  explicit Weigher(const CircleFitConfig& config)
      : weights_(config.weights),
        range_variance_(square(config.sigma_range)),
        angle_variance_(square(config.sigma_angle)),
        least_(square(kLeastShare) * range_variance_) {}

  Weight of(const Eigen::Vector2d& p, const CircleResidual& at) const {
    const double range_squared = p.squaredNorm();
    const double along_squared = square(at.J.dot(p));  // cos^2 range^2
    const double num =
        range_variance_ * along_squared + angle_variance_ * range_squared * (range_squared - along_squared);
    if (weights_ == ArcWeights::Even) {
      const double w = 1.0 / range_variance_;
      return {.w = w, .squared_v = w * w * num / range_squared};
    }
    const double least = least_ * range_squared;
    const bool floored = num < least;
    const double w = range_squared / (floored ? least : num);
    Weight weight{.w = w, .squared_v = floored ? w * (num / least) : w};
    if (weights_ == ArcWeights::Huber && at.e * at.e * w > kHuber * kHuber) {
      const double less = kHuber / (std::abs(at.e) * std::sqrt(w));
      weight.w *= less;
      weight.squared_v *= less * less;
    }
    return weight;
  }

 private:
  ArcWeights weights_;
  double range_variance_;  // m^2
  double angle_variance_;  // rad^2
  double least_;           // m^2
};

/// A = J'WJ, g = J'We, B = J'WVWJ
struct Normal {
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  Eigen::Matrix2d B = Eigen::Matrix2d::Zero();
  double squares = 0.0;

  void add(const CircleResidual& at, const Weight& weight) {
    const Eigen::Matrix2d outer = at.J * at.J.transpose();
    A += weight.w * outer;
    B += weight.squared_v * outer;
    g += weight.w * at.e * at.J;
    squares += at.e * at.e;
  }
};

Normal normalEquations(std::span<const Eigen::Vector2d> points, const Eigen::Vector2d& centre,
                       const CircleFitConfig& config, const Weigher& weigher) {
  Normal normal;
  for (const Eigen::Vector2d& p : points) {
    const CircleResidual at = circleResidual(p, centre, config.radius);
    normal.add(at, weigher.of(p, at));
  }
  return normal;
}

/// The same with the weights that the points have as seen from `weights_at`.
Normal normalEquations(std::span<const Eigen::Vector2d> points, const Eigen::Vector2d& centre,
                       const CircleFitConfig& config, const Weigher& weigher,
                       const Eigen::Vector2d& weights_at) {
  Normal normal;
  for (const Eigen::Vector2d& p : points) {
    normal.add(circleResidual(p, centre, config.radius),
               weigher.of(p, circleResidual(p, weights_at, config.radius)));
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

std::optional<CircleFit> fittedCircle(std::span<const Eigen::Vector2d> points,
                                      const CircleFitConfig& config) {
  if (points.size() < 2) return {};
  const Weigher weigher(config);
  CircleFit fit{.centre = startOf(points, config.radius)};
  Eigen::Vector2d weights_at = fit.centre;
  for (; fit.iterations < config.iterations_max; ++fit.iterations) {
    const bool follow = fit.iterations < kReweightings;
    if (follow) weights_at = fit.centre;
    const Normal normal = follow ? normalEquations(points, fit.centre, config, weigher)
                                 : normalEquations(points, fit.centre, config, weigher, weights_at);
    if (!(conditionOf(normal.A) > config.condition_min)) return {};
    const auto factor = normal.A.llt();
    const Eigen::Vector2d step = -factor.solve(normal.g);
    fit.centre += step;
    if (!(step.squaredNorm() < square(config.step_small))) continue;
    const Eigen::Matrix2d inverse = factor.solve(Eigen::Matrix2d::Identity());
    fit.covariance = inverse * normal.B * inverse;
    fit.rms = std::sqrt(normal.squares / static_cast<double>(points.size()));
    return fit;
  }
  return {};
}

}  // namespace pos::lidar
