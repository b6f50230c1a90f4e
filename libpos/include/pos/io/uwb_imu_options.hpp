#pragma once
/// How the configuration of `uwb_imu`, and of the parts it shares with other tightly coupled systems, is
/// spelt in YAML.

#include "pos/estimation/configs.hpp"
#include "pos/io/options.hpp"

namespace pos::io {

OptionTable<estimation::InertialStart> inertialStartOptions();
OptionTable<filters::RobustConfig> robustOptions();
OptionTable<estimation::AnchorBiasConfig> anchorBiasOptions();
OptionTable<estimation::RecoveryConfig> recoveryOptions();
OptionTable<estimation::MotionAids> motionAidOptions();
OptionTable<estimation::UwbImuConfig> uwbImuOptions();

}  // namespace pos::io
