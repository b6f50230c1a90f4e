#pragma once
/// How a vehicle moves, from a surveyed trajectory.

#include <span>

#include "pos/core/pose2.hpp"
#include "pos/core/stamp.hpp"

namespace pos::uwb {

/// How a vehicle's body frame lies in its motion, where it turns about and where it heads when driving
/// straight, and how its motion changes.
struct MotionCalibration {
  double centre_x = 0.0;        ///< m, the body frame lies this far ahead of where it turns about
  double course_offset = 0.0;   ///< rad, the straight course lies this far left of the body's x
  double residual_sigma = 0.0;  ///< m/s, sideways velocity that neither explains
  /// m/s^2 * sqrt(s) and rad/s^2 * sqrt(s), the white acceleration that changes speed and yaw rate as much
  /// within a second as they were seen to change.
  double acceleration_density = 0.0;
  double yaw_acceleration_density = 0.0;
  int samples = 0;  ///< pairs of poses used
};

struct TimedPose {
  Stamp stamp = {};
  Pose2 pose = {};
};

/// From differences over `interval` seconds of a surveyed trajectory while it moves faster than `speed_min`:
/// sideways velocity = speed tan(offset) + yaw rate centre. Fewer than 20 usable pairs give samples = 0.
MotionCalibration calibratedMotion(std::span<const TimedPose> poses, double interval = 0.5,
                                   double speed_min = 0.1);

}  // namespace pos::uwb
