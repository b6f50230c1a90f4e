#include "pos/ins/eskf_state.hpp"

#include <cmath>

#include "pos/core/pose3.hpp"
#include "pos/ins/mechanisation.hpp"

namespace pos::ins {
namespace {

constexpr double kSmallAngle = 1e-2;  // rad: below it the quotients lose more digits than their series

}  // namespace

EskfState plus(const EskfState& x, const Vector<15>& d) {
  EskfState y;
  y.p_map = x.p_map + d.segment<3>(EskfState::kPosition);
  y.v_map = x.v_map + d.segment<3>(EskfState::kVelocity);
  y.q_map_body =
      (x.q_map_body * quaternionFromRotationVector(d.segment<3>(EskfState::kAttitude))).normalized();
  y.accelerometer_bias = x.accelerometer_bias + d.segment<3>(EskfState::kAccelerometerBias);
  y.gyro_bias = x.gyro_bias + d.segment<3>(EskfState::kGyroBias);
  return y;
}

Vector<15> minus(const EskfState& to, const EskfState& from) {
  Vector<15> d;
  d << to.p_map - from.p_map, to.v_map - from.v_map,
      rotationVector(from.q_map_body.conjugate() * to.q_map_body),
      to.accelerometer_bias - from.accelerometer_bias, to.gyro_bias - from.gyro_bias;
  return d;
}

Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& theta) {
  const double n2 = theta.squaredNorm();
  const double n = std::sqrt(n2);
  const Eigen::Matrix3d T = skew(theta);
  double a = 0.5 - n2 * (1.0 / 24.0 - n2 / 720.0);          // (1 - cos n) / n^2
  double b = 1.0 / 6.0 - n2 * (1.0 / 120.0 - n2 / 5040.0);  // (n - sin n) / n^3
  if (n > kSmallAngle) {
    a = 2.0 * std::pow(std::sin(0.5 * n) / n, 2);
    b = (n - std::sin(n)) / (n2 * n);
  }
  return Eigen::Matrix3d::Identity() - a * T + b * T * T;
}

Eigen::Matrix3d rightJacobianInverse(const Eigen::Vector3d& theta) {
  const double n2 = theta.squaredNorm();
  const double n = std::sqrt(n2);
  const Eigen::Matrix3d T = skew(theta);
  double c = 1.0 / 12.0 + n2 / 720.0;  // 1 / n^2 - cot(n / 2) / (2 n)
  if (n > kSmallAngle) c = (1.0 - 0.5 * n / std::tan(0.5 * n)) / n2;
  return Eigen::Matrix3d::Identity() + 0.5 * T + c * T * T;
}

void turnAttitude(Matrix<15, 15>& P, const Eigen::Matrix3d& block) {
  constexpr int a = EskfState::kAttitude;
  const Matrix<15, 3> columns = P.middleCols<3>(a).lazyProduct(block.transpose());
  P.middleCols<3>(a) = columns;
  P.middleRows<3>(a) = columns.transpose();
  const Eigen::Matrix3d corner = block.lazyProduct(columns.middleRows<3>(a));
  P.block<3, 3>(a, a) = 0.5 * (corner + corner.transpose());
}

Matrix<15, 15> transported(const EskfState& /*x*/, const Vector<15>& e, Matrix<15, 15> P) {
  turnAttitude(P, rightJacobianInverse(e.segment<3>(EskfState::kAttitude)));
  return P;
}

}  // namespace pos::ins
