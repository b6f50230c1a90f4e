#pragma once
/// Errors of three like axes, sample after sample.

#include "pos/sim/imu.hpp"

namespace pos::sim {

class TriadNoise {
 public:
  enum class Part : std::uint32_t { Gyros = 0, Accelerometers = 1 };
  TriadNoise(const TriadErrors& errors, Part part, const Timing& timing, const RunSetup& run);

  enum class Ride { Standing, Moving };
  /// The reading for the exact average (U) over the next interval of `dt` s; for Increments multiplied by dt.
  Eigen::Vector3d reading(const Eigen::Vector3d& average, double dt, ImuSample::Kind kind, Ride ride);

 private:
  void drift(double dt);
  Eigen::Vector3d rounded(const Eigen::Vector3d& value, ImuSample::Kind kind);

  TriadErrors errors_;
  RandomStream noise_;
  RandomStream drift_;
  Eigen::Matrix3d gain_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d instability_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d walk_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d remainder_ = Eigen::Vector3d::Zero();
};

}  // namespace pos::sim
