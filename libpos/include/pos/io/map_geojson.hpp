#pragma once
/// Maps as GeoJSON (RFC 7946) in local metres instead of degrees: QGIS and browser editors read and write it,
/// and nothing of a map is lost. docs/formats/maps.md tells how every object looks.

#include <filesystem>
#include <string>
#include <vector>

#include "pos/io/map_yaml.hpp"

namespace pos::io {

/// Pretty enough to be compared line by line: one feature a line. Shapes of roadways and anchors are the
/// geometry alone; the geometry of all other objects is computed from their chainage, to the millimetre.
std::string mapGeoJson(const MapFile& file);

struct GeoJsonImport {
  MapFile file = {};
  /// What a surveyor should know: an object whose point was moved while its chainage was not (the chainage
  /// counts), chainages that were computed from points, a named coordinate system.
  std::vector<std::string> remarks = {};
};

/// The map of such a file. Features may come in any order; objects of one kind keep theirs. A point object
/// without chainage_m gets the chainage of its point. Members that are null count as not there. Throws
/// ConfigError naming feature, property, line and column.
GeoJsonImport parsedGeoJson(const std::string& text, const std::filesystem::path& file);
GeoJsonImport loadGeoJson(const std::filesystem::path& file);

}  // namespace pos::io
