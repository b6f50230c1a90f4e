#pragma once
/// How the configuration of `shearer` is spelt in YAML.

#include "pos/estimation/configs.hpp"
#include "pos/io/options.hpp"

namespace pos::io {

OptionTable<estimation::ShearerConfig> shearerOptions();

}  // namespace pos::io
