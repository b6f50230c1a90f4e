#include "pos/lidar/legs.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/config_checks.hpp"
#include "pos/core/square.hpp"

namespace pos::lidar {
namespace {

/// A tilted leg cut by the scan plane is an ellipse, longer along the lean by 1 / cos(tilt): shrunk along it,
/// it is the circle.
Eigen::Vector2d shrunk(const Eigen::Vector2d& p, const Eigen::Vector2d& lean, double factor) {
  return p + (factor - 1.0) * lean.dot(p) * lean;
}

/// Mean square distance (m^2) of points from the straight line that fits them best.
double lineSquares(std::span<const Eigen::Vector2d> points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points) scatter += (p - mean) * (p - mean).transpose();
  scatter /= static_cast<double>(points.size());
  const double half = std::hypot(0.5 * (scatter(0, 0) - scatter(1, 1)), scatter(0, 1));
  return 0.5 * scatter.trace() - half;
}

}  // namespace

LegConfig validated(LegConfig config) {
  requirePositive(config.diameter, "diameter", "m");
  requirePositive(config.lateral, "lateral", "m");
  requirePositive(config.lateral_tolerance, "lateral_tolerance", "m");
  requirePositive(config.sigma_range, "sigma_range", "m");
  requireNotNegative(config.sigma_angle, "sigma_angle", "rad");
  requirePositive(config.jump_min, "jump_min", "m");
  requireNotNegative(config.jump_steps, "jump_steps");
  require(config.points_min >= 3, "points_min", ">= 3");
  requireNotNegative(config.width_min, "width_min", "diameters");
  require(config.width_max > config.width_min && std::isfinite(config.width_max), "width_max",
          "above width_min, diameters");
  requirePositive(config.rms_max, "rms_max", "sigma_range");
  require(std::abs(config.tilt) < 1.0, "tilt", "less than 1 rad");
  requireFinite(config.tilt_bearing, "tilt_bearing", "rad");
  requireValid(config.calibration, "calibration");
  return config;
}

LegFinder::LegFinder(const LegConfig& config)
    : config_(validated(config)),
      fit_{.radius = 0.5 * config.diameter,
           .sigma_range = config.sigma_range,
           .sigma_angle = config.sigma_angle,
           .weights = config.weights},
      lean_(std::cos(config.tilt_bearing), std::sin(config.tilt_bearing)) {}

LegSweep LegFinder::find(const Scan2D& scan, const AlongFace& part) {
  counts_ = {};
  legs_.clear();
  aim(scan);
  gather(scan);
  for (std::size_t begin = 0; begin < returns_.size();) {
    const std::size_t end = clusterEnd(begin);
    ++counts_.clusters;
    judge(begin, end, part);
    begin = end;
  }
  LegView view = counts_.returns > 0 ? LegView::NoLegs : LegView::NoReturns;
  if (!legs_.empty()) view = LegView::Legs;
  return {.legs = legs_, .counts = counts_, .view = view};
}

/// Directions of the beams, worked out anew only for a scan of another geometry.
void LegFinder::aim(const Scan2D& scan) {
  const std::size_t beams = std::min(scan.ranges.size(), scan.valid.size());
  const bool same =
      looks_.size() >= beams && angle_first_ == scan.angle_first && angle_step_ == scan.angle_step;
  if (same) return;
  angle_first_ = scan.angle_first;
  angle_step_ = scan.angle_step;
  looks_.clear();
  for (std::size_t i = 0; i < beams; ++i) {
    const double angle =
        calibratedAngle(scan.angle_first + static_cast<double>(i) * scan.angle_step, config_.calibration);
    looks_.emplace_back(std::cos(angle), std::sin(angle));
  }
  returns_.reserve(beams);
  arc_.reserve(beams);
  legs_.reserve(beams / static_cast<std::size_t>(config_.points_min) + 1);
}

void LegFinder::gather(const Scan2D& scan) {
  const std::size_t beams = std::min(scan.ranges.size(), scan.valid.size());
  counts_.beams = static_cast<int>(beams);
  returns_.clear();
  for (std::size_t i = 0; i < beams; ++i) {
    const double measured = static_cast<double>(scan.ranges[i]);
    if (scan.valid[i] == 0 || !(measured > 0.0 && measured < scan.range_max)) continue;
    const double range = calibratedRange(measured, config_.calibration);
    if (!(range > 0.0)) continue;
    returns_.push_back({.p = range * looks_[i], .range = range, .beam = static_cast<int>(i)});
  }
  counts_.returns = static_cast<int>(returns_.size());
}

/// One past the last return of the cluster that starts at `begin`. A cluster ends where the range jumps, and
/// where so many beams are missing that the gap is as wide.
std::size_t LegFinder::clusterEnd(std::size_t begin) const {
  std::size_t next = begin + 1;
  for (; next < returns_.size(); ++next) {
    const Return& here = returns_[next - 1];
    const Return& there = returns_[next];
    const double nearer = std::min(here.range, there.range);
    const double step = std::abs(angle_step_) * nearer;
    const double limit = std::max(config_.jump_min, config_.jump_steps * step);
    const bool together =
        std::abs(there.range - here.range) <= limit && (there.beam - here.beam) * step <= limit;
    if (!together) break;
  }
  return next;
}

bool LegFinder::onRow(double lateral) const {
  return std::abs(lateral - config_.lateral) <= config_.lateral_tolerance;
}

/// The near side of a leg is nearer in the middle than at its ends.
bool LegFinder::bulges(std::size_t begin, std::size_t end) const {
  const std::size_t count = end - begin;
  const double ends = returns_[begin].range + returns_[end - 1].range;
  const double middle = returns_[begin + (count - 1) / 2].range + returns_[begin + count / 2].range;
  return middle < ends;
}

void LegFinder::judge(std::size_t begin, std::size_t end, const AlongFace& part) {
  const std::size_t count = end - begin;
  if (count < static_cast<std::size_t>(config_.points_min)) {
    ++counts_.few_points;
    return;
  }
  const Return& middle = returns_[begin + count / 2];
  if (!(middle.p.x() >= part.from && middle.p.x() <= part.to)) {
    ++counts_.outside;
    return;
  }
  const double width = (returns_[end - 1].p - returns_[begin].p).norm() / config_.diameter;
  if (!(width >= config_.width_min && width <= config_.width_max)) {
    ++counts_.bad_width;
    return;
  }
  if (!onRow(middle.p.y() * (1.0 + 0.5 * config_.diameter / middle.range))) {
    ++counts_.off_row;
    return;
  }
  if (!bulges(begin, end)) {
    ++counts_.bad_arc;
    return;
  }
  const double cosine = std::cos(config_.tilt);
  arc_.clear();
  for (std::size_t i = begin; i < end; ++i) arc_.push_back(shrunk(returns_[i].p, lean_, cosine));
  const std::optional<CircleFit> fit = fittedCircle(arc_, fit_);
  if (!fit || !(fit->rms <= config_.rms_max * config_.sigma_range)) {
    ++counts_.bad_fit;
    return;
  }
  if (!(square(fit->rms) < lineSquares(arc_))) {
    ++counts_.bad_arc;
    return;
  }
  const Eigen::Vector2d centre = shrunk(fit->centre, lean_, 1.0 / cosine);
  legs_.push_back(
      {.centre = centre, .covariance = fit->covariance, .rms = fit->rms, .points = static_cast<int>(count)});
}

}  // namespace pos::lidar
