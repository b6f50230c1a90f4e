#include "pos/eval/latency.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pos/core/error.hpp"

namespace pos::eval {
namespace {

constexpr double kStep = 0.01;       // s
constexpr double kLongestGap = 1.0;  // s, bridged in the reference

struct Residual {
  double rms = 0.0;
  std::size_t pairs = 0;
};

std::optional<Eigen::Vector2d> at(const std::vector<TimedPosition>& path, Stamp stamp) {
  const auto after = std::lower_bound(path.begin(), path.end(), stamp,
                                      [](const TimedPosition& p, Stamp s) { return p.stamp < s; });
  if (after == path.begin() || after == path.end()) return std::nullopt;
  const auto before = after - 1;
  const double gap = seconds(after->stamp - before->stamp);
  if (gap > kLongestGap) return std::nullopt;
  const double share = gap > 0.0 ? seconds(stamp - before->stamp) / gap : 0.0;
  return (1.0 - share) * before->p + share * after->p;
}

/// RMS distance of paired points after the best plane rotation and shift (Umeyama 1991 in two dimensions: the
/// least squares angle is that of the complex correlation).
Residual residualAt(const std::vector<TimedPosition>& late, const std::vector<TimedPosition>& reference,
                    double latency) {
  std::vector<Eigen::Vector2d> a;
  std::vector<Eigen::Vector2d> b;
  for (const TimedPosition& point : late) {
    if (const auto p = at(reference, point.stamp - durationFromSeconds(latency))) {
      a.push_back(point.p);
      b.push_back(*p);
    }
  }
  if (a.empty()) return {};
  Eigen::Vector2d mean_a = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_b = Eigen::Vector2d::Zero();
  const auto n = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += a[i] / n;
    mean_b += b[i] / n;
  }
  double dot = 0.0;
  double cross = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2d u = a[i] - mean_a;
    const Eigen::Vector2d v = b[i] - mean_b;
    dot += u.dot(v);
    cross += u.x() * v.y() - u.y() * v.x();
    squares += u.squaredNorm() + v.squaredNorm();
  }
  return {std::sqrt(std::max(0.0, squares - 2.0 * std::hypot(dot, cross)) / n), a.size()};
}

/// Where the parabola through three equally spaced values has its lowest point, in steps from the middle one.
double parabolaOffset(double left, double middle, double right) {
  const double curvature = left - 2.0 * middle + right;
  return curvature > 0.0 ? 0.5 * (left - right) / curvature : 0.0;
}

}  // namespace

LatencyFit fittedLatency(const std::vector<TimedPosition>& late, const std::vector<TimedPosition>& reference,
                         double window) {
  const int steps = static_cast<int>(std::lround(window / kStep));
  std::vector<Residual> residuals;
  for (int i = -steps; i <= steps; ++i) residuals.push_back(residualAt(late, reference, i * kStep));
  const auto best = std::min_element(residuals.begin(), residuals.end(),
                                     [](const Residual& a, const Residual& b) { return a.rms < b.rms; });
  const auto worst = std::max_element(residuals.begin(), residuals.end(),
                                      [](const Residual& a, const Residual& b) { return a.rms < b.rms; });
  if (best->pairs < 10 || worst->rms - best->rms < 0.01) {
    throw DataError(Complaint{.what = "the latency cannot be found from this log",
                              .got = std::to_string(best->pairs) + " pairs, residual from " +
                                     std::to_string(best->rms) + " to " + std::to_string(worst->rms) + " m",
                              .expected = "a stretch on which the vehicle moves and both sensors are heard",
                              .suggestion = "record a minute of driving with turns and stops"});
  }
  const auto index = best - residuals.begin();
  const bool inside = best != residuals.begin() && best + 1 != residuals.end();
  const double offset = inside ? parabolaOffset((best - 1)->rms, best->rms, (best + 1)->rms) : 0.0;
  return {(static_cast<double>(index) - steps + offset) * kStep, best->rms,
          residuals[static_cast<std::size_t>(steps)].rms, best->pairs};
}

}  // namespace pos::eval
