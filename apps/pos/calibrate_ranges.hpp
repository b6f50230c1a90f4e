#pragma once
/// What every radio link reads too long, from the ranges of a log and known poses.

#include <optional>
#include <string>

#include "inputs.hpp"
#include "pos/io/range_bias_yaml.hpp"
#include "pos/uwb/range_calibration.hpp"

namespace pos::app {

struct RangeCalibrationRequest {
  std::string estimator;  ///< whose tags are meant; empty: the first of type dual_uwb
  double first = 0.0;     ///< s from the first known pose (still: the first range); 0 = all of the log
  std::optional<Pose2>
      still;  ///< the pose that the vehicle keeps; otherwise the truth's poses are the known ones
  double shift_sigma =
      uwb::CalibrationOptions{}.shift_sigma;  ///< m, how far a tag's electrical place may lie from its mount
};

struct RangeCalibrationOutcome {
  io::RangeBiasTable table;
  double residual_sigma = 0.0;  ///< m
  int samples = 0;
  int outliers = 0;
};

/// Throws UsageError when no estimator of type dual_uwb is there, DataError when there are no poses or no
/// ranges.
RangeCalibrationOutcome calibratedRanges(const Inputs& inputs, const RangeCalibrationRequest& request);

}  // namespace pos::app
