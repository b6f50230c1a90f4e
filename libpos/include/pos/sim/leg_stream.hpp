#pragma once
/// Simulated laser scanner on a shearer that sees the supports' legs (spec B, B10).

#include <memory>

#include "pos/sim/lidar_stream.hpp"
#include "pos/sim/support_legs.hpp"

namespace pos::sim {

/// Legs: whole sweeps, ray cast against tilted cylinders with occlusion; one Scan2D a sweep, for an estimator
/// that finds the legs itself.
/// Points: legs are 3-D points measured directly. One Scan2D of a single beam per visible leg, all of a sweep
/// with the same stamp, in the order of the supports' numbers. Its T_body_sensor is the scanner's mount
/// turned so that the beam (angle 0) points along the measured bearing and elevation: the leg's measured
/// position is T_body_sensor * (range, 0, 0), in body axes under the nominal mount. `range` is a float (about
/// 1e-6 m at 10 m).
enum class LegModel { Legs, Points };

struct LegConfig {
  std::string sensor = "lidar";
  Timing timing = {.rate = 25.0};
  LegModel model = LegModel::Points;
  ScannerConfig scanner = {};  ///< nominal mount; what estimators are told
  /// rad, rotation vector in body axes: the true mount is the nominal one turned by it (spec B, B2: delta
  /// alpha).
  Eigen::Vector3d mount_error = Eigen::Vector3d::Zero();
  SupportRow row = {};
  double reach = 13.0;  ///< m along the face: legs farther off are not simulated
};

/// Throws ConfigError naming the first thing wrong.
LegConfig validated(LegConfig config);

class LegStream : public SensorStream {
 public:
  LegStream(const LegConfig& config, LegPlacer leg, std::shared_ptr<const Motion> motion,
            const RunSetup& run);
  ~LegStream() override;
  std::optional<Delivery> next() override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pos::sim
