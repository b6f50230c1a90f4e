#include "pos/estimation/inertial_intake.hpp"

#include <algorithm>
#include <cmath>

namespace pos::estimation {
namespace {

constexpr double kFreeFall = 1.0;           // m/s^2: less specific force than this is no reading
constexpr double kWheelsQuiet = 0.005;      // m/s, below this wheels count as standing
constexpr double kImplausibleSpeed = 40.0;  // m/s of a wheel on a mine vehicle: a counter that jumped
constexpr double kLeastRest = 1.0;          // s of standing that are worth an average

}  // namespace

ImuIntake::Told ImuIntake::take(Stamp stamp, const ImuSample& sample) {
  double dt = stamp_ ? seconds(stamp - *stamp_) : 0.0;
  if (sample.interval && !stamp_) dt = seconds(*sample.interval);
  const bool rates = sample.kind == ImuSample::Kind::Rates;
  if (!rates && sample.interval) dt = seconds(*sample.interval);
  const Eigen::Vector3d force = rates || dt == 0.0 ? sample.linear : Eigen::Vector3d(sample.linear / dt);
  if (force.norm() < kFreeFall)
    return {.raw = {}, .refusal = "the accelerometers feel no gravity: no inertial unit reads this"};
  ins::ImuIncrement raw{sample.angular, sample.linear, dt};
  if (rates) {
    raw.angle *= dt;
    raw.velocity *= dt;
  }
  stamp_ = stamp;
  return {.raw = raw};
}

WheelIntake::Told WheelIntake::take(Stamp stamp, const WheelTicks& ticks) {
  if (config_.ticks_per_turn <= 0.0) {
    return {.reading = {},
            .verdict = Verdict::Unsupported,
            .reason = "odometer.ticks_per_turn is not given: ticks say nothing"};
  }
  ins::TickCounter counter = counter_;
  const auto way = counter.way(ticks.left, ticks.right);
  const double dt = since(stamp);
  if (way && std::max(std::abs(way->left), std::abs(way->right)) > kImplausibleSpeed * std::max(dt, 1e-3)) {
    return {.reading = {},
            .verdict = Verdict::Degenerate,
            .reason = "the counters jumped further than any wheel turns"};
  }
  counter_ = counter;
  return heard(stamp, way.value_or(ins::WheelWay{}), dt);
}

WheelIntake::Told WheelIntake::take(Stamp stamp, const WheelSpeeds& speeds) {
  const double dt = since(stamp);
  return heard(stamp, {speeds.left * dt, speeds.right * dt}, dt);
}

WheelIntake::Told WheelIntake::take(Stamp stamp, const OdometryIncrement& odometry) {
  const double dt = odometry.interval ? seconds(*odometry.interval) : since(stamp);
  const double half = 0.5 * odometry.increment.yaw * std::max(config_.track, 1e-6);
  return heard(stamp, {odometry.increment.x - half, odometry.increment.x + half}, dt);
}

WheelIntake::Told WheelIntake::heard(Stamp stamp, const ins::WheelWay& way, double dt) {
  const bool first = !stamp_;
  if (dt > 0.0 && std::abs(way.middle()) + std::abs(way.right - way.left) > kWheelsQuiet * dt)
    turned_ = stamp;
  stamp_ = stamp;
  return {.reading = {way, dt, first}};
}

void WheelIntake::forget() {
  counter_.forget();
  stamp_.reset();
  turned_.reset();
}

void BlindDrive::add(const WheelReading& reading, double track) {
  const double turn = track > 0.0 ? reading.way.turn(track) : 0.0;
  moved = moved * ins::arc(reading.way.middle(), turn);
  if (reading.dt > 0.0) speed = reading.way.middle() / reading.dt;
}

RestAlignment::Stage RestAlignment::add(const ins::ImuIncrement& raw, const ins::StandstillDetector& detector,
                                        bool wheels_turned) {
  pending_.add(raw);
  if (detector.statistic() && pending_.time() >= window_ - 1e-9) {
    if (detector.still() && !wheels_turned) {
      rest_.add(pending_.sum());
      pending_.forget();
    } else {
      moved_ = true;
    }
  }
  if (moved_) return Stage::MovedOff;
  return rest_.time() >= config_.time ? Stage::Aligned : Stage::Standing;
}

bool RestAlignment::rested() const {
  return rest_.time() >= kLeastRest;
}

void RestAlignment::forget() {
  rest_.forget();
  pending_.forget();
  moved_ = false;
}

}  // namespace pos::estimation
