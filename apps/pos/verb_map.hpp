#pragma once
/// The verbs below `pos map`, a few to a file.

#include "common.hpp"
#include "pos/io/map_yaml.hpp"

namespace pos::app {

/// The map of a file with its grid; throws ConfigError.
map::TunnelMap mapOf(const std::string& file);

/// The folder a file is in, where relative paths in it start.
inline std::filesystem::path folderOf(const std::filesystem::path& file) {
  return file.parent_path();
}

/// Throws UsageError when one of these options was given, for what is done ("a GeoJSON export") has no use
/// for it.
void refuseGiven(const std::vector<const CLI::Option*>& options, const std::string& what);

void addMapCheck(CLI::App& map, const Verbs& verbs);
void addMapDiff(CLI::App& map, const Verbs& verbs);
void addMapInfo(CLI::App& map, const Verbs& verbs);
void addMapExport(CLI::App& map, const Verbs& verbs);
void addMapImport(CLI::App& map, const Verbs& verbs);
void addMapInit(CLI::App& map, const Verbs& verbs);
void addMapRender(CLI::App& map, const Verbs& verbs);
void addMapIntervals(CLI::App& map, const Verbs& verbs);
void addMapCoverage(CLI::App& map, const Verbs& verbs);
void addMapPlanAnchors(CLI::App& map, const Verbs& verbs);

}  // namespace pos::app
