#include "pos/estimation/leg_sensor.hpp"

#include <cmath>

#include "pos/core/angle.hpp"

namespace pos::estimation {

LegSensor plus(LegSensor sensor, const LegSensorTangent& d) {
  sensor.yaw += d[0];
  sensor.pitch += d[1];
  sensor.scale += d[2];
  sensor.offset += d[3];
  sensor.angle_scale += d[4];
  sensor.angle_curve += d[5];
  return sensor;
}

CorrectedLeg corrected(const Eigen::Vector3d& measured, const LegSensor& sensor) {
  CorrectedLeg leg{measured, Eigen::Matrix<double, 3, LegSensor::kDof>::Zero()};
  const double range = measured.head<2>().norm();
  if (range == 0.0) return leg;
  const double rho = (range - sensor.offset) / (1.0 + sensor.scale);
  const double u = std::atan2(measured.y(), measured.x()) - 0.5 * kPi;
  const double turn = sensor.yaw + u * (sensor.angle_scale + u * sensor.angle_curve);
  const double c = std::cos(turn);
  const double s = std::sin(turn);
  const Eigen::Vector2d before = measured.head<2>() / range;
  const Eigen::Vector2d out(c * before.x() - s * before.y(), s * before.x() + c * before.y());
  const Eigen::Vector2d across(-out.y(), out.x());
  leg.p.head<2>() = rho * out;
  leg.p.z() -= sensor.pitch * leg.p.x();
  leg.by_errors.col(0).head<2>() = rho * across;
  leg.by_errors.col(2).head<2>() = -rho / (1.0 + sensor.scale) * out;
  leg.by_errors.col(3).head<2>() = -out / (1.0 + sensor.scale);
  leg.by_errors.col(4).head<2>() = rho * u * across;
  leg.by_errors.col(5).head<2>() = rho * u * u * across;
  leg.by_errors.row(2) = -sensor.pitch * leg.by_errors.row(0);
  leg.by_errors(2, 1) = -leg.p.x();
  return leg;
}

}  // namespace pos::estimation
