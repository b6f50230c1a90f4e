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
  double shift_sigma = 0.02;  ///< m, how far a tag's electrical place may lie from its mount; 0 = not at all
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

/// What the ranges scatter by about the biases: one part new in every reading, one that lasts, as reflections
/// and an antenna seen from a slowly changing side make it.
struct RangeErrors {
  double reading_sigma = 0.0;  ///< m
  double lasting_sigma = 0.0;  ///< m
  /// s, over which the lasting part forgets itself; 0 = not within the record. The biases were taken off over
  /// the same record, so that a time which is not short against it comes out too short.
  double lasting_time = 0.0;
};

struct RangeCalibration {
  std::vector<LinkCalibration> links;  ///< by tag, then anchor
  std::vector<TagCalibration> tags;    ///< by tag; empty when shift_sigma is 0
  double residual_sigma = 0.0;         ///< m, of all ranges kept
  RangeErrors errors;
  int samples = 0;
  int outliers = 0;
};

/// Least squares for shift and biases of each tag with the priors of the options, outliers left out by
/// rounds. Empty for no samples.
RangeCalibration calibratedRanges(std::span<const CalibrationSample> samples,
                                  const CalibrationOptions& options);

}  // namespace pos::uwb
