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
OptionTable<EstimatorEntry> estimatorOptions();

}  // namespace pos::io
