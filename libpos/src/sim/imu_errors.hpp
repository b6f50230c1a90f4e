#pragma once
/// Errors of three like axes, sample after sample.

#include "pos/sim/imu.hpp"

namespace pos::sim {

class TriadNoise {
 public:
  /// `part` 0 for gyros, 1 for accelerometers; `dt` the sample interval in s.
  TriadNoise(const TriadErrors& errors, SensorSeed seed, unsigned part, double dt);

  /// The reading for the exact average over the next interval (U); for Increments multiplied by dt.
  Eigen::Vector3d reading(const Eigen::Vector3d& average, ImuSample::Kind kind);

 private:
  void drift();
  Eigen::Vector3d rounded(const Eigen::Vector3d& value, ImuSample::Kind kind);

  TriadErrors errors_;
  double dt_;
  RandomStream noise_;
  RandomStream drift_;
  Eigen::Matrix3d gain_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d instability_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d walk_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d remainder_ = Eigen::Vector3d::Zero();
};

}  // namespace pos::sim
