#pragma once
/// How errors of an inertial solution grow: the linear model that error-state filters propagate.
///
/// Errors: C^ = (I - [phi x]) C, dv = v^ - v, dp = p^ - p in metres east, north, up; sensors read truth +
/// bias.
///   d phi/dt = -w_in x phi + d w_in           - C eps
///   d dv/dt  = f x phi - (2 w_ie + w_en) x dv + v x (2 d w_ie + d w_en) + dg + C nabla
///   d dp/dt  = dv + (what the changing metric of the coordinates does)
/// (Jiang et al. 2024, eq. 10, written for metres; M_1, M_2 there are `phi_v`, `phi_p` here.)

#include <Eigen/Core>

#include "pos/ins/mechanisation.hpp"

namespace pos::ins {

/// The 3x3 blocks of F that are neither zero nor identity.
struct ErrorModel {
  Eigen::Matrix3d phi_phi;  ///< -[w_in x]
  Eigen::Matrix3d phi_v;
  Eigen::Matrix3d phi_p;
  Eigen::Matrix3d v_phi;  ///< [f_n x]
  Eigen::Matrix3d v_v;
  Eigen::Matrix3d v_p;
  Eigen::Matrix3d p_p;  ///< d dp/dt = dv + p_p dp
  Eigen::Matrix3d C;    ///< C_n_b: phi_eps = -C, v_nabla = C
};

/// At a state that feels the specific force f_b (m/s^2).
ErrorModel errorModel(const Earth& earth, const NavigationState& state, const Eigen::Vector3d& f_b);

/// d dp/dt by dp for a point at `coordinates` that moves with v_n: the error in metres of a position whose
/// coordinates are v over the metric.
Eigen::Matrix3d metricRate(const EarthPoint& here, const Eigen::Vector3d& v_n);

/// Rows and columns of the first fifteen states in every filter of this library that has them.
enum ErrorRow {
  kPhi = 0,
  kVelocity = 3,
  kPosition = 6,
  kGyroBias = 9,
  kAccelerometerBias = 12,
  kInertial = 15
};

/// The whole 15 x 15 matrix [phi, dv, dp, eps, nabla].
Eigen::Matrix<double, kInertial, kInertial> denseF(const ErrorModel& model);

}  // namespace pos::ins
