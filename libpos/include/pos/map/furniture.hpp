#pragma once
/// What stands in and along the roadways. Chainages are in m, of the roadway named.

#include <array>
#include <string>
#include <vector>

#include "pos/map/roadway.hpp"

namespace pos::map {

/// Where roadways meet on one level. A roadway may join with an end or anywhere along it; its place in plan
/// is the mean of the places joined.
struct Junction {
  std::string id = {};
  std::string name = {};
  std::vector<RoadwayPlace> places = {};  ///< at least two

  bool operator==(const Junction&) const = default;
};

/// Where one roadway passes above another without meeting it; declared, so that a crossing in plan which is
/// not declared can be reported.
struct Crossing {
  std::string id = {};
  RoadwayPlace upper = {};
  RoadwayPlace lower = {};

  bool operator==(const Crossing&) const = default;
};

/// A bend that ends one straight leg and begins the next.
struct Bend {
  std::string id = {};
  std::string name = {};
  RoadwayStretch stretch = {};

  bool operator==(const Bend&) const = default;
};

/// A niche in the wall where vehicles can wait (passing) or people can step aside (refuge).
struct Chamber {
  enum class Kind { Passing, Refuge };
  std::string id = {};
  std::string name = {};
  RoadwayPlace place = {};  ///< its middle
  Side side = Side::Right;
  Kind kind = Kind::Passing;
  double length = 0.0;           ///< m, room along the roadway
  double depth = 0.0;            ///< m, into the wall
  int capacity = 1;              ///< vehicles
  double detection_sigma = 0.3;  ///< m, along the roadway: how well passing it is noticed

  bool operator==(const Chamber&) const = default;
};

/// Where a roadway reaches the surface, and where satellites are about to be lost or found.
struct Portal {
  std::string id = {};
  std::string name = {};
  RoadwayPlace place = {};
  double handover_from = 0.0;  ///< m, chainage
  double handover_to = 0.0;    ///< m, chainage, >= handover_from

  bool operator==(const Portal&) const = default;
};

/// A signal lamp and the traffic that has to obey it.
struct Light {
  std::string id = {};
  RoadwayPlace place = {};
  Side side = Side::Right;
  Direction controls = Direction::Forward;

  bool operator==(const Light&) const = default;
};

/// The line before which a vehicle waits for a light.
struct StopLine {
  std::string id = {};
  RoadwayPlace place = {};
  Direction controls = Direction::Forward;
  std::string light = {};  ///< id; may be empty

  bool operator==(const StopLine&) const = default;
};

struct RestrictedZone {
  enum class Kind { NoEntry, NoMeeting, SpeedLimit };
  std::string id = {};
  std::string name = {};
  RoadwayStretch stretch = {};
  Kind kind = Kind::NoEntry;
  std::optional<double> speed_limit = {};  ///< m/s, for SpeedLimit

  bool operator==(const RestrictedZone&) const = default;
};

/// A transport route. A leg with from > to is driven against the chainage. Legs join at junctions.
struct Route {
  std::string id = {};
  std::string name = {};
  std::vector<RoadwayStretch> legs = {};

  bool operator==(const Route&) const = default;
};

/// A kind of vehicle that drives here: outer size with load, m.
struct SiteVehicle {
  std::string id = {};
  double width = 0.0;
  double height = 0.0;
  double length = 0.0;

  bool operator==(const SiteVehicle&) const = default;
};

/// What the site has to offer; the checks compare the map with it.
struct Requirements {
  int anchors_visible = 0;     ///< from everywhere on the roadways; 0 = not asked for
  double range_limit = 120.0;  ///< m, of the radio
  double tag_height = 1.5;     ///< m, above the floor
  std::vector<SiteVehicle> vehicles = {};

  bool operator==(const Requirements&) const = default;
};

/// A point of a picture that was found on the map.
struct ControlPoint {
  double column = 0.0;  ///< pixels from the left edge
  double row = 0.0;     ///< pixels from the upper edge
  double x = 0.0;       ///< m
  double y = 0.0;       ///< m

  bool operator==(const ControlPoint&) const = default;
};

/// A scanned plan to draw under the map; an affine transform is fitted to the control points.
struct BackgroundImage {
  std::string file = {};                          ///< relative to the map's folder
  std::vector<ControlPoint> control_points = {};  ///< at least three, not on one line

  bool operator==(const BackgroundImage&) const = default;
};

}  // namespace pos::map
