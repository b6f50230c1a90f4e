#pragma once
/// The state of an error-state filter on an inertial unit: nominal values of sixteen numbers, error of
/// fifteen (J. China Coal Soc. 2024, doi 10.13225/j.cnki.jccs.2024.0676, eqs. 2 and 3).
///
/// x = (p, v, q, a_b, w_b)    dx = (dp, dv, dtheta, da_b, dw_b)    q_true = q (x) Exp(dtheta), dtheta in body
/// axes

#include <Eigen/Geometry>

#include "pos/core/manifold.hpp"

namespace pos::ins {

struct EskfState {
  static constexpr int kDof = 15;
  /// First row of each part in tangents and covariances.
  static constexpr int kPosition = 0;
  static constexpr int kVelocity = 3;
  static constexpr int kAttitude = 6;
  static constexpr int kAccelerometerBias = 9;
  static constexpr int kGyroBias = 12;

  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< m, of the inertial unit
  Eigen::Vector3d v_map = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Quaterniond q_map_body = Eigen::Quaterniond::Identity();
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< m/s^2, in the reading
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< rad/s, in the reading

  Eigen::Matrix3d R_map_body() const { return q_map_body.toRotationMatrix(); }
};

EskfState plus(const EskfState& x, const Vector<15>& d);
Vector<15> minus(const EskfState& to, const EskfState& from);

/// J_r(theta), with Exp(theta + d) = Exp(theta) Exp(J_r d) for a small d; a series near zero.
Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& theta);
/// Its inverse, for |theta| < pi.
Eigen::Matrix3d rightJacobianInverse(const Eigen::Vector3d& theta);

/// P <- G P G' with G the identity but for `block` at the attitude: what moving the point that the tangent is
/// seen from does to a covariance. With rightJacobian(dtheta) it is the reset after dtheta was injected
/// (eq. 18, exact instead of I - [dtheta x] / 2); with its inverse the covariance as seen from a state that
/// lies dtheta before this one (mixing of filters).
void turnAttitude(Matrix<15, 15>& P, const Eigen::Matrix3d& block);

/// P of a filter at `x` as seen from the state from which x lies at `e`: what filters::merged asks for.
Matrix<15, 15> transported(const EskfState& x, const Vector<15>& e, Matrix<15, 15> P);

}  // namespace pos::ins
