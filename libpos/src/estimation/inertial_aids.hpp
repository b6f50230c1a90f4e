#pragma once
/// What is known of the motion beside the ranges, as corrections of any of the three inertial filters.
/// Private to `uwb_imu`.

#include <cmath>

#include "parts.hpp"
#include "pos/core/chi_square.hpp"
#include "pos/estimation/inertial_filters.hpp"
#include "pos/estimation/uwb_imu_config.hpp"
#include "pos/ins/alignment.hpp"

namespace pos::estimation {

/// The gate of aids and fixes of `dof` numbers.
inline filters::Gate aidGate(int dof) {
  constexpr double kConfidence = 0.999;
  return {chiSquareQuantile(kConfidence, static_cast<double>(dof))};
}

/// The body frame keeps the height it started with.
template <class Filter>
void aidHeight(Filter& filter, const UwbImuConfig& config) {
  const double sigma = config.aids.height_sigma;
  if (!(sigma > 0.0)) return;
  const auto height = [&](const EskfState& x) { return pointHeight(x, config.height, -config.mounts.imu); };
  (void)filter.template correct<1>(height, Matrix<1, 1>(square(sigma)), filters::Gate{});
}

/// The axle that does not steer rolls where it looks. `gyro` as the unit reads it, rad/s.
template <class Filter>
void aidRolling(Filter& filter, const UwbImuConfig& config, const Eigen::Vector3d& gyro) {
  const double sigma = config.aids.lateral_sigma;
  if (!(sigma > 0.0)) return;
  const auto straight = [&](const EskfState& x) {
    return noSideSlip(x, config.mounts.axle - config.mounts.imu, gyro);
  };
  const Matrix<2, 2> R = square(sigma) * Matrix<2, 2>::Identity();
  (void)filter.template correct<2>(straight, R, aidGate(2));
}

/// Zero velocity, and what the gyros read is their bias (`rate`: readings since the last aid); both gated,
/// for a vehicle that is carried is quiet.
template <class Filter>
void aidStandstill(Filter& filter, const UwbImuConfig& config, const ins::RestAverage& rate) {
  const double sigma = config.aids.zero_velocity_sigma;
  if (!(sigma > 0.0)) return;
  (void)filter.template correct<3>(atRest, diagonal3(sigma), aidGate(3));
  if (!config.alignment.zero_rate || rate.time() <= 0.0) return;
  const auto quiet = [&](const EskfState& x) { return notTurning(x, rate.rate()); };
  (void)filter.template correct<3>(quiet, diagonal3(config.imu.gyro_density / std::sqrt(rate.time())),
                                   aidGate(3));
}

/// The wheels carry the axle forward with `speed` (m/s).
template <class Filter>
filters::Correction<1> aidWheels(Filter& filter, const UwbImuConfig& config, double speed,
                                 const Eigen::Vector3d& gyro) {
  const auto wheels = [&](const EskfState& x) {
    return wheelSpeed(x, speed, config.mounts.axle - config.mounts.imu, gyro);
  };
  return filter.template correct<1>(wheels, Matrix<1, 1>(square(config.aids.wheel_speed_sigma)), aidGate(1));
}

}  // namespace pos::estimation
