#include "pos/estimation/range_start.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "pos/core/square.hpp"

namespace pos::estimation {
namespace {

constexpr std::size_t kEnough = 8;       // ranges gathered before the first solution is tried
constexpr std::size_t kRemembered = 60;  // older ones are forgotten: the odometry has drifted since
constexpr int kIterations = 20;
constexpr int kSeedsPerSide = 5;
constexpr double kRobustScale = 2.0;  // Cauchy weights: residuals beyond this many sigmas count less and less

struct Fix {
  Eigen::Vector2d position;  ///< of the body now
  Matrix<2, 2> covariance;
  double cost = 0.0;  ///< robust: sum of log(1 + (e / k sigma)^2)
};

/// Everything that one heading hypothesis needs to solve for the position.
struct Problem {
  const std::vector<EarlyRange>* early;
  std::vector<Eigen::Vector2d> tag_from_body;  ///< map axes: tag at the time of the range minus body now
  double scale = 1.0;
  double offset = 0.0;
  std::vector<double> variances;
};

Problem problemFor(const std::vector<EarlyRange>& early, const Pose2& T_start_now, double yaw_now,
                   const RangeOdometryConfig& config) {
  Problem problem{&early, {}, config.range_scale.value, config.range_offset.value, {}};
  const Pose2 T_map_start = Pose2{0.0, 0.0, yaw_now} * inverse(T_start_now);
  for (const EarlyRange& r : early) {
    problem.tag_from_body.push_back((T_map_start * r.T_start_body) *
                                    Eigen::Vector2d(r.geometry.tag_body.head<2>()));
    problem.variances.push_back(r.variance + square(config.range_scale.sigma * r.range) +
                                square(config.range_offset.sigma) + square(config.anchor_offset.sigma));
  }
  return problem;
}

/// Gauss-Newton with Cauchy weights from one seed.
std::optional<Fix> solvedFrom(const Problem& problem, Eigen::Vector2d p) {
  Matrix<2, 2> information = Matrix<2, 2>::Zero();
  double cost = 0.0;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    information.setZero();
    cost = 0.0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < problem.early->size(); ++i) {
      const EarlyRange& r = (*problem.early)[i];
      const Eigen::Vector2d flat = p + problem.tag_from_body[i] - r.geometry.anchor_map.head<2>();
      const double dz = r.geometry.body_height + r.geometry.tag_body.z() - r.geometry.anchor_map.z();
      const double distance = std::max(std::hypot(flat.norm(), dz), 1e-6);
      const double e = r.range - r.geometry.range_bias - problem.offset - problem.scale * distance;
      const double squared = square(e / kRobustScale) / problem.variances[i];
      const double weight = 1.0 / ((1.0 + squared) * problem.variances[i]);
      const Eigen::Vector2d J = problem.scale * flat / distance;
      information += weight * J * J.transpose();
      gradient += weight * J * e;
      cost += std::log1p(squared);
    }
    const Matrix<2, 2> damped = information + 1e-9 * (1.0 + information.trace()) * Matrix<2, 2>::Identity();
    const Eigen::Vector2d move = damped.ldlt().solve(gradient);
    p += move * std::min(1.0, 20.0 / std::max(move.norm(), 1e-12));
    if (move.norm() < 1e-4) break;
  }
  if (!p.allFinite() || information.determinant() <= 1e-12) return std::nullopt;
  return Fix{p, information.inverse(), cost};
}

/// Seeds over the anchors' box, widened by the farthest range.
std::vector<Eigen::Vector2d> seeds(const std::vector<EarlyRange>& early) {
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9);
  Eigen::Array2d high = -low;
  double farthest = 0.0;
  for (const EarlyRange& r : early) {
    low = low.min(r.geometry.anchor_map.head<2>().array());
    high = high.max(r.geometry.anchor_map.head<2>().array());
    farthest = std::max(farthest, r.range);
  }
  low -= 0.5 * farthest;
  high += 0.5 * farthest;
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < kSeedsPerSide; ++i) {
    for (int j = 0; j < kSeedsPerSide; ++j) {
      const Eigen::Array2d share(i / (kSeedsPerSide - 1.0), j / (kSeedsPerSide - 1.0));
      points.emplace_back(low + share * (high - low));
    }
  }
  return points;
}

