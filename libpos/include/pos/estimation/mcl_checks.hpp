#pragma once
/// What must hold before a particle filter can be built.

#include "pos/estimation/configs.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::estimation {

/// The config itself; throws ConfigError when the map lacks what it uses or a number is out of range.
MclConfig checked(const MclConfig& config, const map::TunnelMap* map);

}  // namespace pos::estimation
