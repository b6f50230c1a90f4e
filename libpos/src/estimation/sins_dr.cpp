#include "pos/estimation/sins_dr.hpp"

#include <cmath>
#include <utility>

#include "parts.hpp"
#include "pos/core/angle.hpp"
#include "pos/core/chi_square.hpp"

namespace pos::estimation {
namespace {

using ins::kAccelerometerBias;
using ins::kGyroBias;
using ins::kInertial;
using ins::kPhi;
using ins::kPosition;
using ins::kVelocity;

constexpr double kJumpConfidence = 0.999;     // of the test of the change of the wheels' speed
constexpr double kMovingVelocitySigma = 0.2;  // m/s, of a start in motion, by the wheels

filters::NoiseAdaptation<3> startNoise(const SinsDrConfig& config) {
  return {{.form = config.noise_form,
           .forgetting = config.forgetting,
           .warm_up = 10,
           .variance_min = square(config.difference_sigma_min),
           .variance_max = square(config.difference_sigma_max)},
          diagonal3(config.difference_sigma)};
}

ins::ImuIncrement corrected(const ins::ImuIncrement& raw, const SinsDrState& x) {
  return {raw.angle - raw.dt * x.gyro_bias, raw.velocity - raw.dt * x.accelerometer_bias, raw.dt};
}

}  // namespace

SinsDr::SinsDr(const SinsDrConfig& config, const std::shared_ptr<const map::TunnelMap>& map)
    : config_(config),
      earth_(config.earth == EarthModel::Flat ? ins::Earth::flat(config.standstill.gravity)
                                              : ins::Earth::ellipsoid(),
             *map, "earth"),
      difference_gate_{chiSquareQuantile(config.slip.confidence, 3.0)},
      jump_gate_{chiSquareQuantile(kJumpConfidence, 2.0)},
      release_gate_{chiSquareQuantile(config.slip.release_confidence, 3.0)},
      standstill_(config.standstill),
      rest_(config.alignment, config.standstill),
      wheels_(config.odometer),
      slip_(config.slip),
      noise_(startNoise(config)) {}

void SinsDr::reset(Stamp stamp, const Belief<Pose2>& prior) {
  given_ = prior;
  running_ = false;
  last_stamp_ = stamp;
  imu_.forget();
  wheels_.forget();
  update_stamp_.reset();
  standstill_.forget();
  rest_.forget();
  blind_ = {};
  slip_.forget();
  slide_.forget();
  noise_ = startNoise(config_);
}

Belief<Pose2> SinsDr::prior() const {
  return given_ ? *given_ : knownStart(config_.start);
}

IngestReport SinsDr::ingest(const Measurement& measurement) {
  if (const auto refused = refusedUnseen(measurement, last_stamp_)) return *refused;
  const IngestReport report =
      std::visit([&](const auto& reading) { return take(measurement.stamp, reading); }, measurement.reading);
  if (movesTimeOn(report)) last_stamp_ = measurement.stamp;
  return report;
}

IngestReport SinsDr::take(Stamp stamp, const ImuSample& sample) {
  const ImuIntake::Told told = imu_.take(stamp, sample);
  if (!told.refusal.empty()) return refusal(Verdict::Degenerate, told.refusal);
  const ins::ImuIncrement& raw = told.raw;
  if (raw.dt == 0.0) return {.verdict = Verdict::Applied};
  return running_ ? strapdown(stamp, raw) : align(stamp, raw);
}

// ---------------------------------------------------------------- standing still before the start

IngestReport SinsDr::align(Stamp stamp, const ins::ImuIncrement& raw) {
  standstill_.add(raw);
  const RestAlignment::Stage stage = rest_.add(raw, standstill_, wheels_.turned().has_value());
  if (stage == RestAlignment::Stage::Standing)
    return refusal(Verdict::NotInitialised, "standing still to find the level and the gyro bias");
  start(stamp);
  return {.verdict = Verdict::Applied,
          .event = stage == RestAlignment::Stage::MovedOff
                       ? "moved off before the alignment was over: level and gyro bias are less sure"
                       : "aligned at rest"};
}

void SinsDr::start(Stamp stamp) {
  Belief<Pose2> at = prior();
  at.mean = at.mean * blind_.moved;
  const bool rested = rest_.rested();
  const bool zeroed = rested && config_.alignment.zero_rate;
  const ins::RestAverage& average = rest_.average();
  const Eigen::Vector3d origin_map(at.mean.x, at.mean.y, config_.height);
  const Eigen::Vector3d near = earth_.coordinates(origin_map);
  const Eigen::Matrix3d R_map_n = earth_.R_map_n(near);
  const double yaw_n = wrapAngle(at.mean.yaw - std::atan2(R_map_n(1, 0), R_map_n(0, 0)));

  SinsDrState x;
  x.earth = earth_.earth();
  x.nav.q_n_b = ins::levelled(average.force(), yaw_n);
  x.nav.coordinates = earth_.coordinates(origin_map + R_map_n * (x.nav.q_n_b * config_.mounts.imu));
  x.wheel_coordinates = x.nav.coordinates;
  const ins::EarthPoint here = x.earth.at(x.nav.coordinates);
  x.nav.v_n = blind_.speed * (x.nav.q_n_b * x.rollingDirection());
  if (zeroed) x.gyro_bias = ins::gyroBiasAtRest(average, here, x.nav.q_n_b);

  ins::AlignmentSigmas sigmas;
  sigmas.yaw = std::sqrt(at.covariance(2, 2));
  sigmas.velocity = rested && blind_.speed == 0.0 ? config_.zero_velocity_sigma : kMovingVelocitySigma;
  sigmas.gyro_bias =
      zeroed ? config_.imu.gyro_density / std::sqrt(average.time()) : config_.imu.gyro_bias_sigma;
  sigmas.accelerometer_bias = config_.imu.accelerometer_bias_sigma;
  sigmas.level = rested ? config_.alignment.level_sigma : config_.alignment.moving_level_sigma;
  Matrix<21, 21> P = Matrix<21, 21>::Zero();
  P.topLeftCorner<kInertial, kInertial>() = ins::alignmentCovariance(sigmas, x.nav.C_n_b(), here.gravity);
  P.block<2, 2>(kPosition, kPosition) = R_map_n.topLeftCorner<2, 2>().transpose() *
                                        at.covariance.topLeftCorner<2, 2>() * R_map_n.topLeftCorner<2, 2>();
  P(kScale, kScale) = square(config_.odometer_scale_sigma);
  P(kBoresightPitch, kBoresightPitch) = P(kBoresightYaw, kBoresightYaw) = square(config_.boresight_sigma);
  belief_ = {x, P};
  reanchor(belief_);
  running_ = true;
  q_at_wheels_ = x.nav.q_n_b;
  update_stamp_ = stamp;
  coordinates_at_update_ = x.nav.coordinates;
  since_update_ = {};
  unpropagated_rolling_ = {};
  force_sum_.setZero();
  unpropagated_ = 0.0;
  rate_.forget();
}

// ---------------------------------------------------------------- inertial part

IngestReport SinsDr::strapdown(Stamp stamp, const ins::ImuIncrement& raw) {
  const ins::ImuIncrement now = corrected(raw, belief_.mean);
  const Eigen::Vector3d v_before = belief_.mean.nav.v_n;
  belief_.mean.nav =
      ins::stepped(belief_.mean.earth, belief_.mean.nav, ins::compensated(now, last_increment_));
  mechanised_v_ += belief_.mean.nav.v_n - v_before;
  mechanised_way_ += now.dt * mechanised_v_;
  last_increment_ = now;
  standstill_.add(now);
  rate_.add(raw);
  force_sum_ += now.velocity;
  unpropagated_ += now.dt;
  if (unpropagated_ >= config_.propagation_interval - 1e-9) propagate();
  if (standing(stamp) && rate_.time() >= config_.update_interval - 1e-9) {
    standStill();
    rate_.forget();
  }
  return {.verdict = Verdict::Applied};
}

/// Over the time not yet propagated. All that the wheels rolled in between belongs to it, whatever their rate
/// is: way left out, or taken for more, would let a heading be seen that nothing tells.
SinsDrInput SinsDr::input(const Rolling& rolling) const {
  SinsDrInput in;
  in.force_b = force_sum_ / unpropagated_;
  in.wheel_v_n = rolling.moved_n / unpropagated_;
  in.wheel_speed = rolling.way / unpropagated_;
  in.wheel_interval = wheel_interval_;
  return in;
}

void SinsDr::propagate() {
  const Rolling rolling = std::exchange(unpropagated_rolling_, {});
  if (unpropagated_ > 0.0) {
    estimation::propagate(belief_, config_, input(rolling), unpropagated_);
    force_sum_.setZero();
    unpropagated_ = 0.0;
  } else if (rolling.time > 0.0) {
    propagateWheels(belief_, config_, rolling.moved_n, rolling.way);
  }
}

/// The inertial unit is quiet and, where there are wheels, they have not turned for as long as it looked.
bool SinsDr::standing(Stamp stamp) const {
  if (!quiet()) return false;
  return !wheels_.turned() || seconds(stamp - *wheels_.turned()) >= config_.standstill.window;
}

/// Zero velocity and zero rate; both gated wide, for a vehicle on a turntable or in a slow lift is quiet too.
void SinsDr::standStill() {
  propagate();
  const filters::Gate gate{chiSquareQuantile(config_.fix_confidence, 3.0)};
  filters::correct(belief_, zeroVelocity(belief_.mean), diagonal3(config_.zero_velocity_sigma), gate);
  if (rate_.time() <= 0.0 || !config_.alignment.zero_rate) return;
  const Matrix<3, 3> R = diagonal3(config_.imu.gyro_density / std::sqrt(rate_.time()));
  filters::correct(belief_, zeroRate(belief_.mean, rate_.rate()), R, gate);
}

// ---------------------------------------------------------------- fixes and answers

IngestReport SinsDr::take(Stamp stamp, const PassageFix& fix) {
  if (!running_)
    return refusal(Verdict::NotInitialised, "standing still to find the level and the gyro bias");
  propagate();
  const Eigen::Matrix3d R_map_n = earth_.R_map_n(belief_.mean.nav.coordinates);
  const std::optional<Estimate> here = estimateAt(stamp);
  if (!here) return refusal(Verdict::TooOld, "older than the state");
  const Eigen::Vector3d offset = R_map_n.transpose() * (fix.p_map - here->T_map_body * fix.p_body);
  const Matrix<3, 3> R = R_map_n.transpose() * fix.covariance * R_map_n;
  Belief<SinsDrState> tried = belief_;
  const auto told = filters::correct(tried, positionFix(tried.mean, offset, fix.p_body - config_.mounts.imu),
                                     R, {chiSquareQuantile(config_.fix_confidence, 3.0)});
  IngestReport report{.verdict = told.verdict, .dof = 3, .nis = told.nis};
  if (told.verdict == Verdict::Gated) report.reason = "the fix is too far from where the filter is";
  if (told.verdict == Verdict::Degenerate) report.reason = "the fix has no usable covariance";
  if (told.verdict != Verdict::Applied) return report;
  if (fix.yaw) {
    const double difference = wrapAngle(*fix.yaw - here->T_map_body.yaw());
    const auto heading = filters::correct(tried, headingFix(tried.mean, difference),
                                          Matrix<1, 1>(square(fix.yaw_sigma.value_or(0.1))),
                                          {chiSquareQuantile(config_.fix_confidence, 1.0)});
    if (heading.verdict != Verdict::Applied) {
      return {.verdict = Verdict::Gated,
              .dof = 1,
              .nis = heading.nis,
              .reason = "the fix's heading is too far off"};
    }
  }
  belief_ = tried;
  return report;
}

std::optional<Estimate> SinsDr::estimateAt(Stamp stamp) const {
  if (!last_stamp_ || stamp < *last_stamp_) return std::nullopt;
  if (!running_) {
    // Standing at the start, as far as anybody knows.
    if (!given_ && !imu_.stamp()) return std::nullopt;
    const Belief<Pose2> at = prior();
    return planarEstimate(stamp, at.mean * blind_.moved, at.covariance, config_.height);
  }
  const double dt = std::max(0.0, ageOf(stamp));
  const SinsDrState& x = belief_.mean;
  const Eigen::Matrix3d R_map_n = earth_.R_map_n(x.nav.coordinates);
  const Eigen::Vector3d arm_n = x.nav.q_n_b * config_.mounts.imu;
  Estimate estimate;
  estimate.stamp = stamp;
  estimate.T_map_body.rotation = Eigen::Quaterniond(R_map_n) * x.nav.q_n_b;
  estimate.T_map_body.rotation.normalize();
  estimate.T_map_body.translation = earth_.position(x.nav.coordinates) + R_map_n * (dt * x.nav.v_n - arm_n);
  Matrix<6, 21> J = Matrix<6, 21>::Zero();
  J.block<3, 3>(0, kPosition) = R_map_n;
  J.block<3, 3>(0, kVelocity) = dt * R_map_n;
  J.block<3, 3>(0, kPhi) = R_map_n * ins::skew(arm_n);
  J.block<3, 3>(3, kPhi) = x.nav.C_n_b().transpose();
  estimate.covariance = J * belief_.covariance * J.transpose();
  estimate.covariance.diagonal().head<3>().array() +=
      square(0.5 * dt) * dt / 3.0;  // 0.5 m/s^2 sqrt(s) unknown
  filters::symmetrise(estimate.covariance);
  return estimate;
}

Diagnostics SinsDr::diagnostics() const {
  const auto& P = belief_.covariance;
  const auto& x = belief_.mean;
  const auto sigma = [&](int row) { return running_ ? std::sqrt(std::max(0.0, P(row, row))) : 0.0; };
  Diagnostics values{{"isolated", slip_.isolated() ? 1.0 : 0.0},
                     {"degraded", slip_.degraded() ? 1.0 : 0.0},
                     {"isolations", static_cast<double>(slip_.isolations())},
                     {"standing", running_ && quiet() ? 1.0 : 0.0},
                     {"wheel_scale", x.scale, sigma(kScale)},
                     {"difference_sigma_m", std::sqrt(noise_.R()(0, 0))},
                     {"difference_nis", last_nis_}};
  addAxes(values, "gyro_bias", "rad_per_s", x.gyro_bias, kGyroBias, sigma);
  addAxes(values, "accelerometer_bias", "m_per_s2", x.accelerometer_bias, kAccelerometerBias, sigma);
  addAxes(values, "velocity", "m_per_s", x.nav.v_n, kVelocity, sigma);
  return values;
}

}  // namespace pos::estimation
