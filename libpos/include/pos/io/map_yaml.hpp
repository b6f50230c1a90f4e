#pragma once
/// Maps in their canonical form, YAML with units in the keys.

#include <filesystem>
#include <functional>
#include <string>

#include "pos/io/options.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::io {

/// A map file as written: everything but the cells of the grid, which are in a file of their own.
struct GridReference {
  std::filesystem::path file;
  Pose2 T_map_grid;

  bool operator==(const GridReference&) const = default;
};
struct MapFile {
  int schema = 1;
  std::string name;
  std::optional<map::GeodeticOrigin> origin;
  std::vector<map::Anchor> anchors;
  std::optional<GridReference> grid;

  bool operator==(const MapFile&) const = default;
};

OptionTable<MapFile> mapOptions();

/// Reads the cells of a grid (grid_io.hpp has one for each format).
using GridLoader = std::function<map::OccupancyGrid(const std::filesystem::path&)>;

/// Reads a map and its grid. The grid's path starts at the map's folder; `mrpt-common:` stands for
/// `mrpt_share`. The pose in the map file is put in front of the grid's own. Throws ConfigError.
map::TunnelMap loadMap(const std::filesystem::path& file, const std::filesystem::path& mrpt_share,
                       const GridLoader& grid_loader);

/// YAML text of the map. A map with a grid needs the path of the grid's own file, relative to the map's
/// folder; throws ConfigError when it is missing, and when a grid file is named for a map without grid.
std::string mapYaml(const map::TunnelMap& map, const std::filesystem::path& grid_file = {});

/// Writes that text. The cells of the grid are not written. Throws ConfigError.
void saveMap(const map::TunnelMap& map, const std::filesystem::path& file,
             const std::filesystem::path& grid_file = {});

}  // namespace pos::io
