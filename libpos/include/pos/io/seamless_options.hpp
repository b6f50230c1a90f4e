#pragma once
/// How the configuration of `seamless` is spelt in YAML.

#include "pos/estimation/seamless_configs.hpp"
#include "pos/io/options.hpp"

namespace pos::io {

OptionTable<estimation::SeamlessConfig> seamlessOptions();

}  // namespace pos::io
