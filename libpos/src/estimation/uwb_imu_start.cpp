#include <cmath>

#include "pos/core/square.hpp"
#include "pos/estimation/uwb_imu.hpp"
#include "pos/ins/error_model.hpp"

namespace pos::estimation {
namespace {

constexpr double kLeastTilt = 1e-5;  // rad

/// Moves a covariance seen at the body's origin to the inertial unit, which swings with the attitude.
void swing(Matrix<15, 15>& P, const Eigen::Matrix3d& R, const Eigen::Vector3d& imu) {
  Matrix<15, 15> J = Matrix<15, 15>::Identity();
  J.block<3, 3>(EskfState::kPosition, EskfState::kAttitude) = -R * ins::skew(imu);
  P = (J * P * J.transpose()).eval();
  filters::symmetrise(P);
}

void setPosition(Belief<EskfState>& belief, const UwbImuConfig& config, const Belief<Pose2>& at) {
  constexpr int p = EskfState::kPosition;
  belief.mean.p_map =
      Eigen::Vector3d(at.mean.x, at.mean.y, config.height) + belief.mean.q_map_body * config.mounts.imu;
  belief.covariance.block<3, 3>(p, p).setZero();
  belief.covariance.block<2, 2>(p, p) = at.covariance.topLeftCorner<2, 2>();
  belief.covariance(p + 2, p + 2) = square(config.first.height_sigma);
  swing(belief.covariance, belief.mean.R_map_body(), config.mounts.imu);
}

}  // namespace

DualUwbConfig linksOf(const UwbImuConfig& config) {
  DualUwbConfig links;
  links.tags = config.tags;
  links.range_sigma = config.range_sigma;
  return links;
}

GateConfig watchOf(const RecoveryConfig& recovery) {
  GateConfig gate;
  gate.open_after = recovery.after;
  gate.agreement_fraction = recovery.agreement_fraction;
  return gate;
}

Belief<EskfState> movingStart(const UwbImuConfig& config, const Belief<Pose2>& at) {
  Belief<EskfState> belief;
  belief.mean.q_map_body = Pose3::fromPlanar(at.mean).rotation;
  belief.mean.v_map = belief.mean.q_map_body * Eigen::Vector3d(config.first.speed, 0.0, 0.0);
  auto variance = belief.covariance.diagonal();
  variance.segment<3>(EskfState::kVelocity).setConstant(square(config.first.velocity_sigma));
  variance.segment<2>(EskfState::kAttitude).setConstant(square(config.first.tilt_sigma));
  variance[EskfState::kAttitude + 2] = at.covariance(2, 2);
  variance.segment<3>(EskfState::kAccelerometerBias).setConstant(square(config.imu.accelerometer_bias_sigma));
  variance.segment<3>(EskfState::kGyroBias).setConstant(square(config.imu.gyro_bias_sigma));
  setPosition(belief, config, at);
  return belief;
}

Belief<EskfState> restedStart(const UwbImuConfig& config, const Belief<Pose2>& at,
                              const ins::RestAverage& average, bool rested) {
  const double gravity = config.standstill.gravity;
  const bool zeroed = rested && config.alignment.zero_rate;
  Belief<EskfState> belief;
  EskfState& x = belief.mean;
  x.q_map_body = ins::levelled(average.force(), at.mean.yaw);
  if (zeroed) x.gyro_bias = average.rate();
  ins::AlignmentSigmas sigmas;
  sigmas.yaw = std::sqrt(at.covariance(2, 2));
  sigmas.velocity = rested ? 0.01 : config.first.velocity_sigma;
  sigmas.position = 0.0;
  sigmas.gyro_bias =
      zeroed ? config.imu.gyro_density / std::sqrt(average.time()) : config.imu.gyro_bias_sigma;
  sigmas.accelerometer_bias = config.imu.accelerometer_bias_sigma;
  sigmas.level =
      std::max(rested ? config.alignment.level_sigma : config.alignment.moving_level_sigma, kLeastTilt);
  const Eigen::Matrix3d C = x.R_map_body();
  const Matrix<15, 15> P = ins::alignmentCovariance(sigmas, C, gravity);
  // From errors of ins::ErrorRow to those of EskfState: dtheta = C' phi.
  Matrix<15, 15> T = Matrix<15, 15>::Zero();
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  T.block<3, 3>(EskfState::kPosition, ins::kPosition) = -I;
  T.block<3, 3>(EskfState::kVelocity, ins::kVelocity) = -I;
  T.block<3, 3>(EskfState::kAttitude, ins::kPhi) = C.transpose();
  T.block<3, 3>(EskfState::kAccelerometerBias, ins::kAccelerometerBias) = I;
  T.block<3, 3>(EskfState::kGyroBias, ins::kGyroBias) = I;
  belief.covariance = T * P * T.transpose();
  setPosition(belief, config, at);
  return belief;
}

Estimate bodyEstimate(Stamp stamp, const Belief<EskfState>& belief, const Eigen::Vector3d& imu) {
  const EskfState& x = belief.mean;
  const Eigen::Matrix3d R = x.R_map_body();
  Estimate estimate;
  estimate.stamp = stamp;
  estimate.T_map_body = {x.p_map - R * imu, x.q_map_body};
  Matrix<6, 15> J = Matrix<6, 15>::Zero();
  J.block<3, 3>(0, EskfState::kPosition).setIdentity();
  J.block<3, 3>(0, EskfState::kAttitude) = R * ins::skew(imu);
  J.block<3, 3>(3, EskfState::kAttitude).setIdentity();
  estimate.covariance = J * belief.covariance * J.transpose();
  filters::symmetrise(estimate.covariance);
  return estimate;
}

std::unique_ptr<Estimator> makeUwbImu(const UwbImuConfig& config,
                                      const std::shared_ptr<const map::TunnelMap>& map) {
  const auto made = [&](auto core) -> std::unique_ptr<Estimator> {
    return std::make_unique<LateReplay<decltype(core)>>(std::move(core), config.lag);
  };
  switch (config.variant) {
    case UwbImuConfig::Variant::UwbOnly:
      return made(UwbOnlyCore(config, map));
    case UwbImuConfig::Variant::Ekf:
      return made(UwbImuCore<AdditiveEkf>(config, map));
    case UwbImuConfig::Variant::Ukf:
      return made(UwbImuCore<ManifoldUkf>(config, map));
    case UwbImuConfig::Variant::Eskf:
      break;
  }
  return made(UwbImuCore<EskfFilter>(config, map));
}

}  // namespace pos::estimation
