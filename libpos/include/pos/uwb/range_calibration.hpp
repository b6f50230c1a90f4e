#pragma once
/// What every link reads too long, from ranges taken at known poses: along a surveyed trajectory, or standing
/// still.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "pos/core/measurement.hpp"
#include "pos/core/pose2.hpp"
#include "pos/core/stamp.hpp"

namespace pos::uwb {

/// A range with the pose of the body at its stamp.
struct CalibrationSample {
  Stamp stamp = {};
  TagId tag = 0;
  AnchorId anchor = 0;
  Eigen::Vector3d tag_body = Eigen::Vector3d::Zero();    ///< m, the mount
  Eigen::Vector3d anchor_map = Eigen::Vector3d::Zero();  ///< m
  Pose2 pose = {};
  double body_height = 0.0;  ///< m
  double range = 0.0;        ///< m
};

struct CalibrationOptions {
  double shift_sigma = 0.05;  ///< m, how far a tag's electrical place may lie from its mount; 0 = not at all
  double bias_spread = 0.1;   ///< m, how much the links' biases differ from each other
  double correlation_time = 1.0;  ///< s, ranges of one link within it share their error and count as one
  double outlier_sigmas = 3.5;    ///< residuals beyond this many sigmas are left out
};

/// One link: read minus true, m.
struct LinkCalibration {
  TagId tag = 0;
  AnchorId anchor = 0;
  double bias = 0.0;
  double bias_sigma = 0.0;  ///< how sure the bias is
  double residual_sigma = 0.0;
  int samples = 0;
  int outliers = 0;
};

/// One tag: electrical place minus mount, body axes, m. An antenna whose delay depends on the direction looks
/// like that to first order, and the yaw of a short baseline depends on it.
struct TagCalibration {
  TagId tag = 0;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  Eigen::Vector2d sigma = Eigen::Vector2d::Zero();
};

struct RangeCalibration {
  std::vector<LinkCalibration> links;  ///< by tag, then anchor
  std::vector<TagCalibration> tags;    ///< by tag; empty when shift_sigma is 0
  double residual_sigma = 0.0;         ///< m, of all ranges kept
  int samples = 0;
  int outliers = 0;
};

/// Least squares for shift and biases of each tag with the priors of the options, outliers left out by
/// rounds. Empty for no samples.
RangeCalibration calibratedRanges(std::span<const CalibrationSample> samples,
                                  const CalibrationOptions& options);

/// How a vehicle's body frame lies in its motion: where it turns about, and where it heads when driving
/// straight.
struct MotionCalibration {
  double centre_x = 0.0;        ///< m, the body frame lies this far ahead of where it turns about
  double course_offset = 0.0;   ///< rad, the straight course lies this far left of the body's x
  double residual_sigma = 0.0;  ///< m/s, sideways velocity that neither explains
  int samples = 0;              ///< pairs of poses used
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
