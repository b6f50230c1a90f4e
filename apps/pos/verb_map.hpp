#pragma once
/// The verbs below `pos map`, a few to a file.

#include "common.hpp"
#include "pos/io/map_yaml.hpp"

namespace pos::app {

/// The map of a file with its grid; throws ConfigError.
map::TunnelMap mapOf(const std::string& file);

void addMapCheck(CLI::App& map, const Verbs& verbs);
void addMapDiff(CLI::App& map, const Verbs& verbs);
void addMapInfo(CLI::App& map, const Verbs& verbs);
void addMapInit(CLI::App& map, const Verbs& verbs);
void addMapIntervals(CLI::App& map, const Verbs& verbs);
void addMapCoverage(CLI::App& map, const Verbs& verbs);
void addMapPlanAnchors(CLI::App& map, const Verbs& verbs);

}  // namespace pos::app
