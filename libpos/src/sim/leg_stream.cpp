#include "pos/sim/leg_stream.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "pos/core/config_checks.hpp"
#include "scanner.hpp"

namespace pos::sim {
namespace {

Pose3 turned(const Pose3& T_body_sensor, const Eigen::Vector3d& mount_error_body) {
  return {T_body_sensor.translation, quaternionFromRotationVector(mount_error_body) * T_body_sensor.rotation};
}

Eigen::Vector3d legAxis(const SupportRow& row) {
  return {std::sin(row.tilt) * std::cos(row.tilt_heading), std::sin(row.tilt) * std::sin(row.tilt_heading),
          std::cos(row.tilt)};
}

/// One beam that measures `p_sensor`: the mount turned to look at the point.
Scan2D beamTo(const Eigen::Vector3d& p_sensor, const ScannerConfig& scanner) {
  const double bearing = std::atan2(p_sensor.y(), p_sensor.x());
  const double elevation = std::atan2(p_sensor.z(), std::hypot(p_sensor.x(), p_sensor.y()));
  const Pose3 T_sensor_beam = Pose3::fromXyzYawPitchRoll(0.0, 0.0, 0.0, bearing, -elevation, 0.0);
  return {.T_body_sensor = scanner.T_body_sensor * T_sensor_beam,
          .angle_first = 0.0,
          .angle_step = 0.0,
          .range_max = scanner.range_max,
          .ranges = {static_cast<float>(p_sensor.norm())},
          .valid = {1}};
}

}  // namespace

LegConfig validated(LegConfig config) {
  requireValid(config.timing, config.sensor + ".timing");
  (void)validated(config.scanner, config.sensor + ".scanner");
  (void)validated(config.row, config.sensor + ".row");
  require(config.mount_error.allFinite(), config.sensor + ".mount_error", "three numbers, rad");
  requirePositive(config.reach, config.sensor + ".reach", "m");
  return config;
}

struct LegStream::State {
  LegConfig config;
  LegPlacer leg;
  std::shared_ptr<const Motion> motion;
  Ticker ticker;
  Scanner scanner;
  Pose3 T_body_true_sensor = turned(config.scanner.T_body_sensor, config.mount_error);
  Eigen::Vector3d axis_map = legAxis(config.row);
  double low = std::min(scanner.reportedAngle(0), scanner.reportedAngle(config.scanner.beams - 1));
  double high = std::max(scanner.reportedAngle(0), scanner.reportedAngle(config.scanner.beams - 1));
  std::vector<double> truths = {};
  std::deque<Delivery> ready = {};

  /// Reference points of the legs within reach, scanner frame.
  template <typename Use>
  void eachLeg(double t, const Pose3& T_map_sensor, Use use) const {
    const Pose3 T_sensor_map = inverse(T_map_sensor);
    const SupportRow& row = config.row;
    const double station = row.along_map.dot(T_map_sensor.translation.head<2>() - row.origin_map);
    const SupportSpan span = supportsNear(row, station, config.reach);
    for (int support = span.first; support < span.last; ++support) {
      const Eigen::Vector3d p_map = leg(support, t);
      const double away = row.along_map.dot(p_map.head<2>() - row.origin_map) - station;
      if (std::abs(away) <= config.reach) use(Eigen::Vector3d(T_sensor_map * p_map));
    }
  }

