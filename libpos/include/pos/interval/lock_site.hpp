#pragma once
/// What the lock engine knows of the mine: sections that are locked as one, places where vehicles can wait,
/// and the ways that lead over them. Plain data without geometry; lock_map.hpp makes it from a map.

#include <cstddef>
#include <string>
#include <vector>

namespace pos::interval {

/// The smallest piece of road that is locked as one. Everybody on it at the same time makes the same
/// movement.
struct LockSection {
  std::string id = {};
  bool single_lane = true;                  ///< two vehicles that meet here could not pass
  std::vector<std::size_t> intervals = {};  ///< lock intervals (map::divided) that share a span with it
};

/// Where a vehicle can wait.
struct StopPlace {
  enum class Kind {
    Niche,   ///< a passing chamber beside the road: who is parked there is off the road
    OnRoad,  ///< a stretch of the vehicle's own lane: who waits there is in the way of those behind
    Depot    ///< a yard, loading place or the surface, with room for all
  };
  std::string id = {};
  Kind kind = Kind::Niche;
  double length = 0.0;  ///< m, room for vehicles and the gaps between them (not for a depot)
  int capacity = 1;     ///< vehicles (not for a depot)
};

struct LockSite {
  std::vector<LockSection> sections = {};
  std::vector<StopPlace> stops = {};
};

/// A section as one way crosses it. Two vehicles may share a section when their movements are equal: +1 and
/// -1 are along and against the roadway, other numbers are turns in a junction.
struct WaySection {
  std::size_t section = 0;
  int movement = 1;
  double from = 0.0;  ///< m along the way
  double to = 0.0;    ///< m along the way
};

/// A stop on a way.
struct WayStop {
  std::size_t stop = 0;
  double at = 0.0;    ///< m along the way, where the vehicle's reference point waits
  double from = 0.0;  ///< m, where the place begins; a section that it touches belongs to it
  double to = 0.0;    ///< m, where it ends
};

/// The way of one vehicle from a depot to a depot: sections without gaps in driving order, stops in driving
/// order; the first stop is where it begins, the last where it ends.
struct Way {
  std::vector<WaySection> sections = {};
  std::vector<WayStop> stops = {};
};

/// The way itself when the engine can use it; throws DataError for gaps, a section or stop the site does not
/// have, stops out of order, or ends that are no depots.
Way validated(Way way, const LockSite& site);

}  // namespace pos::interval
