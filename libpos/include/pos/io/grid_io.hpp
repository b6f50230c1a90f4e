#pragma once
/// Occupancy grids from MRPT and ROS files, and to MRPT.

#include <string>

#include "pos/map/tunnel_map.hpp"

namespace pos::io {

/// By the file's name: `.gridmap` and `.gridmap.gz` (MRPT COccupancyGridMap2D), `.yaml` and `.yml` (ROS
/// map_server with its image). Throws DataError when the file is missing, damaged or holds another class,
/// ConfigError for another ending or a wrong key in the YAML.
map::OccupancyGrid loadGrid(const std::string& path);

/// MRPT keeps occupancy as log-odds in one byte: percent comes back within 2, 0 and 100 as 2 and 98, and a
/// cell at exactly 50 % is `kUnknown`.
map::OccupancyGrid loadMrptGrid(const std::string& path);

/// ROS map_server: `image`, `resolution` (m), `origin` [x, y, yaw] (m, m, rad), `negate`, `occupied_thresh`,
/// `free_thresh`, `mode` trinary (default) or scale. The image's first row is the top of the map.
map::OccupancyGrid loadRosGrid(const std::string& yaml_path);

/// As MRPT's COccupancyGridMap2D, gzip. MRPT grids are not turned: throws ConfigError when T_map_grid has a
/// yaw that is not zero; its translation is added to the grid's limits.
void saveMrptGrid(const map::OccupancyGrid& grid, const std::string& path);

}  // namespace pos::io
