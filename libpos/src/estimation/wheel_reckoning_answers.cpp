#include <algorithm>
#include <cmath>

#include "pos/estimation/wheel_reckoning.hpp"

#include "pos/core/square.hpp"

// What dead reckoning answers, from either of its beliefs.

namespace pos::estimation {
namespace {}  // namespace

Estimate WheelReckoning::headingEstimate() const {
  const WheelHeading& x = heading_.mean;
  Estimate e;
  e.T_map_body.rotation = x.rotation();
  const Eigen::Vector3d arm = e.T_map_body.rotation * config_.mounts.axle;
  e.T_map_body.translation = x.p_map - arm;
  Matrix<6, 6> J = Matrix<6, 6>::Identity();
  J.topRightCorner<3, 3>() = ins::skew(arm) * e.T_map_body.rotation.toRotationMatrix();
  e.covariance = J * poseCovariance(heading_) * J.transpose();
  return e;
}

Estimate WheelReckoning::gyroEstimate() const {
  const GyroWheel& x = gyros_.mean;
  const Eigen::Matrix3d R = R_map_n();
  const Eigen::Vector3d arm_n = x.q_n_b * config_.mounts.axle;
  Estimate e;
  e.T_map_body.rotation = (Eigen::Quaterniond(R) * x.q_n_b).normalized();
  e.T_map_body.translation = earth_.position(x.coordinates) - R * arm_n;
  Matrix<6, 10> J = Matrix<6, 10>::Zero();
  J.block<3, 3>(0, kPlace) = R;
  J.block<3, 3>(0, kAttitude) = R * ins::skew(arm_n);
  J.block<3, 3>(3, kAttitude) = x.q_n_b.toRotationMatrix().transpose();
  e.covariance = J * gyros_.covariance * J.transpose();
  return e;
}

std::optional<Estimate> WheelReckoning::estimateAt(Stamp stamp) const {
  if (!last_stamp_ || stamp < *last_stamp_) return std::nullopt;
  if (!running_) {
    const Belief<Pose2> at = prior();
    return planarEstimate(stamp, at.mean, at.covariance, config_.height);
  }
  const bool by_gyros = config_.variant == Variant::EncodersAttitude;
  Estimate estimate = by_gyros ? gyroEstimate() : headingEstimate();
  estimate.stamp = stamp;
  // On at the wheels' last speed.
  const double dt = rolled_stamp_ ? seconds(stamp - *rolled_stamp_) : 0.0;
  estimate.T_map_body.translation +=
      dt * (by_gyros ? Eigen::Vector3d(R_map_n() * v_n_)
                     : Eigen::Vector3d(heading_.mean.rotation() * Eigen::Vector3d(speed_, 0.0, 0.0)));
  estimate.covariance.diagonal().head<3>().array() +=
      square(0.5 * dt) * dt / 3.0;  // 0.5 m/s^2 sqrt(s) unknown
  filters::symmetrise(estimate.covariance);
  return estimate;
}

Diagnostics WheelReckoning::diagnostics() const {
  Diagnostics values{{"distance_m", distance_}};
  const auto add = [&](const char* name, double value, double variance) {
    values.push_back({name, value, running_ ? std::sqrt(std::max(0.0, variance)) : 0.0});
  };
  if (usesGyros()) {
    add("gyro_bias_z_rad_per_s", gyros_.mean.gyro_bias.z(), gyros_.covariance(kRateBias + 2, kRateBias + 2));
  }
  if (config_.variant == Variant::EkfHeading) {
    const auto& P = heading_.covariance;
    add("yaw_bias_rad", heading_.mean.yaw_bias, P(kYawBias, kYawBias));
    add("track_error", heading_.mean.track_error, P(kTrackError, kTrackError));
  }
  return values;
}

}  // namespace pos::estimation
