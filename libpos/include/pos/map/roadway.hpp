#pragma once
/// A roadway of the mine and places along it. All ids of map objects are words given by the surveyor; they
/// stay the same from one version of a map to the next.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace pos::map {

/// Position of a roadway in TunnelMap::roadways; valid for the one map it came from.
using RoadwayIndex = std::size_t;

/// Tunnel coordinates. Chainage is the length along the centreline in space (slope distance, as a wheel
/// measures it), growing from the first point of the centreline.
struct TunnelPoint {
  RoadwayIndex roadway = 0;
  double chainage = 0.0;  ///< m, from the roadway's chainage_start on
  double offset = 0.0;    ///< m, horizontally from the centreline, positive to the left of growing chainage
  double height = 0.0;    ///< m, vertically above the floor (the centreline lies on the floor)

  bool operator==(const TunnelPoint&) const = default;
};

/// A place on a roadway as map files name it.
struct RoadwayPlace {
  std::string roadway = {};  ///< id
  double chainage = 0.0;     ///< m

  bool operator==(const RoadwayPlace&) const = default;
};

/// A stretch of a roadway, `from` <= `to` unless the owner says that the order is a direction.
struct RoadwayStretch {
  std::string roadway = {};  ///< id
  double from = 0.0;         ///< m, chainage
  double to = 0.0;           ///< m, chainage

  bool operator==(const RoadwayStretch&) const = default;
};

/// A surveyed point of a centreline and the way to the next one.
struct CentrelinePoint {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< m, on the floor in the middle of the roadway
  /// rad, angle swept in plan on the way to the next point, counter-clockwise positive; 0 is a straight line.
  /// (DXF's bulge is tan(arc / 4).) The height changes evenly along the arc. Without meaning at the last
  /// point.
  double arc = 0.0;
  std::optional<double> station = {};  ///< m, chainage as surveyed; compared with the length, never used

  bool operator==(const CentrelinePoint&) const = default;
};

/// Cross-section of a roadway. Arch: walls of height `height - width / 2` under a semicircle.
enum class Section { Rectangle, Arch };

/// Along growing or falling chainage.
enum class Direction { Forward, Backward };

/// Which way vehicles may drive.
enum class Traffic { BothWays, ForwardOnly, BackwardOnly };

/// Seen along growing chainage.
enum class Side { Left, Right };

struct Roadway {
  std::string id = {};
  std::string name = {};
  std::string level = {};                        ///< name of the working level, for drawings
  std::vector<CentrelinePoint> centreline = {};  ///< at least two points
  double chainage_start = 0.0;                   ///< m, chainage of the first point
  double width = 4.0;                            ///< m, between the walls
  double height = 3.0;                           ///< m, from floor to roof in the middle
  Section section = Section::Rectangle;
  int lanes = 1;                           ///< 1 or 2
  Traffic traffic = Traffic::BothWays;     ///< of two lanes, one goes each way: BothWays
  std::optional<double> speed_limit = {};  ///< m/s
  bool locked = false;                     ///< vehicles need a lock for its intervals

  bool operator==(const Roadway&) const = default;
};

}  // namespace pos::map
