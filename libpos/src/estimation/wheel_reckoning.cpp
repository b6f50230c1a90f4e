#include "pos/estimation/wheel_reckoning.hpp"

#include <algorithm>
#include <cmath>

#include "parts.hpp"
#include "pos/core/angle.hpp"
#include "pos/core/chi_square.hpp"
#include "pos/core/error.hpp"

namespace pos::estimation {
namespace {

constexpr double kPropagationInterval = 0.05;  // s between steps of the covariance
constexpr double kRestInterval = 0.1;          // s of gyro readings in one look at their bias
constexpr double kRestConfidence = 0.999;      // of the gate on that look: a turntable is quiet too

}  // namespace

WheelReckoning::WheelReckoning(const DeadReckoningConfig& config,
                               const std::shared_ptr<const map::TunnelMap>& map)
    : config_(config),
      earth_(config.earth == EarthModel::Flat ? ins::Earth::flat(config.standstill.gravity)
                                              : ins::Earth::ellipsoid(),
             *map, "earth"),
      standstill_(config.standstill),
      rest_(config.alignment, config.standstill),
      wheels_(config.odometer) {
  ensure(config.start.mode != StartMode::AtTruth,
         "start.mode at_truth must be spelt out before an estimator is made");
}

void WheelReckoning::reset(Stamp stamp, const Belief<Pose2>& prior) {
  given_ = prior;
  running_ = false;
  last_stamp_ = stamp;
  distance_ = 0.0;
  imu_.forget();
  standstill_.forget();
  rest_.forget();
  blind_ = {};
  last_increment_ = {};
  rate_.forget();
  unpropagated_ = 0.0;
  wheels_.forget();
  rolled_stamp_.reset();
  v_n_.setZero();
  speed_ = 0.0;
}

Belief<Pose2> WheelReckoning::prior() const {
  Belief<Pose2> at = given_ ? *given_ : knownStart(config_.start);
  at.mean = at.mean * blind_.moved;
  return at;
}

IngestReport WheelReckoning::ingest(const Measurement& measurement) {
  if (const auto refused = refusedUnseen(measurement, last_stamp_)) return *refused;
  const IngestReport report =
      std::visit([&](const auto& reading) { return take(measurement.stamp, reading); }, measurement.reading);
  if (movesTimeOn(report)) last_stamp_ = measurement.stamp;
  return report;
}

// ---------------------------------------------------------------- gyros

IngestReport WheelReckoning::take(Stamp stamp, const ImuSample& sample) {
  if (!usesGyros()) return refusal(Verdict::Unsupported, "the variant encoders has no inertial unit");
  const ImuIntake::Told told = imu_.take(stamp, sample);
  if (!told.refusal.empty()) return refusal(Verdict::Degenerate, told.refusal);
  if (told.raw.dt == 0.0) return {.verdict = Verdict::Applied};
  if (running_) {
    turn(stamp, told.raw);
    return {.verdict = Verdict::Applied};
  }
  standstill_.add(told.raw);
  const RestAlignment::Stage stage = rest_.add(told.raw, standstill_, wheels_.turned().has_value());
  if (stage == RestAlignment::Stage::Standing)
    return refusal(Verdict::NotInitialised, "standing still to find the level and the gyro bias");
  startGyros();
  return {.verdict = Verdict::Applied,
          .event = stage == RestAlignment::Stage::MovedOff
                       ? "moved off before the alignment was over: level and gyro bias are less sure"
                       : "aligned at rest"};
}

void WheelReckoning::startGyros() {
  const Belief<Pose2> at = prior();
  const bool rested = rest_.rested();
  const bool zeroed = rested && config_.alignment.zero_rate;
  const Eigen::Vector3d origin_map(at.mean.x, at.mean.y, config_.height);
  const Eigen::Matrix3d R_map_n = earth_.R_map_n(earth_.coordinates(origin_map));
  const double yaw_n = wrapAngle(at.mean.yaw - std::atan2(R_map_n(1, 0), R_map_n(0, 0)));
  GyroWheel x;
  x.earth = earth_.earth();
  x.q_n_b = ins::levelled(rest_.average().force(), yaw_n);
  x.coordinates = earth_.coordinates(origin_map + R_map_n * (x.q_n_b * config_.mounts.axle));
  x.scale = config_.wheel_scale.value;
  if (zeroed) x.gyro_bias = ins::gyroBiasAtRest(rest_.average(), x.earth.at(x.coordinates), x.q_n_b);

  Matrix<10, 10> P = Matrix<10, 10>::Zero();
  const double level =
      std::hypot(rested ? config_.alignment.level_sigma : config_.alignment.moving_level_sigma,
                 config_.imu.accelerometer_bias_sigma / config_.standstill.gravity);
  const double bias =
      zeroed ? config_.imu.gyro_density / std::sqrt(rest_.average().time()) : config_.imu.gyro_bias_sigma;
  P.diagonal().segment<2>(kAttitude).setConstant(square(level));
  P(kAttitude + 2, kAttitude + 2) = at.covariance(2, 2);
  P.diagonal().segment<3>(kRateBias).setConstant(square(bias));
  P.block<2, 2>(kPlace, kPlace) = R_map_n.topLeftCorner<2, 2>().transpose() *
                                  at.covariance.topLeftCorner<2, 2>() * R_map_n.topLeftCorner<2, 2>();
  P(kWayScale, kWayScale) = square(config_.wheel_scale.sigma);
  gyros_ = {x, P};
  q_at_wheels_ = x.q_n_b;
  startHeading(R_map_n * x.q_n_b.toRotationMatrix());
  running_ = true;
}

void WheelReckoning::turn(Stamp stamp, const ins::ImuIncrement& raw) {
  GyroWheel& x = gyros_.mean;
  const ins::ImuIncrement now{raw.angle - raw.dt * x.gyro_bias, raw.velocity, raw.dt};
  x = turned(x, ins::compensated(now, last_increment_), v_n_);
  last_increment_ = now;
  standstill_.add(now);
  unpropagated_ += now.dt;
  if (unpropagated_ >= kPropagationInterval - 1e-9) propagate();
  if (!standing(stamp)) return rate_.forget();
  rate_.add(raw);
  if (rate_.time() < kRestInterval - 1e-9) return;
  propagate();
  const Matrix<3, 3> R = square(config_.imu.gyro_density) / rate_.time() * Matrix<3, 3>::Identity();
  if (config_.alignment.zero_rate) {
    filters::correct(gyros_, zeroRate(gyros_.mean, rate_.rate()), R,
                     {chiSquareQuantile(kRestConfidence, 3.0)});
  }
  rate_.forget();
}

void WheelReckoning::propagate() {
  if (unpropagated_ <= 0.0) return;
  filters::predict(gyros_, gyroWheelStep(gyros_.mean, v_n_, unpropagated_, config_.imu, config_.odometer));
  unpropagated_ = 0.0;
}

/// Quiet, and the wheels have not turned for as long as the detector looks.
bool WheelReckoning::standing(Stamp stamp) const {
  return standstill_.still() &&
         (!wheels_.turned() || seconds(stamp - *wheels_.turned()) >= config_.standstill.window);
}

// ---------------------------------------------------------------- wheels

IngestReport WheelReckoning::roll(Stamp stamp, const WheelIntake::Told& told) {
  if (told.verdict != Verdict::Applied) return refusal(told.verdict, told.reason);
  const WheelReading& reading = told.reading;
  if (!running_ && usesGyros()) {
    blind_.add(reading, config_.odometer.track);
    return refusal(Verdict::NotInitialised, "standing still to find the level and the gyro bias");
  }
  if (!running_) {
    startHeading(Pose3::fromPlanar(prior().mean).rotation.toRotationMatrix());
    running_ = true;
  }
  rolled_stamp_ = stamp;
  if (usesGyros()) rollGyros(stamp, reading);
  driveHeading(reading);
  distance_ += std::abs(reading.way.middle());
  return {.verdict = Verdict::Applied};
}

void WheelReckoning::rollGyros(Stamp stamp, const WheelReading& reading) {
  const double ahead = last_increment_.dt > 0.0 ? seconds(stamp - *imu_.stamp()) / last_increment_.dt : 0.0;
  const Eigen::Quaterniond q_now =
      gyros_.mean.q_n_b * quaternionFromRotationVector(ahead * last_increment_.angle);
  const GyroWheel before = gyros_.mean;
  gyros_.mean = rolled(before, q_at_wheels_, q_now, reading.way.middle() / (1.0 + before.scale));
  q_at_wheels_ = q_now;
  if (reading.dt > 0.0)
    v_n_ = ins::metresBetween(before.earth, before.coordinates, gyros_.mean.coordinates) / reading.dt;
}

void WheelReckoning::startHeading(const Eigen::Matrix3d& R_map_body) {
  const Belief<Pose2> at = prior();
  const SeenAttitude seen = seenAttitude(R_map_body);
  WheelHeading x;
  x.p_map = Eigen::Vector3d(at.mean.x, at.mean.y, config_.height) + R_map_body * config_.mounts.axle;
  x.climb = seen.climb;
  x.roll = seen.roll;
  x.yaw = at.mean.yaw;
  x.track_error = config_.heading.track_error.value;
  Matrix<8, 8> P = Matrix<8, 8>::Zero();
  P.topLeftCorner<2, 2>() = at.covariance.topLeftCorner<2, 2>();
  const double level = usesGyros() ? config_.heading.level_sigma : 0.0;
  P(kClimb, kClimb) = P(kRoll, kRoll) = square(level);
  P(kYaw, kYaw) = at.covariance(2, 2);
  P(kTrackError, kTrackError) = square(config_.heading.track_error.sigma);
  const CalibrationState& bias = config_.heading.yaw_bias;
  if (usesGyros() && (bias.sigma > 0.0 || bias.walk_per_sqrt_s > 0.0)) {
    // Both headings started from the same one: what is wrong with it is in both.
    P(kYawBias, kYawBias) = square(bias.sigma) + P(kYaw, kYaw);
    P(kYawBias, kYaw) = P(kYaw, kYawBias) = -P(kYaw, kYaw);
  }
  heading_ = {x, P};
}

void WheelReckoning::driveHeading(const WheelReading& reading) {
  if (reading.first || reading.dt <= 0.0) return;
  ins::WheelWay way = reading.way;
  way.left /= 1.0 + config_.wheel_scale.value;
  way.right /= 1.0 + config_.wheel_scale.value;
  speed_ = way.middle() / reading.dt;
  const HeadingFilterConfig& h = config_.heading;
  const double level_walk = usesGyros() ? h.level_walk : 0.0;
  filters::predict(heading_, driven(heading_.mean, way, reading.dt, config_.odometer, h, level_walk));
  // An inertial heading that stands still has no news: its error is the one it had before.
  const bool moved = way.left != 0.0 || way.right != 0.0;
  if (config_.variant != Variant::EkfHeading || !moved) return;
  const double repeats = std::max(1.0, h.correlation_time / reading.dt);
  const Vector<3> variance(square(h.level_sigma), square(h.level_sigma), square(h.yaw_sigma) * repeats);
  const Eigen::Matrix3d R_map_body = R_map_n() * q_at_wheels_.toRotationMatrix();
  filters::correct(heading_, attitudeSeen(heading_.mean, seenAttitude(R_map_body)),
                   Matrix<3, 3>(variance.asDiagonal()));
}

}  // namespace pos::estimation
