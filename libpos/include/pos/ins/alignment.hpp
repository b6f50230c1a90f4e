#pragma once
/// How the vehicle stands and what its gyros read at rest, from a while of standing still.

#include <optional>

#include "pos/ins/mechanisation.hpp"

namespace pos::ins {

/// Averages of an inertial unit at rest.
class RestAverage {
 public:
  void add(const ImuIncrement& sample);
  void forget() { *this = {}; }
  /// All of it as one increment.
  ImuIncrement sum() const { return {angle_, velocity_, time_}; }
  double time() const { return time_; }                        ///< s
  Eigen::Vector3d rate() const { return angle_ / time_; }      ///< rad/s in b, Earth rate and bias
  Eigen::Vector3d force() const { return velocity_ / time_; }  ///< m/s^2 in b

 private:
  Eigen::Vector3d angle_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  double time_ = 0.0;
};

/// Pitch and roll from gravity, heading as given: C_n_b with its x axis at `yaw` (rad, counter-clockwise from
/// east) seen from above.
Eigen::Quaterniond levelled(const Eigen::Vector3d& mean_force_b, double yaw);

/// What the gyros read at rest beyond the Earth rate: their bias (ZARU), rad/s in b.
Eigen::Vector3d gyroBiasAtRest(const RestAverage& rest, const EarthPoint& here,
                               const Eigen::Quaterniond& q_n_b);

/// Heading from the Earth's rate felt at rest (gyrocompassing), rad counter-clockwise from east. Good to the
/// east gyro's bias over the north Earth rate: nothing for MEMS gyros, 0.25 deg for 0.05 deg/h at 35 deg
/// latitude. Nothing where the Earth rate is not felt (flat Earth, poles).
std::optional<double> gyrocompassHeading(const RestAverage& rest, const EarthPoint& here);

/// What an alignment knows: covariance over the fifteen inertial errors [phi, dv, dp, eps, nabla].
struct AlignmentSigmas {
  double yaw = 0.0087;               ///< rad
  double velocity = 0.01;            ///< m/s
  double position = 0.001;           ///< m, per axis
  double gyro_bias = 8e-5;           ///< rad/s, left after the average
  double accelerometer_bias = 0.02;  ///< m/s^2
  double level = 1e-5;               ///< rad, tilt beyond what the accelerometer's bias explains

  bool operator==(const AlignmentSigmas&) const = default;
};

/// With the tilt correlated with the accelerometers' bias: at rest phi_E = -nabla_N / g, phi_N = nabla_E / g.
/// Leaving that out makes the filter drop the bias it could see.
Eigen::Matrix<double, 15, 15> alignmentCovariance(const AlignmentSigmas& sigmas, const Eigen::Matrix3d& C_n_b,
                                                  double gravity);

}  // namespace pos::ins
