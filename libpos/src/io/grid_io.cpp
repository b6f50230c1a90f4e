#include "pos/io/grid_io.hpp"

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <algorithm>
#include <cmath>

#include "mrpt_archive.hpp"
#include "pos/core/error.hpp"

namespace pos::io {

using map::OccupancyGrid;

OccupancyGrid loadGrid(const std::string& path) {
  if (path.ends_with(".yaml") || path.ends_with(".yml")) return loadRosGrid(path);
  if (path.ends_with(".gridmap") || path.ends_with(".gridmap.gz")) return loadMrptGrid(path);
  throw ConfigError(Complaint{.what = "the kind of this grid map is not known by its ending",
                              .place = {.file = path},
                              .expected = ".gridmap, .gridmap.gz (MRPT), .yaml, .yml (ROS map_server)"});
}

OccupancyGrid loadMrptGrid(const std::string& path) {
  const auto object = readMapObject(path, "mrpt::maps::COccupancyGridMap2D");
  const auto& stored = dynamic_cast<const mrpt::maps::COccupancyGridMap2D&>(*object);
  OccupancyGrid grid;
  grid.x_min = static_cast<double>(stored.getXMin());
  grid.y_min = static_cast<double>(stored.getYMin());
  grid.resolution = static_cast<double>(stored.getResolution());
  grid.columns = static_cast<int>(stored.getSizeX());
  grid.rows = static_cast<int>(stored.getSizeY());
  const auto& cells = stored.getRawMap();
  const auto expected = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  if (cells.size() < expected || expected == 0) {
    throw DataError(Complaint{.what = "the grid map has fewer cells than its size says",
                              .place = {.file = path},
                              .got = std::to_string(cells.size()),
                              .expected = std::to_string(expected)});
  }
  grid.occupancy.reserve(expected);
  for (std::size_t i = 0; i < expected; ++i) {
    const auto free = static_cast<double>(mrpt::maps::COccupancyGridMap2D::l2p(cells[i]));  // MRPT: 1 is free
    const auto percent = static_cast<std::uint8_t>(std::lround(100.0 * (1.0 - free)));
    grid.occupancy.push_back(cells[i] == 0 ? OccupancyGrid::kUnknown : percent);
  }
  return grid;
}

void saveMrptGrid(const OccupancyGrid& grid, const std::string& path) {
  if (grid.T_map_grid.yaw != 0.0) {
    throw ConfigError(Complaint{.what = "an MRPT grid cannot be turned against the map",
                                .key = "T_map_grid.yaw",
                                .got = std::to_string(grid.T_map_grid.yaw) + " rad",
                                .expected = "0"});
  }
  const double x_min = grid.x_min + grid.T_map_grid.x;
  const double y_min = grid.y_min + grid.T_map_grid.y;
  mrpt::maps::COccupancyGridMap2D stored(
      static_cast<float>(x_min), static_cast<float>(x_min + grid.columns * grid.resolution),
      static_cast<float>(y_min), static_cast<float>(y_min + grid.rows * grid.resolution),
      static_cast<float>(grid.resolution));
  if (static_cast<int>(stored.getSizeX()) != grid.columns ||
      static_cast<int>(stored.getSizeY()) != grid.rows) {
    throw ConfigError(Complaint{.what = "the grid's limits are not whole cells in MRPT's single precision",
                                .got = std::to_string(grid.resolution) + " m a cell",
                                .expected = "limits that are multiples of the resolution"});
  }
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::uint8_t percent = grid.at(column, row);
      const double free = percent == OccupancyGrid::kUnknown ? 0.5 : 1.0 - 0.01 * percent;
      stored.setCell(column, row, static_cast<float>(free));
    }
  }
  writeMapObject(stored, path);
}

}  // namespace pos::io
