#pragma once
/// State and models of `dead_reckoning`, variant `encoders_attitude`: gyros turn, wheels drive (Jiang et al.
/// 2024, eqs. 3-5). docs/math/dead_reckoning.md. Pure functions.

#include "pos/core/belief.hpp"
#include "pos/estimation/sins_configs.hpp"
#include "pos/filters/ekf.hpp"
#include "pos/ins/mechanisation.hpp"

namespace pos::estimation {

/// Attitude by the gyros, place by the wheels. Tangent [phi, gyro bias, p, scale]; truth = state (+) tangent
/// with C <- Exp(phi) C in n, p in metres east, north, up.
struct GyroWheel {
  static constexpr int kDof = 10;

  ins::Earth earth = ins::Earth::flat();
  Eigen::Quaterniond q_n_b = Eigen::Quaterniond::Identity();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();    ///< rad/s, in the reading
  Eigen::Vector3d coordinates = Eigen::Vector3d::Zero();  ///< of the axle's middle
  double scale = 0.0;                                     ///< wheels read (1 + scale) times the way
};

/// First rows of the tangent.
enum GyroWheelRow { kAttitude = 0, kRateBias = 3, kPlace = 6, kWayScale = 9 };

GyroWheel plus(const GyroWheel& x, const Tangent<GyroWheel>& d);
Tangent<GyroWheel> minus(const GyroWheel& to, const GyroWheel& from);

/// Turned by what the gyros felt (bias off), over an Earth that turns and curves; `v_n` as below.
GyroWheel turned(GyroWheel x, const ins::ImuIncrement& increment, const Eigen::Vector3d& v_n);
/// The axle's middle rolls `way` (m, scale taken off) along the direction it has halfway between the
/// attitudes; the chord of the arc.
GyroWheel rolled(GyroWheel x, const Eigen::Quaterniond& q_before, const Eigen::Quaterniond& q_now,
                 double way);
/// F (per second) of the tangent while the axle's middle moves with v_n (m/s).
Matrix<10, 10> gyroWheelF(const GyroWheel& x, const Eigen::Vector3d& v_n);
/// F and Qd of one interval; `next` is the state itself (`turned` and `rolled` have moved it already).
filters::Step<GyroWheel> gyroWheelStep(const GyroWheel& x, const Eigen::Vector3d& v_n, double dt,
                                       const ImuNoise& imu, const ins::OdometerConfig& odometer);
/// Standing still: `mean_rate` (rad/s, b) is what the gyros read, bias and Earth rate.
filters::Innovation<GyroWheel, 3> zeroRate(const GyroWheel& x, const Eigen::Vector3d& mean_rate);

}  // namespace pos::estimation
