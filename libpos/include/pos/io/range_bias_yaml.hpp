#pragma once
/// The table of range biases that `pos calibrate ranges` writes and `range_bias_table:` names.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pos/estimation/configs.hpp"
#include "pos/io/options.hpp"

namespace pos::io {

/// One link of the table: its bias, and how good the calibration was.
struct CalibratedLink {
  estimation::LinkBias link;
  double bias_sigma = 0.0;      ///< m, how sure the bias is
  double residual_sigma = 0.0;  ///< m, of the ranges about it
  int samples = 0;
  int outliers = 0;

  bool operator==(const CalibratedLink&) const = default;
};

/// How the vehicle's body frame lies in its motion, in the place of motion_centre_x_m and course_offset_deg;
/// and for the reader how fast its speed and yaw rate wandered.
struct CalibratedMotion {
  double centre_x = 0.0;                  ///< m
  double course_offset = 0.0;             ///< rad
  double acceleration_density = 0.0;      ///< m/s^2 * sqrt(s)
  double yaw_acceleration_density = 0.0;  ///< rad/s^2 * sqrt(s)

  bool operator==(const CalibratedMotion&) const = default;
};

/// What the ranges scatter by about the biases, for the reader: range_sigma_m, and sigma_m and time_s of
/// link_bias.
struct CalibratedErrors {
  double range_sigma = 0.0;    ///< m, new in every reading
  double lasting_sigma = 0.0;  ///< m
  double lasting_time = 0.0;   ///< s

  bool operator==(const CalibratedErrors&) const = default;
};

struct RangeBiasTable {
  int schema = 1;
  std::string source;  ///< what it was made from, for the reader
  std::vector<CalibratedLink> links;
  std::vector<estimation::TagShift> tag_shifts;
  std::optional<CalibratedErrors> errors;
  std::optional<CalibratedMotion> motion;  ///< absent when the poses hardly moved

  bool operator==(const RangeBiasTable&) const = default;
};

OptionTable<RangeBiasTable> rangeBiasOptions();

/// Reads a table. Throws ConfigError.
RangeBiasTable loadRangeBiasTable(const std::filesystem::path& file);

/// YAML text that reads back to an equal table.
std::string rangeBiasYaml(const RangeBiasTable& table);

/// The configuration with the table's biases, shifts and motion in place of its own, and the table's name
/// gone, so that a run can be repeated without the file. Throws ConfigError when both tell of the motion.
estimation::DualUwbConfig withTable(estimation::DualUwbConfig config, const RangeBiasTable& table);

}  // namespace pos::io
