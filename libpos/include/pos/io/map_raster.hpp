#pragma once
/// Roadways as an occupancy grid, for particle filters and for other programs.

#include <string>

#include "pos/map/tunnel_map.hpp"

namespace pos::io {

struct RasterRules {
  double resolution = 0.1;  ///< m a cell
  double margin = 2.0;      ///< m of rock around the outermost walls
  std::string level =
      {};  ///< only roadways of this level; empty = all, those that cross in plan run together
};
RasterRules validated(RasterRules rules);

/// Free (0) inside roadways and chambers in plan, rock (100) everywhere else; a cell is free when its middle
/// is. Limits are whole cells. Throws ConfigError for a map without roadways (on the level) and for more than
/// 2e8 cells.
map::OccupancyGrid rasterised(const map::TunnelMap& map, const RasterRules& rules);

/// ROS map_server: `stem`.yaml and `stem`.pgm beside it, trinary (free 254, rock 0, unknown 205). Throws
/// DataError when they cannot be written.
void saveRosGrid(const map::OccupancyGrid& grid, const std::string& yaml_path);

}  // namespace pos::io
