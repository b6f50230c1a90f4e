#pragma once
/// How the configuration of every estimator is spelt in YAML.

#include <string>

#include "pos/estimation/configs.hpp"
#include "pos/io/options.hpp"

namespace pos::io {

/// One entry of `estimators:`: a name for tables and file names, a type, and the type's own options.
struct EstimatorEntry {
  std::string name;
  estimation::EstimatorConfig config;

  bool operator==(const EstimatorEntry&) const = default;
};

OptionTable<estimation::StartConfig> startOptions();
OptionTable<estimation::OdometryNoise> odometryNoiseOptions();
OptionTable<estimation::DeadReckoningConfig> deadReckoningOptions();
OptionTable<estimation::RangeOdometryConfig> rangeOdometryOptions();
OptionTable<estimation::MclConfig> mclOptions();
OptionTable<estimation::MrptMclConfig> mrptMclOptions();
OptionTable<estimation::DualUwbConfig> dualUwbOptions();
OptionTable<estimation::TagMount> tagOptions();
/// `unit` is the ending of the value's key: "m" for value_m, sigma_m, walk_m_per_sqrt_s; empty for a factor.
OptionTable<estimation::CalibrationState> calibrationOptions(const std::string& title,
                                                             const std::string& unit, Range value,
                                                             double sigma_max);
OptionTable<estimation::LinkBias> linkBiasOptions();
OptionTable<estimation::TagShift> tagShiftOptions();
OptionTable<EstimatorEntry> estimatorOptions();

}  // namespace pos::io
