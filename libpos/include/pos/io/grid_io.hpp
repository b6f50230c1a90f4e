#pragma once
/// Occupancy grids from files.

#include <filesystem>

#include "pos/map/tunnel_map.hpp"

namespace pos::io {

/// The grid in a file, whatever its format. Defined with the grid formats; map_yaml takes it as a GridLoader.
map::OccupancyGrid loadGrid(const std::filesystem::path& file);

}  // namespace pos::io
