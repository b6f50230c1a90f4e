#pragma once
/// What scanner and mount do wrong to a leg's place, and what the place is without it (Zheng et al. 2021,
/// eq. 4 and section 3.1; the angle's polynomial about the middle of the scan).

#include <Eigen/Core>

namespace pos::estimation {

/// rho = (rho~ - offset) / (1 + scale), theta = theta~ + yaw + angle_scale u + angle_curve u^2 with
/// u = theta~ - pi/2, rad. The yaw is that of the mount and the polynomial's constant in one. The pitch turns
/// the scan plane about the scanner's y axis.
struct LegSensor {
  static constexpr int kDof = 6;
  double yaw = 0.0;
  double pitch = 0.0;  ///< of the mount, nose down: a leg ahead stands lower than it seems
  double scale = 0.0;
  double offset = 0.0;  ///< m
  double angle_scale = 0.0;
  double angle_curve = 0.0;
};

using LegSensorTangent = Eigen::Matrix<double, LegSensor::kDof, 1>;  ///< in the order of the fields
LegSensor plus(LegSensor sensor, const LegSensorTangent& d);

/// A leg's place in scanner axes under the nominal mount (m), and its derivative by the errors.
struct CorrectedLeg {
  Eigen::Vector3d p;
  Eigen::Matrix<double, 3, LegSensor::kDof> by_errors;
};
/// `measured` in scanner axes, x forward, y towards the legs; its height stays. The origin itself has no
/// bearing: it comes back as it is.
CorrectedLeg corrected(const Eigen::Vector3d& measured, const LegSensor& sensor);

}  // namespace pos::estimation
