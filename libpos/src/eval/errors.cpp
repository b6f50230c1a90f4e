#include "pos/eval/errors.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace pos::eval {

namespace {

/// e^T (P + R)^-1 e with R = the truth's own variance of x and y, or nothing where the claim P itself is not
/// positive definite.
template <int N>
std::optional<double> nees(const Vector<N>& e, const Matrix<N, N>& P, double truth_variance) {
  if (!P.allFinite()) return std::nullopt;
  if (P.llt().info() != Eigen::Success) return std::nullopt;
  Matrix<N, N> sum = P;
  sum.template topLeftCorner<2, 2>() += truth_variance * Eigen::Matrix2d::Identity();
  const double value = e.dot(sum.llt().solve(e));
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

double sigmaOf(double variance) {
  return variance > 0.0 && std::isfinite(variance) ? std::sqrt(variance) : 0.0;
}

/// Error along a horizontal unit vector.
ScalarError projected(const Eigen::Vector2d& e, const Eigen::Matrix2d& P, const Eigen::Vector2d& unit) {
  return {unit.dot(e), sigmaOf(unit.dot(P * unit))};
}

ErrorSample errorSample(const Estimate& estimate, const Pose3& T_map_truth, const Truth& truth,
                        const std::optional<Eigen::Vector2d>& tangent, double truth_variance) {
  const Matrix<3, 3> P = estimate.planarCovariance();
  const Eigen::Vector3d e = estimate.T_map_body.translation - T_map_truth.translation;
  const Eigen::Vector2d e_xy = e.head<2>();
  const Eigen::Matrix2d P_xy = P.topLeftCorner<2, 2>();
  ErrorSample sample;
  sample.stamp = estimate.stamp;
  sample.T_map_estimate = estimate.T_map_body;
  sample.T_map_truth = T_map_truth;
  sample.x = projected(e_xy, P_xy, Eigen::Vector2d::UnitX());
  sample.y = projected(e_xy, P_xy, Eigen::Vector2d::UnitY());
  sample.xy = e_xy.norm();
  sample.nees_xy = nees<2>(e_xy, P_xy, truth_variance);
  if (truth.has_z) sample.z = ScalarError{e.z(), sigmaOf(estimate.covariance(2, 2))};
  if (tangent) {
    sample.along = projected(e_xy, P_xy, *tangent);
    sample.cross = projected(e_xy, P_xy, Eigen::Vector2d(-tangent->y(), tangent->x()));
  }
  if (truth.has_yaw) {
    const double e_yaw = wrapAngle(estimate.T_map_body.yaw() - T_map_truth.yaw());
    sample.yaw = ScalarError{e_yaw, sigmaOf(P(2, 2))};
    sample.nees_pose = nees<3>({e_xy.x(), e_xy.y(), e_yaw}, P, truth_variance);
  }
  return sample;
}

}  // namespace

ErrorSeries errorSeries(const std::vector<MatchedPose>& pairs, const Alignment& alignment, const Truth& truth,
                        const PathTangentOptions& options, double truth_sigma) {
  ErrorSeries series;
  if (pairs.empty()) return series;
  const PathTangent tangent(truth, options);
  series.reserve(pairs.size());
  for (const MatchedPose& pair : pairs) {
    series.push_back(errorSample(aligned(pair.estimate, alignment), pair.T_map_truth, truth,
                                 tangent.at(pair.truth_stamp), truth_sigma * truth_sigma));
  }
  return series;
}

std::string_view name(Component component) {
  switch (component) {
    case Component::Xy:
      return "xy";
    case Component::X:
      return "x";
    case Component::Y:
      return "y";
    case Component::Z:
      return "z";
    case Component::Along:
      return "along";
    case Component::Cross:
      return "cross";
    case Component::Yaw:
      return "yaw";
  }
  return "xy";
}

std::optional<ScalarError> component(const ErrorSample& sample, Component which) {
  switch (which) {
    case Component::Xy:
      return ScalarError{sample.xy, 0.0};
    case Component::X:
      return sample.x;
    case Component::Y:
      return sample.y;
    case Component::Z:
      return sample.z;
    case Component::Along:
      return sample.along;
    case Component::Cross:
      return sample.cross;
    case Component::Yaw:
      return sample.yaw;
  }
  return std::nullopt;
}

std::vector<double> values(const ErrorSeries& series, Component which) {
  std::vector<double> all;
  all.reserve(series.size());
  for (const ErrorSample& sample : series) {
    if (const auto error = component(sample, which)) all.push_back(error->value);
  }
  return all;
}

}  // namespace pos::eval