/// The distinct minima, best first; those far worse than the best are left out.
std::vector<Fix> minima(const Problem& problem, const std::vector<Eigen::Vector2d>& from) {
  std::vector<Fix> found;
  for (const Eigen::Vector2d& seed : from) {
    if (const auto fix = solvedFrom(problem, seed)) found.push_back(*fix);
  }
  std::stable_sort(found.begin(), found.end(), [](const Fix& a, const Fix& b) { return a.cost < b.cost; });
  std::vector<Fix> distinct;
  for (const Fix& fix : found) {
    const bool seen = std::any_of(distinct.begin(), distinct.end(), [&](const Fix& d) {
      return (d.position - fix.position).norm() < 0.5 + std::sqrt(d.covariance.trace());
    });
    if (!seen && fix.cost < found.front().cost + 8.0) distinct.push_back(fix);
  }
  return distinct;
}

double priorVariance(const CalibrationState& c) {
  return square(c.sigma);
}

}  // namespace

Belief<RangeState> startBelief(const RangeOdometryConfig& config, const RangeLayout& layout,
                               const Belief<Pose2>& pose) {
  const int n = layout.size();
  Belief<RangeState> belief;
  belief.mean.values = RangeState::Values::Zero(n);
  belief.covariance = TangentMatrix<RangeState>::Zero(n, n);
  belief.mean.values.head<3>() << pose.mean.x, pose.mean.y, pose.mean.yaw;
  belief.covariance.topLeftCorner<3, 3>() = pose.covariance;
  const auto prior = [&](StateTerm term, double variance) {
    if (const auto row = layout.row(term)) {
      belief.mean.values[*row] = layout.held(term);
      belief.covariance(*row, *row) = variance;
    }
  };
  prior(StateTerm::VelocityX, square(config.max_speed / 3.0));
  prior(StateTerm::VelocityY, square(config.max_speed / 3.0));
  prior(StateTerm::YawRate, square(0.3));
  prior(StateTerm::GyroBias, priorVariance(config.gyro_bias));
  prior(StateTerm::WheelScale, priorVariance(config.wheel_scale));
  prior(StateTerm::RangeScale, priorVariance(config.range_scale));
  prior(StateTerm::RangeOffset, priorVariance(config.range_offset));
  prior(StateTerm::Latency, priorVariance(config.latency));
  for (const AnchorId anchor : layout.anchors()) {
    const int row = *layout.anchorRow(anchor);
    belief.mean.values[row] = config.anchor_offset.value;
    belief.covariance(row, row) = priorVariance(config.anchor_offset);
  }
  return belief;
}

std::vector<RangeHypothesis> headingHypotheses(const RangeOdometryConfig& config, const RangeLayout& layout,
                                               const Belief<Pose2>& pose) {
  std::vector<RangeHypothesis> hypotheses;
  const int count = config.heading_hypotheses;
  const double spacing = 2.0 * kPi / count;
  for (int i = 0; i < count; ++i) {
    Belief<Pose2> belief = pose;
    belief.mean.yaw = wrapAngle(pose.mean.yaw + i * spacing);
    belief.covariance.row(2).setZero();
    belief.covariance.col(2).setZero();
    belief.covariance(2, 2) = square(0.5 * spacing);  // neighbours overlap at one sigma
    hypotheses.push_back({startBelief(config, layout, belief), 0.0});
  }
  return hypotheses;
}

void RangeStart::add(Stamp stamp, const RangeGeometry& geometry, double range, double variance) {
  if (early_.size() == kRemembered) early_.erase(early_.begin());
  early_.push_back({stamp, geometry, range, variance, T_start_body_});
}

std::vector<RangeHypothesis> RangeStart::solved() const {
  std::set<AnchorId> anchors;
  for (const EarlyRange& r : early_) anchors.insert(r.geometry.anchor);
  if (early_.size() < kEnough || anchors.size() < 3) return {};

  std::vector<RangeHypothesis> hypotheses;
  const auto from = seeds(early_);
  const double spacing = 2.0 * kPi / config_->heading_hypotheses;
  for (int i = 0; i < config_->heading_hypotheses; ++i) {
    const double yaw = wrapAngle(i * spacing);
    for (const Fix& fix : minima(problemFor(early_, T_start_body_, yaw, *config_), from)) {
      Belief<Pose2> pose{{fix.position.x(), fix.position.y(), yaw}, Matrix<3, 3>::Zero()};
      pose.covariance.topLeftCorner<2, 2>() = 4.0 * fix.covariance;  // some of the ranges may be bad
      pose.covariance(2, 2) = square(0.5 * spacing);
      hypotheses.push_back({startBelief(*config_, *layout_, pose), -fix.cost});
    }
  }
  return hypotheses;
}

}  // namespace pos::estimation
