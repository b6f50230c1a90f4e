#pragma once
/// What an estimator is told of its start.

#include "pos/core/belief.hpp"
#include "pos/core/pose2.hpp"

namespace pos::estimation {

/// What is known of the pose at the first measurement.
enum class StartMode {
  Known,           ///< position and heading, with the sigmas given
  UnknownHeading,  ///< position as given, heading anything
  Unknown,         ///< nothing: from the first ranges, or uniformly over the map
  AtTruth,         ///< the mark where the reference begins; the app spells it out as one of the others
};

struct StartConfig {
  StartMode mode = StartMode::Known;
  Pose2 pose;                   ///< map frame; yaw is ignored for UnknownHeading, all for Unknown
  double position_sigma = 0.1;  ///< m, per axis
  double yaw_sigma = 0.05;      ///< rad

  bool operator==(const StartConfig&) const = default;
};

/// Pose and sigmas of a start that is known.
inline Belief<Pose2> knownStart(const StartConfig& start) {
  const double p = start.position_sigma * start.position_sigma;
  return {start.pose, Vector<3>(p, p, start.yaw_sigma * start.yaw_sigma).asDiagonal()};
}

}  // namespace pos::estimation
