#include "pos/eval/relative_error.hpp"

#include <cmath>

namespace pos::eval {

namespace {

/// A stretch that falls short by rounding alone still counts (m or s).
constexpr double kRounding = 1e-6;

/// Where each sample lies on the axis along which a stretch is measured.
std::vector<double> pathLengths(const ErrorSeries& series) {
  std::vector<double> s(series.size(), 0.0);
  for (std::size_t i = 1; i < series.size(); ++i) {
    s[i] = s[i - 1] +
           (series[i].T_map_truth.translation - series[i - 1].T_map_truth.translation).head<2>().norm();
  }
  return s;
}

std::vector<double> times(const ErrorSeries& series) {
  std::vector<double> t(series.size(), 0.0);
  for (std::size_t i = 1; i < series.size(); ++i) t[i] = seconds(series[i].stamp - series[0].stamp);
  return t;
}

double translationError(const ErrorSample& i, const ErrorSample& j) {
  const Eigen::Vector2d estimated = (j.T_map_estimate.translation - i.T_map_estimate.translation).head<2>();
  const Eigen::Vector2d true_motion = (j.T_map_truth.translation - i.T_map_truth.translation).head<2>();
  if (!i.yaw) return (estimated - true_motion).norm();
  const Eigen::Vector2d estimated_body = rotation2(-i.T_map_estimate.yaw()) * estimated;
  const Eigen::Vector2d true_body = rotation2(-i.T_map_truth.yaw()) * true_motion;
  return (estimated_body - true_body).norm();
}

/// All stretches of at least `stretch` on the axis `at` (never decreasing); two pointers, so O(n).
RelativeError overStretches(const ErrorSeries& series, const std::vector<double>& at, double stretch) {
  std::vector<double> translation;
  std::vector<double> yaw;
  std::size_t j = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    while (j < series.size() && at[j] - at[i] < stretch - kRounding) ++j;
    if (j == series.size()) break;
    translation.push_back(translationError(series[i], series[j]));
    if (series[i].yaw && series[j].yaw) yaw.push_back(wrapAngle(series[j].yaw->value - series[i].yaw->value));
  }
  RelativeError result;
  result.translation = statistics(translation);
  result.yaw = statistics(yaw);
  return result;
}

}  // namespace

std::vector<RelativeError> relativeErrors(const ErrorSeries& series, const RelativeErrorOptions& options) {
  std::vector<RelativeError> all;
  const std::vector<double> path = pathLengths(series);
  for (const double length : options.lengths) {
    all.push_back(overStretches(series, path, length));
    all.back().length = length;
  }
  const std::vector<double> t = times(series);
  for (const double duration : options.durations) {
    all.push_back(overStretches(series, t, duration));
    all.back().duration = duration;
  }
  return all;
}

}  // namespace pos::eval
