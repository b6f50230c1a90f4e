#pragma once
/// Shared by the files of `shearer`. Private to estimation.

#include "pos/estimation/shearer_configs.hpp"
#include "pos/lidar/legs.hpp"

namespace pos::estimation {

/// How legs are found in a sweep.
lidar::LegConfig legFinderOf(const LegsConfig& legs);

}  // namespace pos::estimation
