#pragma once
/// Maps in their canonical form, YAML with units in the keys. Keys: docs/reference/map_format.md.

#include <filesystem>
#include <functional>
#include <string>

#include "pos/io/options.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::io {

/// Where the cells of the grid are: in a file of their own.
struct GridReference {
  std::filesystem::path file;
  Pose2 T_map_grid;

  bool operator==(const GridReference&) const = default;
};

/// Schema 1 knew name, origin, anchors and grid; schema 2 adds the roadways and everything along them. Both
/// are read, 2 is written.
inline constexpr int kMapSchema = 2;

/// A map file as written: everything but the cells of the grid.
struct MapFile {
  int schema = kMapSchema;
  map::TunnelMap map = {};
  std::optional<GridReference> grid = {};

  bool operator==(const MapFile&) const = default;
};

OptionTable<MapFile> mapOptions();

/// The file of this text, checked like a map but without its grid; `file` is the name used in messages.
/// Throws ConfigError with file, line and column.
MapFile parsedMap(const std::string& text, const std::filesystem::path& file);

/// The same from a file.
MapFile readMapFile(const std::filesystem::path& file);

/// Canonical text: keys in the order of the reference, defaults left out, one line for each object without
/// lists, numbers as short as they read back the same. Reading it and writing it again gives the same bytes.
std::string mapText(const MapFile& file);

/// The same for a map that was not read from a map file. Throws ConfigError (key as in the file, no place)
/// for what could not be read back: values that a map can hold and the format refuses, a roadway 0.3 m wide.
std::string checkedMapText(const MapFile& file);

/// The file for another folder: paths in it that start at the folder `from` (of the grid, of the background)
/// start at `to`.
MapFile moved(MapFile file, const std::filesystem::path& from, const std::filesystem::path& to);

/// Reads the cells of a grid (grid_io.hpp has one for each format).
using GridLoader = std::function<map::OccupancyGrid(const std::filesystem::path&)>;

/// Reads a map and its grid. The grid's path starts at the map's folder; `mrpt-common:` stands for
/// `mrpt_share`. The pose in the map file is put in front of the grid's own. Throws ConfigError.
map::TunnelMap loadMap(const std::filesystem::path& file, const std::filesystem::path& mrpt_share,
                       const GridLoader& grid_loader);

/// Canonical text of the map. A map with a grid needs the path of the grid's own file, relative to the map's
/// folder; throws ConfigError when it is missing, and when a grid file is named for a map without grid.
std::string mapYaml(const map::TunnelMap& map, const std::filesystem::path& grid_file = {});

/// Writes that text. The cells of the grid are not written. Throws ConfigError.
void saveMap(const map::TunnelMap& map, const std::filesystem::path& file,
             const std::filesystem::path& grid_file = {});

}  // namespace pos::io
