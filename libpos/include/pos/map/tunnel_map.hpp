#pragma once
/// The map a vehicle is placed on: plain data, as the map file holds it. Questions are asked of a Network
/// (network.hpp), a RoadGraph (routes.hpp) and the functions beside them.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pos/core/measurement.hpp"
#include "pos/core/pose2.hpp"
#include "pos/map/furniture.hpp"
#include "pos/map/roadway.hpp"

namespace pos::map {

/// What an anchor is fixed to. Left and right are seen along growing chainage of its roadway.
enum class Wall { Left, Right, Roof, Floor, Post };

/// A radio anchor at a surveyed place.
struct Anchor {
  AnchorId id = 0;
  std::string name = {};
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< m
  double survey_sigma = 0.0;                        ///< m, per axis
  double range_bias = 0.0;                          ///< m, subtracted from every range to this anchor
  std::optional<Wall> wall = {};
  std::string survey_date = {};  ///< YYYY-MM-DD or empty
  double antenna_delay = 0.0;    ///< s, transmit and receive together, as programmed into the radio

  bool operator==(const Anchor&) const = default;
};

/// Where the map frame sits on the Earth: the WGS84 tie, one point known in both, usually at the portal.
struct GeodeticOrigin {
  double latitude = 0.0;       ///< rad
  double longitude = 0.0;      ///< rad
  double altitude = 0.0;       ///< m above the ellipsoid
  double grid_rotation = 0.0;  ///< rad, from true east counter-clockwise to the map's x axis
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< m, the map point with these coordinates

  bool operator==(const GeodeticOrigin&) const = default;
};

/// Where the map frame sits in the mine's own grid, whose coordinates are too large to draw and to filter in.
struct MineGrid {
  std::string name = {};   ///< of grid and datum, "Gauss-Krueger zone 38"
  double easting = 0.0;    ///< m, of the map's origin
  double northing = 0.0;   ///< m
  double elevation = 0.0;  ///< m
  double rotation = 0.0;   ///< rad, from the grid's east counter-clockwise to the map's x axis

  bool operator==(const MineGrid&) const = default;
};
/// Easting, northing, elevation (m) of a map point, and back.
Eigen::Vector3d toGrid(const MineGrid& grid, const Eigen::Vector3d& p_map);
Eigen::Vector3d fromGrid(const MineGrid& grid, const Eigen::Vector3d& p_grid);

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
  bool operator==(const OccupancyGrid&) const = default;
};

struct TunnelMap {
  std::string name = {};
  std::optional<GeodeticOrigin> origin = {};
  std::vector<Anchor> anchors = {};  ///< ids are unique
  std::optional<OccupancyGrid> grid = {};
  std::optional<MineGrid> mine_grid = {};
  Side driving_side = Side::Right;     ///< on roadways with two lanes
  std::vector<Roadway> roadways = {};  ///< ids are unique within each kind
  std::vector<Junction> junctions = {};
  std::vector<Crossing> crossings = {};
  std::vector<Bend> bends = {};
  std::vector<Chamber> chambers = {};
  std::vector<Portal> portals = {};
  std::vector<Light> lights = {};
  std::vector<StopLine> stop_lines = {};
  std::vector<RestrictedZone> zones = {};
  std::vector<Route> routes = {};
  std::optional<BackgroundImage> background = {};
  std::optional<Requirements> requirements = {};

  bool operator==(const TunnelMap&) const = default;

  /// The anchor with this id, or null. O(n), n is tens; estimators keep their own table.
  const Anchor* findAnchor(AnchorId id) const;
  /// The object with this id, or null. O(n).
  const Roadway* findRoadway(const std::string& id) const;
  const Chamber* findChamber(const std::string& id) const;
  const Junction* findJunction(const std::string& id) const;
  const Route* findRoute(const std::string& id) const;
};

/// The map itself when it can be used; throws ConfigError naming the first thing wrong: an id given twice or
/// missing, an object on a roadway that does not exist, a number that is none, a negative size, a centreline
/// with fewer than two points, a grid whose cells do not match its size. What is merely doubtful is for
/// `findings` (checks.hpp).
TunnelMap validated(TunnelMap map);

}  // namespace pos::map
