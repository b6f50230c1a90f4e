#include "pos/estimation/shearer.hpp"

#include <algorithm>
#include <cmath>

#include "parts.hpp"
#include "pos/core/error.hpp"
#include "pos/filters/ekf.hpp"

namespace pos::estimation {
namespace {

using ins::kAccelerometerBias;
using ins::kGyroBias;
using ins::kPhi;
using ins::kPosition;
using ins::kVelocity;

std::vector<int> modesOf(const ShearerConfig& config) {
  if (config.selection.mode == 0) return {2, 7};
  return {config.selection.mode};
}

lidar::LegConfig legFinderOf(const LegsConfig& legs) {
  return {.diameter = legs.diameter,
          .lateral = legs.lateral,
          .lateral_tolerance = legs.lateral_gate,
          .sigma_range = legs.range_sigma,
          .calibration = legs.calibration};
}

/// Where along the track legs are looked for: as far as the selection reaches, and one support more.
lidar::AlongFace reachOf(const ShearerConfig& config, const ShearerFilter& filter) {
  const double far = config.selection.distance + (config.selection.features + 1) * config.legs.spacing;
  const double near = std::max(0.0, config.selection.distance - config.legs.spacing);
  switch (sideOf(filter.mode(), filter.progress().travel())) {
    case ZoneSide::A:
      return {near, far};
    case ZoneSide::B:
      return {-far, -near};
    case ZoneSide::Both:
      break;
  }
  return {-far, far};
}

}  // namespace

ins::Earth shearerEarth(const ShearerConfig& config, const map::TunnelMap& map) {
  if (config.earth == ShearerConfig::Earth::Flat) return ins::Earth::flat();
  if (!map.origin) {
    throw ConfigError(Complaint{.what = "an Earth that turns needs the map's tie to it, and the map has none",
                                .key = "earth",
                                .got = map.name.empty() ? "no map" : "map " + map.name,
                                .expected = "a map with an origin (latitude, longitude, altitude)",
                                .suggestion = "add the origin to the map, or say flat"});
  }
  const map::GeodeticOrigin& o = *map.origin;
  const double north = ins::kEarthRate * std::cos(o.latitude);
  const double up = ins::kEarthRate * std::sin(o.latitude);
  // North lies `grid_rotation` to the right of what would be the map's y axis.
  return ins::Earth::level({north * std::sin(o.grid_rotation), north * std::cos(o.grid_rotation), up},
                           ins::normalGravity(o.latitude, o.altitude));
}

ins::NavigationState shearerStart(const ShearerConfig& config, const std::optional<Belief<Pose2>>& given) {
  const ShearerAlignment& aligned = config.alignment;
  const Pose2 at = given ? given->mean : config.start.pose;
  const Pose3 T_map_body =
      Pose3::fromXyzYawPitchRoll(at.x, at.y, aligned.height, at.yaw, -aligned.pitch, aligned.roll);
  ins::NavigationState nav;
  nav.q_n_b = T_map_body.rotation;
  nav.coordinates = T_map_body * config.imu_place;
  nav.v_n = aligned.speed * (T_map_body.rotation * Eigen::Vector3d::UnitX());
  return nav;
}

Eigen::Matrix<double, 15, 15> shearerStartCovariance(const ShearerConfig& config,
                                                     const std::optional<Belief<Pose2>>& given) {
  const ShearerAlignment& aligned = config.alignment;
  const Belief<Pose2> at = given ? *given : knownStart(config.start);
  Eigen::Matrix<double, 15, 15> P = Eigen::Matrix<double, 15, 15>::Zero();
  P.diagonal().segment<3>(kPhi) << square(aligned.tilt_sigma), square(aligned.tilt_sigma),
      at.covariance(2, 2);
  P.diagonal().segment<3>(kVelocity).setConstant(square(aligned.speed_sigma));
  P.block<2, 2>(kPosition, kPosition) = at.covariance.topLeftCorner<2, 2>();
  P(kPosition + 2, kPosition + 2) = square(config.start.position_sigma);
  P.diagonal().segment<3>(kGyroBias).setConstant(square(config.imu.gyro_bias_sigma));
  P.diagonal().segment<3>(kAccelerometerBias).setConstant(square(config.imu.accelerometer_bias_sigma));
  return P;
}

Shearer::Shearer(const ShearerConfig& config, const std::shared_ptr<const map::TunnelMap>& map)
    : config_(config), earth_(shearerEarth(config, *map)), finder_(legFinderOf(config.legs)) {}

void Shearer::reset(Stamp stamp, const Belief<Pose2>& prior) {
  given_ = prior;
  running_ = false;
  last_stamp_ = stamp;
  imu_.forget();
  filters_.clear();
  kept_.clear();
  kept_.shrink_to_fit();
  eta_ = 0.0;
  was_degraded_ = false;
}

void Shearer::start() {
  const ins::NavigationState nav = shearerStart(config_, given_);
  const Eigen::Matrix<double, 15, 15> P = shearerStartCovariance(config_, given_);
  filters_.clear();
  for (const int mode : modesOf(config_)) {
    filters_.emplace_back(config_, mode);
    filters_.back().start(earth_, nav, P);
  }
  keeping_ = config_.picm.use == PicmConfig::Use::Restart;
  running_ = true;
}

IngestReport Shearer::ingest(const Measurement& measurement) {
  if (const auto refused = refusedUnseen(measurement, last_stamp_)) return *refused;
  const IngestReport report =
      std::visit([&](const auto& reading) { return take(measurement, reading); }, measurement.reading);
  if (movesTimeOn(report)) last_stamp_ = measurement.stamp;
  return report;
}

IngestReport Shearer::take(const Measurement& measurement, const ImuSample& sample) {
  const ImuIntake::Told told = imu_.take(measurement.stamp, sample);
  if (!told.refusal.empty()) return refusal(Verdict::Degenerate, told.refusal);
  if (!running_) start();
  IngestReport report{.verdict = Verdict::Applied};
  if (told.raw.dt == 0.0) return report;
  if (keeping_) kept_.emplace_back(told.raw);
  bool arrived_at_2 = false;
  for (ShearerFilter& filter : filters_) {
    const FaceProgress::Event event = filter.step(told.raw);
    if (&filter != &filters_.front()) continue;
    if (event == FaceProgress::Event::Arrived) report.event = "at the end of a pass";
    if (event == FaceProgress::Event::Returned) report.event = "the next pass begins";
    arrived_at_2 = event == FaceProgress::Event::Arrived && filter.progress().arrivals() == 1 &&
                   filter.progress().end() == 2;
  }
  if (arrived_at_2) {
    chooseMode();
    alignMount();
    if (config_.picm.use != PicmConfig::Use::Off) report.event = "at end 2: the scanner's mount is corrected";
  }
  const bool degraded = best().degraded();
  if (degraded != was_degraded_) {
    report.event = degraded ? "no legs for too long: position degraded" : "legs are back";
    was_degraded_ = degraded;
  }
  return report;
}

/// Modes 2 and 7 side by side: the one that comes nearer to the rack's length stays (section 5.2, step 3).
void Shearer::chooseMode() {
  if (filters_.size() < 2) return;
  const auto misses = [&](const ShearerFilter& filter) {
    return std::abs(filter.station() - config_.face.length);
  };
  if (misses(filters_[1]) < misses(filters_[0])) std::swap(filters_[0], filters_[1]);
  filters_.erase(filters_.begin() + 1, filters_.end());
}

void Shearer::alignMount() {
  using Use = PicmConfig::Use;
  if (config_.picm.use == Use::Off) return;
  eta_ = best().picmAngle();
  if (config_.picm.use == Use::Continue) {
    filters_.front().turnMount(eta_);
    return;
  }
  ShearerFilter again(config_, best().mode());
  again.start(earth_, shearerStart(config_, given_), shearerStartCovariance(config_, given_));
  again.turnMount(eta_);
  for (const Kept& kept : kept_) {
    if (const auto* raw = std::get_if<ins::ImuIncrement>(&kept)) (void)again.step(*raw);
    if (const auto* leg = std::get_if<KeptLeg>(&kept))
      (void)again.see(leg->measured, leg->covariance, leg->age);
  }
  filters_.front() = std::move(again);
  keeping_ = false;
  kept_.clear();
  kept_.shrink_to_fit();
}

IngestReport Shearer::take(const Measurement& measurement, const Scan2D& scan) {
  if (scan.ranges.empty()) return refusal(Verdict::Degenerate, "a scan without beams");
  if (measurement.sensor != config_.legs.sensor)
    return refusal(Verdict::Unsupported, "not the scanner that sees the legs (legs.sensor)");
  if (scan.ranges.size() == 1) return takePoint(measurement.stamp, scan);
  return takeSweep(measurement.stamp, scan);
}

/// A leg measured as a point: the beam's mount is turned to look at it.
IngestReport Shearer::takePoint(Stamp stamp, const Scan2D& scan) {
  if (scan.valid.front() == 0) return refusal(Verdict::Degenerate, "the beam did not come back");
  const Eigen::Vector3d direction(std::cos(scan.angle_first), std::sin(scan.angle_first), 0.0);
  const Eigen::Vector3d p_body = scan.T_body_sensor * Eigen::Vector3d(scan.ranges.front() * direction);
  return takeLeg(stamp, p_body - config_.legs.place, config_.legs.sigma.cwiseAbs2().asDiagonal());
}

/// Every leg of a sweep that a filter may use, in the order of the beams. Applied when one of them was.
IngestReport Shearer::takeSweep(Stamp stamp, const Scan2D& scan) {
  if (!running_) return refusal(Verdict::NotInitialised, "nothing heard of the inertial unit yet");
  lidar::AlongFace part = reachOf(config_, filters_.front());
  for (const ShearerFilter& filter : filters_) {
    const lidar::AlongFace other = reachOf(config_, filter);
    part = {std::min(part.from, other.from), std::max(part.to, other.to)};
  }
  const lidar::LegSweep sweep = finder_.find(scan, part);
  if (sweep.view == lidar::LegView::NoReturns)
    return refusal(Verdict::Degenerate, "no beam of the sweep came back");
  IngestReport report =
      refusal(Verdict::Unsupported, "no leg of the sweep is one that the mode of selection uses");
  const Eigen::Matrix3d R = scan.T_body_sensor.rotation.toRotationMatrix();
  for (const lidar::LegDetection& leg : sweep.legs) {
    const Eigen::Vector3d p_body = scan.T_body_sensor * Eigen::Vector3d(leg.centre.x(), leg.centre.y(), 0.0);
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    covariance.topLeftCorner<2, 2>() = leg.covariance;
    covariance(2, 2) = square(config_.legs.sigma.z());
    const IngestReport one = takeLeg(stamp, p_body - config_.legs.place, R * covariance * R.transpose());
    if (one.verdict == Verdict::Applied) {
      report = {.verdict = Verdict::Applied, .dof = report.dof + one.dof, .nis = report.nis + one.nis};
    } else if (one.verdict == Verdict::Gated && report.verdict == Verdict::Unsupported) {
      report = one;
      report.dof = 0;
      report.nis = 0.0;
    }
  }
  return report;
}

IngestReport Shearer::takeLeg(Stamp stamp, const Eigen::Vector3d& measured,
                              const Eigen::Matrix3d& covariance) {
  if (!running_) return refusal(Verdict::NotInitialised, "nothing heard of the inertial unit yet");
  const double age = seconds(stamp - *imu_.stamp());
  LegReport told{.verdict = Verdict::Unsupported};
  for (ShearerFilter& filter : filters_) {
    const LegReport now = filter.see(measured, covariance, age);
    if (&filter == &filters_.front() || told.verdict == Verdict::Unsupported) told = now;
  }
  if (keeping_ && told.verdict != Verdict::Unsupported)
    kept_.emplace_back(KeptLeg{measured, covariance, age});
  return {.verdict = told.verdict,
          .dof = told.taken_up || told.verdict == Verdict::Unsupported ? 0 : 3,
          .nis = told.nis,
          .reason = told.reason};
}

std::optional<Estimate> Shearer::estimateAt(Stamp stamp) const {
  if (!last_stamp_ || stamp < *last_stamp_) return std::nullopt;
  if (!running_) {
    if (!given_) return std::nullopt;
    return planarEstimate(stamp, given_->mean, given_->covariance, config_.alignment.height);
  }
  const double dt = std::max(0.0, seconds(stamp - *imu_.stamp()));
  const ShearerBelief& belief = best().belief();
  const ShearerState& x = belief.mean;
  const Eigen::Vector3d arm_n = x.nav.q_n_b * config_.imu_place;
  Estimate estimate;
  estimate.stamp = stamp;
  estimate.T_map_body.rotation = x.nav.q_n_b;
  estimate.T_map_body.translation = x.nav.coordinates + dt * x.nav.v_n - arm_n;
  Matrix<6, 15> J = Matrix<6, 15>::Zero();
  J.block<3, 3>(0, kPosition).setIdentity();
  J.block<3, 3>(0, kVelocity) = dt * Matrix<3, 3>::Identity();
  J.block<3, 3>(0, kPhi) = ins::skew(arm_n);
  J.block<3, 3>(3, kPhi) = x.nav.C_n_b().transpose();
  const Matrix<15, 15> P = belief.covariance.topLeftCorner<15, 15>();
  estimate.covariance = J * P * J.transpose();
  estimate.covariance.diagonal().head<3>().array() +=
      square(0.5 * dt) * dt / 3.0;  // 0.5 m/s^2 sqrt(s) unknown
  filters::symmetrise(estimate.covariance);
  return estimate;
}

Diagnostics Shearer::diagnostics() const {
  if (!running_) return {};
  const ShearerBelief& belief = best().belief();
  const ShearerState& x = belief.mean;
  const auto sigma = [&](int row) { return std::sqrt(std::max(0.0, belief.covariance(row, row))); };
  Diagnostics values{{"degraded", best().degraded() ? 1.0 : 0.0},
                     {"mode", static_cast<double>(best().mode())},
                     {"legs", static_cast<double>(best().legs())},
                     {"cycles", static_cast<double>(best().progress().arrivals())},
                     {"picm_angle_rad", eta_},
                     {"mount_yaw_rad", x.sensor.yaw, x.sensor_states ? sigma(x.sensorRow()) : 0.0}};
  if (x.sensor_states) {
    values.push_back({"mount_pitch_rad", x.sensor.pitch, sigma(x.sensorRow() + 1)});
    values.push_back({"range_scale", x.sensor.scale, sigma(x.sensorRow() + 2)});
    values.push_back({"range_offset_m", x.sensor.offset, sigma(x.sensorRow() + 3)});
    values.push_back({"angle_scale", x.sensor.angle_scale, sigma(x.sensorRow() + 4)});
    values.push_back({"angle_curve_per_rad", x.sensor.angle_curve, sigma(x.sensorRow() + 5)});
  }
  const char* axes = "xyz";
  for (int i = 0; i < 3; ++i) {
    values.push_back(
        {std::string("gyro_bias_") + axes[i] + "_rad_per_s", x.gyro_bias[i], sigma(kGyroBias + i)});
  }
  for (int i = 0; i < 3; ++i) {
    values.push_back({std::string("accelerometer_bias_") + axes[i] + "_m_per_s2", x.accelerometer_bias[i],
                      sigma(kAccelerometerBias + i)});
  }
  return values;
}

}  // namespace pos::estimation
