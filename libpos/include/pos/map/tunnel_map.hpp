#pragma once
/// The map a vehicle is placed on. First part: radio anchors and an occupancy grid. Roadways, chambers and
/// the rest come with their own queries beside these.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pos/core/measurement.hpp"
#include "pos/core/pose2.hpp"

namespace pos::map {

/// A radio anchor at a surveyed place.
struct Anchor {
  AnchorId id = 0;
  std::string name = {};
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< m
  double survey_sigma = 0.0;                        ///< m, per axis
  double range_bias = 0.0;                          ///< m, subtracted from every range to this anchor

  bool operator==(const Anchor&) const = default;
};

/// Where the map frame sits on the Earth: the WGS84 tie, usually at the portal.
struct GeodeticOrigin {
  double latitude = 0.0;       ///< rad
  double longitude = 0.0;      ///< rad
  double altitude = 0.0;       ///< m above the ellipsoid
  double grid_rotation = 0.0;  ///< rad, from true east counter-clockwise to the map's x axis

  bool operator==(const GeodeticOrigin&) const = default;
};

/// How likely each cell is to be free, over a regular grid. Cell (column, row) covers
/// [x_min + column*resolution, +resolution) x [y_min + row*resolution, +resolution) in the grid's own axes.
struct OccupancyGrid {
  Pose2 T_map_grid = {};
  double x_min = 0.0;       ///< m
  double y_min = 0.0;       ///< m
  double resolution = 0.1;  ///< m
  int columns = 0;
  int rows = 0;
  /// Occupancy in percent, row-major from y_min up: 0 free .. 100 rock, kUnknown where never seen.
  std::vector<std::uint8_t> occupancy = {};
  static constexpr std::uint8_t kUnknown = 255;

  std::uint8_t at(int column, int row) const {
    return occupancy[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(column)];
  }
};

struct TunnelMap {
  std::string name = {};
  std::optional<GeodeticOrigin> origin = {};
  std::vector<Anchor> anchors = {};  ///< ids are unique
  std::optional<OccupancyGrid> grid = {};

  /// The anchor with this id, or null. O(n), n is tens; estimators keep their own table.
  const Anchor* findAnchor(AnchorId id) const;
};

/// The map itself when it can be used; throws ConfigError naming the first thing wrong (two anchors of one
/// id, a coordinate that is no number, a negative sigma, a grid whose cells do not match its size).
TunnelMap validated(TunnelMap map);

}  // namespace pos::map
