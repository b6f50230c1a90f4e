#pragma once
/// How the nominal state of an error-state filter moves with an inertial unit, and its covariance with it
/// (J. China Coal Soc. 2024, doi 10.13225/j.cnki.jccs.2024.0676, eqs. 3 to 7 corrected). docs/math/eskf.md
/// walks through it.
///
/// The Earth does not turn here: 15 deg/h is far below the bias of a MEMS gyro.

#include "pos/core/belief.hpp"
#include "pos/ins/eskf_state.hpp"
#include "pos/ins/mechanisation.hpp"

namespace pos::ins {

/// Densities of an inertial unit's noise, so that nothing depends on its rate, and gravity.
struct EskfProcess {
  double accelerometer_density = 2e-3;    ///< n_a, m/s^2/sqrt(Hz)
  double gyro_density = 2e-4;             ///< n_g, rad/s/sqrt(Hz)
  double accelerometer_bias_walk = 1e-4;  ///< n_ba, m/s^2 per sqrt(s)
  double gyro_bias_walk = 1e-6;           ///< n_bg, rad/s per sqrt(s)
  double gravity = 9.80665;               ///< m/s^2, downward

  bool operator==(const EskfProcess&) const = default;
};

/// The blocks of F_x that are neither zero nor identity. The position needs none of its own:
///   dp' = dp + dt/2 (dv + dv')
struct EskfTransition {
  double dt = 0.0;  ///< s
  Eigen::Matrix3d v_by_attitude;
  Eigen::Matrix3d v_by_accelerometer_bias;
  Eigen::Matrix3d v_by_gyro_bias;
  Eigen::Matrix3d attitude_by_attitude;
  Eigen::Matrix3d attitude_by_gyro_bias;

  /// F_x in full: the oracle of tests, and the yardstick of bench/eskf.
  Matrix<15, 15> dense() const;
  /// F_x times `columns` (15 rows), for what is correlated with the state beside its own covariance.
  Eigen::Matrix<double, 15, Eigen::Dynamic> carried(
      const Eigen::Matrix<double, 15, Eigen::Dynamic>& columns) const;
};

struct EskfStep {
  EskfState next;
  EskfTransition F;
};

/// One sample of the unit, biases and all, further: force and turn rate are constant in body axes over the
/// sample, and for that case attitude and velocity are exact and the position is the trapezoid's. dt = 0
/// changes nothing. F leaves out only what is below the cube of the sample's turn.
EskfStep stepped(const EskfState& x, const ImuIncrement& raw, double gravity);
/// The same without F.
EskfState steppedMean(const EskfState& x, const ImuIncrement& raw, double gravity);

/// Noise that one sample adds, diagonal: n_a^2, n_g^2, n_ba^2, n_bg^2 times dt; none on the position.
Vector<15> processNoise(const EskfProcess& process, double dt);

/// P <- F (P + Q/2) F' + Q/2, block by block and symmetric to the last bit. The paper's impulse Q at the end
/// of the step makes the variance of the position depend on the rate (3 % after 1 s at 50 Hz).
void carry(Matrix<15, 15>& P, const EskfTransition& F, const Vector<15>& Q);
/// The same with full matrices.
Matrix<15, 15> carriedDense(const Matrix<15, 15>& P, const EskfTransition& F, const Vector<15>& Q);

/// The belief one sample further.
void propagate(Belief<EskfState>& belief, const ImuIncrement& raw, const EskfProcess& process);

}  // namespace pos::ins
