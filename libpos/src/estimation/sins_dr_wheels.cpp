#include <algorithm>
#include <cmath>

#include "parts.hpp"
#include "pos/core/chi_square.hpp"
#include "pos/estimation/sins_dr.hpp"

// The wheels' half of sins_dr: rolling, comparing, leaving out, taking back.

namespace pos::estimation {
namespace {

using ins::kPosition;
using ins::kVelocity;

constexpr double kWheelsQuiet = 0.005;        // m/s, below this wheels count as standing
constexpr double kImplausibleSpeed = 40.0;    // m/s of a wheel on a mine vehicle: a counter that jumped
constexpr double kSteadyDifference = 0.15;    // m/s over a second between wheels and accelerometers
constexpr double kForcedVelocitySigma = 0.1;  // m/s

}  // namespace

IngestReport SinsDr::take(Stamp stamp, const WheelTicks& ticks) {
  if (config_.odometer.ticks_per_turn <= 0.0)
    return refusal(Verdict::Unsupported, "odometer.ticks_per_turn is not given: ticks say nothing");
  ins::TickCounter counter = counter_;
  const auto way = counter.way(ticks.left, ticks.right);
  const double dt = wheel_stamp_ ? seconds(stamp - *wheel_stamp_) : 0.0;
  if (way && std::max(std::abs(way->left), std::abs(way->right)) > kImplausibleSpeed * std::max(dt, 1e-3))
    return refusal(Verdict::Degenerate, "the counters jumped further than any wheel turns");
  counter_ = counter;
  return roll(stamp, way.value_or(ins::WheelWay{}), dt);
}

IngestReport SinsDr::take(Stamp stamp, const WheelSpeeds& speeds) {
  const double dt = wheel_stamp_ ? seconds(stamp - *wheel_stamp_) : 0.0;
  return roll(stamp, {speeds.left * dt, speeds.right * dt}, dt);
}

IngestReport SinsDr::take(Stamp stamp, const OdometryIncrement& odometry) {
  const double since = wheel_stamp_ ? seconds(stamp - *wheel_stamp_) : 0.0;
  const double dt = odometry.interval ? seconds(*odometry.interval) : since;
  const double half = 0.5 * odometry.increment.yaw * std::max(config_.odometer.track, 1e-6);
  return roll(stamp, {odometry.increment.x - half, odometry.increment.x + half}, dt);
}

/// Before the start there is no attitude: the wheels alone say how far the vehicle has gone.
IngestReport SinsDr::rollBlind(Stamp stamp, const ins::WheelWay& way, double dt) {
  wheel_stamp_ = stamp;
  const double turn = config_.odometer.track > 0.0 ? way.turn(config_.odometer.track) : 0.0;
  blind_ = blind_ * ins::arc(way.middle(), turn);
  if (dt > 0.0) blind_speed_ = way.middle() / dt;
  return refusal(Verdict::NotInitialised, "standing still to find the level and the gyro bias");
}

IngestReport SinsDr::roll(Stamp stamp, const ins::WheelWay& way, double dt) {
  if (dt > 0.0 && std::abs(way.middle()) + std::abs(way.right - way.left) > kWheelsQuiet * dt)
    wheels_turned_ = stamp;
  if (!running_) return rollBlind(stamp, way, dt);
  const Eigen::Quaterniond q_now =
      belief_.mean.nav.q_n_b *
      quaternionFromRotationVector(
          last_increment_.dt > 0.0
              ? Eigen::Vector3d(last_increment_.angle * (ageOf(stamp) / last_increment_.dt))
              : Eigen::Vector3d::Zero());
  const bool lost = !wheel_stamp_ || dt > config_.wheels_lost_after;
  wheel_stamp_ = stamp;
  if (lost || dt <= 0.0) {
    q_at_wheels_ = q_now;
    if (!lost) return {.verdict = Verdict::Applied};
    propagate();
    reanchor(belief_);
    return {.verdict = Verdict::Applied, .event = "wheels heard: anchored at the inertial position"};
  }
  const double rolled_way = way.middle() / (1.0 + belief_.mean.scale);
  const SinsDrState moved = rolled(belief_.mean, q_at_wheels_, q_now, rolled_way, config_.mounts);
  since_update_.moved_n +=
      ins::metresBetween(moved.earth, belief_.mean.wheel_coordinates, moved.wheel_coordinates);
  since_update_.way += rolled_way;
  if (config_.odometer.track > 0.0) since_update_.turn += way.turn(config_.odometer.track);
  since_update_.time += dt;
  wheel_interval_ = dt;
  if (!slip_.isolated()) belief_.mean.wheel_coordinates = moved.wheel_coordinates;
  q_at_wheels_ = q_now;
  if (seconds(stamp - *update_stamp_) < config_.update_interval - 1e-9) return {.verdict = Verdict::Applied};
  return compare(stamp);
}

IngestReport SinsDr::compare(Stamp stamp) {
  propagate();
  const auto difference = positionDifference(belief_.mean, ageOf(stamp));
  const double nis = slip_.isolated() ? 0.0 : filters::normalisedSquare(belief_, difference, noise_.R());
  const SlipAction action = slip_.observe(evidence(stamp, nis));
  IngestReport report{.verdict = Verdict::Applied, .dof = 3, .nis = nis};
  if (slip_.isolated() && action != SlipAction::Isolate) report.dof = 0;
  report = act(stamp, action, difference, report);
  update_stamp_ = stamp;
  coordinates_at_update_ = belief_.mean.nav.coordinates;
  since_update_ = {};
  if (!standing(stamp)) rate_.forget();
  return report;
}

/// Mean velocities over the time since the last update, so that a counter's whole ticks do not look like
/// slip.
SlipEvidence SinsDr::evidence(Stamp stamp, double difference_nis) const {
  SlipEvidence e{.stamp = stamp, .disagrees = difference_nis > difference_gate_.threshold};
  const double time = since_update_.time;
  if (time <= 0.0) return e;
  SinsDrInput in;
  in.wheel_v_n = since_update_.moved_n / time;
  in.wheel_speed = since_update_.way / time;
  auto velocity = velocityDifference(belief_.mean, in);
  const Eigen::Vector3d inertial =
      ins::metresBetween(belief_.mean.earth, coordinates_at_update_, belief_.mean.nav.coordinates) /
      std::max(seconds(*imu_stamp_ - *update_stamp_), 1e-3);
  velocity.nu = in.wheel_v_n - inertial;
  const double nis = filters::normalisedSquare(belief_, velocity, diagonal3(config_.slip.velocity_sigma));
  const double turn_rate = rate_.time() > 0.0 ? (rate_.rate() - belief_.mean.gyro_bias).z() : 0.0;
  const bool turns_agree = config_.odometer.track <= 0.0 ||
                           std::abs(since_update_.turn / time - turn_rate) < config_.slip.release_yaw_rate;
  e.velocities_agree = nis < chiSquareQuantile(config_.slip.release_confidence, 3.0) && turns_agree;
  if (!last_second_.empty()) {
    const Speeds& before = last_second_.front();
    const Eigen::Vector3d change = (in.wheel_v_n - before.wheels) - (belief_.mean.nav.v_n - before.inertial);
    e.wheels_steady = seconds(stamp - before.stamp) > 0.9 && change.norm() < kSteadyDifference && turns_agree;
  }
  const double variance = belief_.covariance.block<2, 2>(kPosition, kPosition).trace();
  e.position_sigma = std::sqrt(std::max(0.0, variance - variance_when_isolated_));
  return e;
}

IngestReport SinsDr::act(Stamp stamp, SlipAction action,
                         const filters::Innovation<SinsDrState, 3>& difference, IngestReport report) {
  last_nis_ = report.nis;
  const bool was_degraded = slip_.degraded();
  switch (action) {
    case SlipAction::Use: {
      const auto told = filters::correct(belief_, difference, noise_.R());
      if (config_.variant == SinsDrConfig::Variant::Iaekf && told.nis < difference_gate_.threshold)
        noise_.learn(told.nu, told.S, noise_.R());
      break;
    }
    case SlipAction::Skip:
      report.verdict = Verdict::Gated;
      report.reason = "wheels and inertial unit disagree";
      break;
    case SlipAction::Isolate:
      variance_when_isolated_ = belief_.covariance.block<2, 2>(kPosition, kPosition).trace();
      reanchor(belief_);
      report.verdict = Verdict::Gated;
      report.reason = "wheels and inertial unit disagree";
      report.event = "wheels slip: left out";
      break;
    case SlipAction::Stay:
      whileIsolated();
      report.verdict = Verdict::Gated;
      report.reason = "wheels are left out until they agree again";
      if (slip_.degraded() && !was_degraded) report.event = "wheels left out for too long: position degraded";
      break;
    case SlipAction::Release:
      reanchor(belief_);
      report.event = "wheels agree again: anchored at the inertial position";
      break;
    case SlipAction::ForceBack:
      takeWheelVelocity();
      reanchor(belief_);
      report.event = "wheels left out for too long: their velocity is taken";
      break;
  }
  if (since_update_.time > 0.0) {
    last_second_.push_back({stamp, since_update_.moved_n / since_update_.time, belief_.mean.nav.v_n});
    while (seconds(stamp - last_second_.front().stamp) > 1.05) last_second_.pop_front();
  }
  return report;
}

/// Without wheels: a quiet inertial unit stands; else it at least does not move sideways.
void SinsDr::whileIsolated() {
  if (config_.slip.standstill_updates && quiet()) {
    standStill();
    return;
  }
  const Eigen::Vector3d rate = last_increment_.dt > 0.0
                                   ? Eigen::Vector3d(last_increment_.angle / last_increment_.dt)
                                   : Eigen::Vector3d::Zero();
  const Matrix<2, 2> R = square(config_.slip.lateral_sigma) * Matrix<2, 2>::Identity();
  filters::correct(belief_, noSidewaysSpeed(belief_.mean, rate, config_.mounts), R,
                   {chiSquareQuantile(config_.fix_confidence, 2.0)});
}

void SinsDr::takeWheelVelocity() {
  if (since_update_.time <= 0.0) return;
  belief_.mean.nav.v_n = since_update_.moved_n / since_update_.time;
  Matrix<21, 21>& P = belief_.covariance;
  P.middleRows<3>(kVelocity).setZero();
  P.middleCols<3>(kVelocity).setZero();
  P.block<3, 3>(kVelocity, kVelocity) = diagonal3(kForcedVelocitySigma);
}

}  // namespace pos::estimation
