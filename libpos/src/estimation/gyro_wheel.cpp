#include "pos/estimation/gyro_wheel.hpp"

#include <cmath>

#include "pos/core/pose3.hpp"
#include "pos/core/square.hpp"
#include "pos/ins/error_model.hpp"
#include "pos/ins/odometer.hpp"

namespace pos::estimation {
namespace {}  // namespace

GyroWheel plus(const GyroWheel& x, const Tangent<GyroWheel>& d) {
  GyroWheel next = x;
  next.q_n_b = (quaternionFromRotationVector(d.segment<3>(kAttitude)) * x.q_n_b).normalized();
  next.gyro_bias += d.segment<3>(kRateBias);
  next.coordinates += d.segment<3>(kPlace).cwiseQuotient(x.earth.at(x.coordinates).metric);
  next.scale += d[kWayScale];
  return next;
}

Tangent<GyroWheel> minus(const GyroWheel& to, const GyroWheel& from) {
  Tangent<GyroWheel> d;
  d.segment<3>(kAttitude) = rotationVector(to.q_n_b * from.q_n_b.conjugate());
  d.segment<3>(kRateBias) = to.gyro_bias - from.gyro_bias;
  d.segment<3>(kPlace) =
      (to.coordinates - from.coordinates).cwiseProduct(from.earth.at(from.coordinates).metric);
  d[kWayScale] = to.scale - from.scale;
  return d;
}

GyroWheel turned(GyroWheel x, const ins::ImuIncrement& increment, const Eigen::Vector3d& v_n) {
  const ins::EarthPoint here = x.earth.at(x.coordinates);
  const Eigen::Vector3d omega_in = here.omega_ie + here.omega_en(v_n);
  x.q_n_b = (quaternionFromRotationVector(-increment.dt * omega_in) * x.q_n_b *
             quaternionFromRotationVector(increment.angle))
                .normalized();
  return x;
}

GyroWheel rolled(GyroWheel x, const Eigen::Quaterniond& q_before, const Eigen::Quaterniond& q_now,
                 double way) {
  const double chord = way * ins::sinc(0.5 * q_before.angularDistance(q_now));
  const Eigen::Vector3d moved = q_before.slerp(0.5, q_now) * Eigen::Vector3d(chord, 0.0, 0.0);
  x.coordinates += moved.cwiseQuotient(x.earth.at(x.coordinates).metric);
  return x;
}

Matrix<10, 10> gyroWheelF(const GyroWheel& x, const Eigen::Vector3d& v_n) {
  const ins::EarthPoint here = x.earth.at(x.coordinates);
  Matrix<10, 10> F = Matrix<10, 10>::Zero();
  F.block<3, 3>(kAttitude, kAttitude) = -ins::skew(here.omega_ie + here.omega_en(v_n));
  F.block<3, 3>(kAttitude, kRateBias) = -x.q_n_b.toRotationMatrix();
  F.block<3, 3>(kPlace, kAttitude) = -ins::skew(v_n);
  F.block<3, 3>(kPlace, kPlace) = ins::metricRate(here, v_n);
  F.block<3, 1>(kPlace, kWayScale) = -v_n / (1.0 + x.scale);
  return F;
}

filters::Step<GyroWheel> gyroWheelStep(const GyroWheel& x, const Eigen::Vector3d& v_n, double dt,
                                       const ImuNoise& imu, const ins::OdometerConfig& odometer) {
  const Matrix<10, 10> FT = dt * gyroWheelF(x, v_n);
  const Matrix<10, 10> Phi = Matrix<10, 10>::Identity() + FT + 0.5 * FT * FT;
  Matrix<10, 10> q = Matrix<10, 10>::Zero();
  q.diagonal().segment<3>(kAttitude).setConstant(square(imu.gyro_density));
  q.diagonal().segment<3>(kRateBias).setConstant(square(imu.gyro_bias_walk));
  // Each wheel's way has k_d^2 |way|; their mean half of it, along the way.
  const Eigen::Vector3d along = x.q_n_b * Eigen::Vector3d::UnitX();
  q.block<3, 3>(kPlace, kPlace) =
      0.5 * square(odometer.noise_per_sqrt_m) * v_n.norm() * along * along.transpose();
  return {x, Phi, 0.5 * dt * (Phi * q * Phi.transpose() + q)};
}

filters::Innovation<GyroWheel, 3> zeroRate(const GyroWheel& x, const Eigen::Vector3d& mean_rate) {
  const Eigen::Matrix3d C_b_n = x.q_n_b.toRotationMatrix().transpose();
  const Eigen::Vector3d omega_ie = x.earth.at(x.coordinates).omega_ie;
  filters::Innovation<GyroWheel, 3> innovation{mean_rate - (C_b_n * omega_ie + x.gyro_bias),
                                               Matrix<3, 10>::Zero()};
  innovation.H.block<3, 3>(0, kAttitude) = C_b_n * ins::skew(omega_ie);
  innovation.H.block<3, 3>(0, kRateBias).setIdentity();
  return innovation;
}

}  // namespace pos::estimation
