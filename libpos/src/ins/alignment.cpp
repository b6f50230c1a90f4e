#include "pos/ins/alignment.hpp"

#include <cmath>

#include "pos/core/pose3.hpp"
#include "pos/ins/error_model.hpp"

namespace pos::ins {

void RestAverage::add(const ImuIncrement& sample) {
  angle_ += sample.angle;
  velocity_ += sample.velocity;
  time_ += sample.dt;
}

Eigen::Quaterniond levelled(const Eigen::Vector3d& f, double yaw) {
  const double roll = std::atan2(f.y(), f.z());
  const double pitch = std::atan2(-f.x(), std::hypot(f.y(), f.z()));
  return Pose3::fromXyzYawPitchRoll(0.0, 0.0, 0.0, yaw, pitch, roll).rotation;
}

Eigen::Vector3d gyroBiasAtRest(const RestAverage& rest, const EarthPoint& here,
                               const Eigen::Quaterniond& q_n_b) {
  return rest.rate() - q_n_b.conjugate() * here.omega_ie;
}

std::optional<double> gyrocompassHeading(const RestAverage& rest, const EarthPoint& here) {
  const double north_rate = here.omega_ie.y();
  if (!(north_rate > 1e-7) || !(rest.time() > 0.0)) return std::nullopt;
  // Seen in axes levelled with heading 0, the level part of the Earth rate points north.
  const Eigen::Vector3d level = levelled(rest.force(), 0.0) * rest.rate();
  return std::atan2(level.x(), level.y());
}

Eigen::Matrix<double, 15, 15> alignmentCovariance(const AlignmentSigmas& sigmas, const Eigen::Matrix3d& C_n_b,
                                                  double gravity) {
  const auto square = [](double v) { return v * v; };
  Eigen::Matrix<double, 15, 15> P = Eigen::Matrix<double, 15, 15>::Zero();
  P.diagonal().segment<3>(kVelocity).setConstant(square(sigmas.velocity));
  P.diagonal().segment<3>(kPosition).setConstant(square(sigmas.position));
  P.diagonal().segment<3>(kGyroBias).setConstant(square(sigmas.gyro_bias));
  P.diagonal().segment<3>(kAccelerometerBias).setConstant(square(sigmas.accelerometer_bias));
  Eigen::Matrix3d tilt = Eigen::Matrix3d::Zero();  // phi from nabla in n
  tilt(0, 1) = -1.0 / gravity;
  tilt(1, 0) = 1.0 / gravity;
  const Eigen::Matrix3d phi_nabla = square(sigmas.accelerometer_bias) * tilt * C_n_b;
  P.block<3, 3>(kPhi, kAccelerometerBias) = phi_nabla;
  P.block<3, 3>(kAccelerometerBias, kPhi) = phi_nabla.transpose();
  P.block<3, 3>(kPhi, kPhi) = phi_nabla * (tilt * C_n_b).transpose();
  P(kPhi, kPhi) += square(sigmas.level);
  P(kPhi + 1, kPhi + 1) += square(sigmas.level);
  P(kPhi + 2, kPhi + 2) += square(sigmas.yaw);
  return P;
}

}  // namespace pos::ins
