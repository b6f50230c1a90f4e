#pragma once
/// How the configuration of `sins_dr` and of the parts it shares with other inertial systems is spelt in
/// YAML.

#include "pos/estimation/configs.hpp"
#include "pos/io/options.hpp"

namespace pos::io {

OptionTable<estimation::ImuNoise> imuNoiseOptions();
OptionTable<estimation::InertialMounts> inertialMountOptions();
OptionTable<estimation::AlignmentConfig> alignmentOptions();
OptionTable<ins::StandstillConfig> standstillOptions();
OptionTable<ins::OdometerConfig> odometerOptions();
OptionTable<estimation::SlipConfig> slipOptions();
OptionTable<estimation::SinsDrConfig> sinsDrOptions();

}  // namespace pos::io
