#pragma once
/// State and models of `sins_dr` (docs/math/sins_dr.md). Pure functions.

#include "pos/core/belief.hpp"
#include "pos/core/pose3.hpp"
#include "pos/estimation/sins_configs.hpp"
#include "pos/filters/ekf.hpp"
#include "pos/ins/alignment.hpp"
#include "pos/ins/error_model.hpp"

namespace pos::estimation {

/// An inertial solution and a wheel solution that share one attitude, with what both sensors do wrong.
/// Tangent [phi, v, p, gyro bias, accelerometer bias, p of the wheels, scale, boresight pitch, yaw]; truth =
/// state (+) tangent with C <- Exp(phi) C in n, positions in metres east, north, up.
struct SinsDrState {
  static constexpr int kDof = 21;

  ins::Earth earth = ins::Earth::flat();
  ins::NavigationState nav;                                      ///< of the inertial unit
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< rad/s, in the reading
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< m/s^2, in the reading
  Eigen::Vector3d wheel_coordinates = Eigen::Vector3d::Zero();   ///< the unit's place by the wheels
  double scale = 0.0;                                            ///< wheels read (1 + scale) times the way
  double boresight_pitch = 0.0;  ///< rad, direction of rolling above the body's x axis
  double boresight_yaw = 0.0;    ///< rad, and to its left

  /// Direction in which the axle rolls, unit vector in b.
  Eigen::Vector3d rollingDirection() const;
};

/// First rows beside those of ins::ErrorRow.
enum SinsDrRow { kWheelPosition = 15, kScale = 18, kBoresightPitch = 19, kBoresightYaw = 20 };

SinsDrState plus(const SinsDrState& x, const Tangent<SinsDrState>& d);
Tangent<SinsDrState> minus(const SinsDrState& to, const SinsDrState& from);

/// Means over one interval of propagation.
struct SinsDrInput {
  Eigen::Vector3d force_b = Eigen::Vector3d::Zero();  ///< m/s^2, biases off
  Eigen::Vector3d wheel_v_n =
      Eigen::Vector3d::Zero();  ///< m/s, of the unit by the wheels, lever arm included
  double wheel_speed = 0.0;     ///< m/s, of the axle's middle, scale taken off
  double wheel_interval = 0.0;  ///< s between wheel readings
};

/// F of the errors [phi, dv, dp, eps, nabla, dp_D, dk, alpha] as the sources write them (19 states and two of
/// mounting); the tangent's signs are `errorSigns`.
Matrix<21, 21> sinsDrErrorF(const SinsDrState& x, const SinsDrInput& input);
/// +1 where the error is what the tangent is, -1 where it is estimate minus truth.
Vector<21> errorSigns();
/// Noise density (per second) of the same errors, diagonal but for the wheels' position.
Matrix<21, 21> sinsDrNoise(const SinsDrConfig& config, const SinsDrState& x, const SinsDrInput& input);
/// The covariance carried over one interval (the strapdown has moved the mean already), block by block:
/// P <- Phi (P + dt/2 q) Phi' + dt/2 q.
void propagate(Belief<SinsDrState>& belief, const SinsDrConfig& config, const SinsDrInput& input, double dt);
/// The wheels' part of it alone: what they rolled since the inertial unit was last heard. `moved_n` (m) is
/// the way of the unit by the wheels, `way` (m) that of the axle's middle, scale taken off.
void propagateWheels(Belief<SinsDrState>& belief, const SinsDrConfig& config, const Eigen::Vector3d& moved_n,
                     double way);
/// The same as full matrices, with every term of Phi = I + F dt + (F dt)^2 / 2: the oracle of tests.
filters::Step<SinsDrState> sinsDrStep(const SinsDrConfig& config, const SinsDrState& x,
                                      const SinsDrInput& input, double dt);

/// The state one wheel reading later: the axle's middle rolls `way` (m) along the direction it has halfway
/// between the attitudes, the unit swings round it.
SinsDrState rolled(SinsDrState x, const Eigen::Quaterniond& q_before, const Eigen::Quaterniond& q_now,
                   double way, const InertialMounts& mounts);

/// Inertial position minus wheel position is zero: three rows, m. `age` (s) is how long ago the inertial
/// solution was stamped.
filters::Innovation<SinsDrState, 3> positionDifference(const SinsDrState& x, double age);
/// Takes that difference with noise R as filters::correct would, without touching the zeros of H and with
/// P - W W' (W = P H' L'^-1, S = L L') on one half of P.
filters::Correction<3> correctDifference(Belief<SinsDrState>& belief, double age, const Matrix<3, 3>& R);
/// Inertial velocity minus the wheels' (v_n of the unit, m/s) is zero.
filters::Innovation<SinsDrState, 3> velocityDifference(const SinsDrState& x, const SinsDrInput& input);
/// The unit stands still.
filters::Innovation<SinsDrState, 3> zeroVelocity(const SinsDrState& x);
/// It does not turn either: `mean_rate` (rad/s, b) is what the gyros read, bias and Earth rate.
filters::Innovation<SinsDrState, 3> zeroRate(const SinsDrState& x, const Eigen::Vector3d& mean_rate);
/// No sideways and no upward speed of the axle, body axes; `rate` is the body's, rad/s.
filters::Innovation<SinsDrState, 2> noSidewaysSpeed(const SinsDrState& x, const Eigen::Vector3d& rate,
                                                    const InertialMounts& mounts);
/// A point of the body is seen at `offset_n` metres (n axes) from where the state puts it; `lever` leads from
/// the inertial unit to it (m, FLU).
filters::Innovation<SinsDrState, 3> positionFix(const SinsDrState& x, const Eigen::Vector3d& offset_n,
                                                const Eigen::Vector3d& lever);
/// The heading is seen to differ by `difference` rad (seen minus the state's).
filters::Innovation<SinsDrState, 1> headingFix(const SinsDrState& x, double difference);

/// The wheels' position forgotten and put at the inertial one: P <- T P T' with the rows of the one made
/// those of the other, so that their difference is known to be zero.
void reanchor(Belief<SinsDrState>& belief);

}  // namespace pos::estimation
