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

constexpr double kSteadyDifference = 0.15;    // m/s over a second between wheels and accelerometers
constexpr double kForcedVelocitySigma = 0.1;  // m/s

}  // namespace

IngestReport SinsDr::take(Stamp stamp, const WheelTicks& ticks) {
  return roll(stamp, wheels_.take(stamp, ticks));
}

IngestReport SinsDr::take(Stamp stamp, const WheelSpeeds& speeds) {
  return roll(stamp, wheels_.take(stamp, speeds));
}

IngestReport SinsDr::take(Stamp stamp, const OdometryIncrement& odometry) {
  return roll(stamp, wheels_.take(stamp, odometry));
}

IngestReport SinsDr::roll(Stamp stamp, const WheelIntake::Told& told) {
  if (told.verdict != Verdict::Applied) return refusal(told.verdict, told.reason);
  const auto& [way, dt, first] = told.reading;
  if (!running_) {
    // No attitude yet: the wheels alone say how far the vehicle has gone.
    blind_.add(told.reading, config_.odometer.track);
    return refusal(Verdict::NotInitialised, "standing still to find the level and the gyro bias");
  }
  const Eigen::Quaterniond q_now =
      belief_.mean.nav.q_n_b *
      quaternionFromRotationVector(
          last_increment_.dt > 0.0
              ? Eigen::Vector3d(last_increment_.angle * (ageOf(stamp) / last_increment_.dt))
              : Eigen::Vector3d::Zero());
  const bool lost = first || dt > config_.wheels_lost_after;
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
  report = act(stamp, action, report);
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
      std::max(seconds(*imu_.stamp() - *update_stamp_), 1e-3);
  velocity.nu = in.wheel_v_n - inertial;
  const double nis = filters::normalisedSquare(belief_, velocity, diagonal3(config_.slip.velocity_sigma));
  const double turn_rate = rate_.time() > 0.0 ? (rate_.rate() - belief_.mean.gyro_bias).z() : 0.0;
  const bool turns_agree = config_.odometer.track <= 0.0 ||
                           std::abs(since_update_.turn / time - turn_rate) < config_.slip.release_yaw_rate;
  e.velocities_agree = nis < chiSquareQuantile(config_.slip.release_confidence, 3.0) && turns_agree;
  // Steady throughout: wheels that shake agree with the accelerometers now and then by chance.
  e.wheels_steady = turns_agree && !last_second_.empty() &&
                    seconds(stamp - last_second_.front().stamp) > 0.9 &&
                    std::all_of(last_second_.begin(), last_second_.end(), [&](const Speeds& before) {
                      const Eigen::Vector3d wheels = in.wheel_v_n - before.wheels;
                      return (wheels - (belief_.mean.nav.v_n - before.inertial)).norm() < kSteadyDifference;
                    });
  e.standing = config_.slip.standstill_updates && quiet();
  const double variance = belief_.covariance.block<2, 2>(kPosition, kPosition).trace();
  e.position_sigma = std::sqrt(std::max(0.0, variance - variance_when_isolated_));
  return e;
}

IngestReport SinsDr::act(Stamp stamp, SlipAction action, IngestReport report) {
  last_nis_ = report.nis;
  const bool was_degraded = slip_.degraded();
  switch (action) {
    case SlipAction::Use: {
      const auto told = correctDifference(belief_, ageOf(stamp), noise_.R());
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
