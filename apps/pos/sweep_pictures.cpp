#include "sweep_pictures.hpp"

#include <cmath>

#include "pos/estimation/shearer.hpp"
#include "pos/report/text.hpp"

namespace pos::app {
namespace {

std::vector<Eigen::Vector2d> returnsOf(const Scan2D& sweep) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < sweep.ranges.size(); ++i) {
    if (sweep.valid[i] == 0) continue;
    const double angle = sweep.angle_first + static_cast<double>(i) * sweep.angle_step;
    const double range = sweep.ranges[i];
    points.emplace_back(range * std::cos(angle), range * std::sin(angle));
  }
  return points;
}

report::LegPicture pictureOf(const estimation::LegScene& scene, const Scan2D& sweep) {
  report::LegPicture picture{.returns = returnsOf(sweep), .radius = scene.radius, .gate = scene.gate};
  for (const auto& leg : scene.expected) picture.expected.push_back({leg.support, leg.p, leg.moved});
  for (const auto& leg : scene.found) picture.found.push_back({leg.p, leg.covariance, leg.support, leg.used});
  return picture;
}

}  // namespace

void SweepPictures::look(const estimation::Estimator& estimator, const Measurement& measurement,
                         const IngestReport& report) {
  const auto* sweep = std::get_if<Scan2D>(&measurement.reading);
  if (sweep == nullptr || sweep->ranges.size() < 2) return;
  if (!first_) first_ = measurement.stamp;
  const double t = seconds(measurement.stamp - *first_);
  if (t < next_ || report.verdict != Verdict::Applied || report.dof == 0) return;
  const auto* shearer = dynamic_cast<const estimation::Shearer*>(&estimator);
  if (shearer == nullptr) return;
  picture_ = pictureOf(shearer->legScene(*sweep), *sweep);
  picture_->title = "Sweep of " + measurement.sensor + ", " + report::fixed(t, 2) + " s after the first";
  while (next_ <= t) next_ = next_ > 0.0 ? 2.0 * next_ : 1.0;
}

}  // namespace pos::app
