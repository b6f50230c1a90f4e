#pragma once
/// What a scanner does to true ranges. Private to sim.

#include <limits>
#include <vector>

#include "pos/sim/lidar_stream.hpp"

namespace pos::sim {

constexpr double kNoReturn = std::numeric_limits<double>::infinity();

inline Pose3 poseOf(const Kinematics& body) {
  return {body.p_map, Eigen::Quaterniond(body.R_map_body)};
}

class Scanner {
 public:
  Scanner(const ScannerConfig& config, const Timing& timing, const RunSetup& run);

  double reportedAngle(int beam) const { return config_.angle_first + beam * config_.angle_step; }
  /// Where that beam truly looks, rad, with its random part.
  double lookAngle(int beam);
  /// The angle reported for a target at `truth` rad, with its random part.
  double reportedAngleOf(double truth);
  /// The range reported for a true one (m); nothing when lost, out of limits, or kNoReturn.
  std::optional<double> reportedRange(double t, double truth);
  /// A sweep of the true ranges of all beams, m, kNoReturn where there is nothing.
  Scan2D sweep(double t, const std::vector<double>& truths);

 private:
  double dropProbability(double t) const;

  ScannerConfig config_;
  RandomStream noise_;
  RandomStream drops_;
};

}  // namespace pos::sim