  void sightPoints(const Tick& tick, const Pose3& T_map_sensor);
  std::optional<Eigen::Vector3d> sighted(double t, const Eigen::Vector3d& p_sensor);
  Scan2D sweep(double t, const Pose3& T_map_sensor);
  void cast(const LegCylinder& leg);
};

/// The point as measured: bearing and distance in the scan plane with their errors, height as it is.
std::optional<Eigen::Vector3d> LegStream::State::sighted(double t, const Eigen::Vector3d& p_sensor) {
  const double bearing = scanner.reportedAngleOf(std::atan2(p_sensor.y(), p_sensor.x()));
  const std::optional<double> range = scanner.reportedRange(t, std::hypot(p_sensor.x(), p_sensor.y()));
  if (!range || bearing < low || bearing > high) return {};
  return Eigen::Vector3d(*range * std::cos(bearing), *range * std::sin(bearing), p_sensor.z());
}

void LegStream::State::sightPoints(const Tick& tick, const Pose3& T_map_sensor) {
  eachLeg(tick.t, T_map_sensor, [&](const Eigen::Vector3d& p_sensor) {
    const std::optional<Eigen::Vector3d> seen = sighted(tick.t, p_sensor);
    if (seen && !tick.lost)
      ready.push_back(ticker.sent(tick.t, config.sensor, beamTo(*seen, config.scanner)));
  });
}

/// Shortens the true ranges of the beams that the leg stops.
void LegStream::State::cast(const LegCylinder& cylinder) {
  const LegEllipse ellipse = cutByScanPlane(cylinder);
  const double distance = ellipse.centre.norm();
  if (distance <= ellipse.semi_major) return;
  const ScannerConfig& c = config.scanner;
  const double bearing = std::atan2(ellipse.centre.y(), ellipse.centre.x());
  const double half = std::asin(ellipse.semi_major / distance);
  const double margin = 6.0 * c.sigma_angle + std::abs(c.angle_step);
  const double from = measuredAngle(bearing - half, c.errors) - margin;
  const double to = measuredAngle(bearing + half, c.errors) + margin;
  double first = (from - c.angle_first) / c.angle_step;
  double last = (to - c.angle_first) / c.angle_step;
  if (first > last) std::swap(first, last);
  const int begin = std::max(0, static_cast<int>(std::ceil(first)));
  const int end = std::min(c.beams - 1, static_cast<int>(std::floor(last)));
  const LegSlice slice(cylinder);
  for (int beam = begin; beam <= end; ++beam) {
    if (const std::optional<double> range = slice.beamRange(scanner.look(beam))) {
      double& truth = truths[static_cast<std::size_t>(beam)];
      truth = std::min(truth, *range);
    }
  }
}

Scan2D LegStream::State::sweep(double t, const Pose3& T_map_sensor) {
  truths.assign(static_cast<std::size_t>(config.scanner.beams), kNoReturn);
  const Eigen::Vector3d axis = T_map_sensor.rotation.conjugate() * axis_map;
  eachLeg(t, T_map_sensor, [&](const Eigen::Vector3d& p_sensor) {
    cast({.point = p_sensor, .axis = axis, .radius = config.row.radius});
  });
  return scanner.sweep(t, truths);
}

LegStream::LegStream(const LegConfig& config, LegPlacer leg, std::shared_ptr<const Motion> motion,
                     const RunSetup& run)
    : state_(new State{.config = validated(config),
                       .leg = std::move(leg),
                       .motion = motion,
                       .ticker = Ticker(config.timing, run, motion->duration()),
                       .scanner = Scanner(config.scanner, config.timing, run)}) {
  require(state_->leg != nullptr, config.sensor, "a way to place the legs");
}

LegStream::~LegStream() = default;

std::optional<Delivery> LegStream::next() {
  while (state_->ready.empty()) {
    const std::optional<Tick> tick = state_->ticker.next();
    if (!tick) return {};
    const Pose3 T_map_sensor = poseOf(state_->motion->at(tick->t)) * state_->T_body_true_sensor;
    if (state_->config.model == LegModel::Points) {
      state_->sightPoints(*tick, T_map_sensor);
      continue;
    }
    Scan2D scan = state_->sweep(tick->t, T_map_sensor);
    if (!tick->lost) return state_->ticker.sent(tick->t, state_->config.sensor, std::move(scan));
  }
  Delivery delivery = std::move(state_->ready.front());
  state_->ready.pop_front();
  return delivery;
}

}  // namespace pos::sim
