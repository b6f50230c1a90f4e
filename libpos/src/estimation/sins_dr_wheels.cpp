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

constexpr int kReleaseMean = 5;               // updates over which velocities have to agree
constexpr double kForcedVelocitySigma = 0.1;  // m/s

}  // namespace

void SinsDr::Rolling::add(const Rolling& more) {
  way += more.way;
  turn += more.turn;
  time += more.time;
  moved_n += more.moved_n;
}

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
  const Rolling now{
      .way = rolled_way,
      .turn = config_.odometer.track > 0.0 ? way.turn(config_.odometer.track) : 0.0,
      .time = dt,
      .moved_n = ins::metresBetween(moved.earth, belief_.mean.wheel_coordinates, moved.wheel_coordinates)};
  since_update_.add(now);
  if (!slip_.isolated()) unpropagated_rolling_.add(now);
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
  watchSlide(stamp);
  const bool was_degraded = slip_.degraded();
  const SlipAction action = slip_.observe(evidence(stamp, nis));
  IngestReport report{.verdict = Verdict::Applied, .dof = 3, .nis = nis};
  if (slip_.isolated() && action != SlipAction::Isolate) report.dof = 0;
  report = act(stamp, action, report);
  if (slip_.degraded() && !was_degraded) report.event = "wheels left out for too long: position degraded";
  update_stamp_ = stamp;
  coordinates_at_update_ = belief_.mean.nav.coordinates;
  since_update_ = {};
  if (!standing(stamp)) rate_.forget();
  return report;
}

/// Of the mean velocity since the last update, along the way: what the wheels walk at random in that time,
/// two averaged, and what the settings say beside it.
double SinsDr::wheelVelocitySigma() const {
  const double walk = 0.5 * ins::wayVariance(config_.odometer, since_update_.way);
  return std::sqrt(square(config_.slip.velocity_sigma) + walk / square(since_update_.time));
}

/// Wheels and gyro. A short track makes a turn of the wheels' noise: 0.1 rad/s on 0.2 m at 0.3 m/s over 0.1
/// s.
bool SinsDr::turnsAgree() const {
  const double track = config_.odometer.track;
  if (track <= 0.0) return true;
  const double time = since_update_.time;
  const double turn_rate = rate_.time() > 0.0 ? (rate_.rate() - belief_.mean.gyro_bias).z() : 0.0;
  const double sigma =
      std::sqrt(2.0 * ins::wayVariance(config_.odometer, since_update_.way)) / (track * time);
  return std::abs(since_update_.turn / time - turn_rate) < config_.slip.release_yaw_rate + 2.0 * sigma;
}

SlipEvidence SinsDr::evidence(Stamp stamp, double difference_nis) const {
  SlipEvidence e{.stamp = stamp, .disagrees = difference_nis > difference_gate_.threshold};
  if (since_update_.time <= 0.0) return e;
  e.jump = jump();
  e.disagrees = e.disagrees || e.jump != 0.0;
  if (slip_.isolated()) addReturn(e);
  return e;
}

/// By how much the wheels gained on the accelerometers within a second (m/s along the way); zero when that is
/// noise.
double SinsDr::jump() const {
  const std::optional<SlideMean> jump = slide_.jump();
  if (!jump) return 0.0;
  const double variance =
      jump->variance + std::max(0.0, belief_.covariance(kScale, kScale)) * jump->wheels.squaredNorm();
  const double along = jump->difference.dot(belief_.mean.nav.q_n_b * belief_.mean.rollingDirection());
  return jump->difference.head<2>().squaredNorm() > jump_gate_.threshold * variance ? along : 0.0;
}

/// What speaks for believing the wheels again. Velocities are means over several updates, so that a counter's
/// whole ticks do not look like slip.
void SinsDr::addReturn(SlipEvidence& e) const {
  SinsDrInput in;
  in.wheel_v_n = since_update_.moved_n / since_update_.time;
  in.wheel_speed = since_update_.way / since_update_.time;
  const SlideMean mean = slide_.newest(kReleaseMean);
  auto velocity = velocityDifference(belief_.mean, in);
  velocity.nu = mean.difference + mechanised_v_ - belief_.mean.nav.v_n;
  const auto& P = belief_.covariance;
  const double nis =
      filters::normalisedSquare(belief_, velocity, Matrix<3, 3>(mean.variance * Matrix<3, 3>::Identity()));
  const bool turns_agree = turnsAgree();
  e.velocities_agree = nis < release_gate_.threshold && turns_agree && slide_.steady(kReleaseMean);
  e.velocity_sigma =
      std::sqrt(mean.variance + std::max(0.0, 0.5 * P.block<2, 2>(kVelocity, kVelocity).trace()));
  e.wheels_steady = turns_agree && slide_.steady();
  e.offset = slide_.sinceMark(kReleaseMean).dot(belief_.mean.nav.q_n_b * belief_.mean.rollingDirection());
  e.standing = config_.slip.standstill_updates && quiet();
  const double variance = P.block<2, 2>(kPosition, kPosition).trace();
  e.position_sigma = std::sqrt(std::max(0.0, variance - variance_when_isolated_));
}

void SinsDr::watchSlide(Stamp stamp) {
  const double inertial_time = seconds(*imu_.stamp() - *update_stamp_);
  if (since_update_.time > 0.0 && inertial_time > 0.0) {
    slide_.add({stamp, since_update_.moved_n / since_update_.time, mechanised_way_ / inertial_time,
                wheelVelocitySigma(), belief_.mean.nav.v_n - mechanised_v_});
  }
  mechanised_way_.setZero();
}

IngestReport SinsDr::act(Stamp stamp, SlipAction action, IngestReport report) {
  last_nis_ = report.nis;
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
      // A slip that is seen after half a second has pulled the velocity until then.
      if (jump() != 0.0) belief_.mean.nav.v_n -= slide_.fedBack();
      slide_.mark();
      reanchor(belief_);
      report.verdict = Verdict::Gated;
      report.reason = "wheels and inertial unit disagree";
      report.event = "wheels slip: left out";
      break;
    case SlipAction::Stay:
      whileIsolated();
      report.verdict = Verdict::Gated;
      report.reason = "wheels are left out until they agree again";
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
  // What was slip is not held against wheels that are believed again.
  if (action == SlipAction::Release || action == SlipAction::ForceBack) slide_.forget();
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
