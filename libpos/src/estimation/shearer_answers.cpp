// What the shearer says of itself.
#include <algorithm>
#include <cmath>

#include "parts.hpp"
#include "pos/estimation/shearer.hpp"
#include "pos/filters/ekf.hpp"

namespace pos::estimation {

using ins::kAccelerometerBias;
using ins::kGyroBias;
using ins::kPhi;
using ins::kPosition;
using ins::kVelocity;

std::optional<Estimate> Shearer::estimateAt(Stamp stamp) const {
  if (!last_stamp_ || stamp < *last_stamp_) return std::nullopt;
  if (!running_) {
    if (!given_) return std::nullopt;
    return planarEstimate(stamp, given_->mean, given_->covariance, config_.alignment.height);
  }
  const double dt = std::max(0.0, seconds(stamp - *imu_.stamp()));
  const ShearerBelief& belief = best().belief();
  const ShearerState& x = belief.mean;
  const Eigen::Vector3d arm_n = x.nav.q_n_b * config_.imu_place;
  Estimate estimate;
  estimate.stamp = stamp;
  estimate.T_map_body.rotation = x.nav.q_n_b;
  estimate.T_map_body.translation = x.nav.coordinates + dt * x.nav.v_n - arm_n;
  Matrix<6, 15> J = Matrix<6, 15>::Zero();
  J.block<3, 3>(0, kPosition).setIdentity();
  J.block<3, 3>(0, kVelocity) = dt * Matrix<3, 3>::Identity();
  J.block<3, 3>(0, kPhi) = ins::skew(arm_n);
  J.block<3, 3>(3, kPhi) = x.nav.C_n_b().transpose();
  const Matrix<15, 15> P = belief.covariance.topLeftCorner<15, 15>();
  estimate.covariance = J * P * J.transpose();
  estimate.covariance.diagonal().head<3>().array() +=
      square(0.5 * dt) * dt / 3.0;  // 0.5 m/s^2 sqrt(s) unknown
  filters::symmetrise(estimate.covariance);
  return estimate;
}

Diagnostics Shearer::diagnostics() const {
  if (!running_) return {};
  const ShearerBelief& belief = best().belief();
  const ShearerState& x = belief.mean;
  const auto sigma = [&](int row) { return std::sqrt(std::max(0.0, belief.covariance(row, row))); };
  Diagnostics values{{"degraded", best().degraded() ? 1.0 : 0.0},
                     {"mode", static_cast<double>(best().mode())},
                     {"legs", static_cast<double>(best().legs())},
                     {"cycles", static_cast<double>(best().progress().arrivals())},
                     {"picm_angle_rad", eta_},
                     {"mount_yaw_rad", x.sensor.yaw, x.sensor_states ? sigma(x.sensorRow()) : 0.0}};
  if (x.sensor_states) {
    values.push_back({"mount_pitch_rad", x.sensor.pitch, sigma(x.sensorRow() + 1)});
    values.push_back({"range_scale", x.sensor.scale, sigma(x.sensorRow() + 2)});
    values.push_back({"range_offset_m", x.sensor.offset, sigma(x.sensorRow() + 3)});
    values.push_back({"angle_scale", x.sensor.angle_scale, sigma(x.sensorRow() + 4)});
    values.push_back({"angle_curve_per_rad", x.sensor.angle_curve, sigma(x.sensorRow() + 5)});
  }
  addAxes(values, "gyro_bias", "rad_per_s", x.gyro_bias, kGyroBias, sigma);
  addAxes(values, "accelerometer_bias", "m_per_s2", x.accelerometer_bias, kAccelerometerBias, sigma);
  for (const DwellCreep& dwell : creep_.creeps()) {
    const std::string name = "creep_" + std::to_string(dwell.operation);
    values.push_back({name + "_weak_share", dwell.weak_share});
    if (dwell.creep.usable) values.push_back({name + "_m", dwell.creep.value, dwell.creep.sigma});
  }
  return values;
}

}  // namespace pos::estimation
