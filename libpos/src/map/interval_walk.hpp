#pragma once
/// A way through the mine with everything on it that matters to lock intervals.

#include "pos/map/lock_intervals.hpp"

namespace pos::map {

/// Two things on a way nearer than this are at one place, m.
inline constexpr double kSamePlace = 1e-6;

/// A node or bend passed.
struct WayEvent {
  double distance = 0.0;  ///< m from the start
  std::string id = {};
  bool ends_leg = false;  ///< a bend, or a node where the way turns off
};
/// A chamber passed, or an end of the way.
struct WayMark {
  double distance = 0.0;
  std::string id = {};
};

/// Whether the chambers of this side count for vehicles that drive this way.
bool isForLane(const Roadway& roadway, Side chamber_side, Direction driven, Side driving_side);
Lane laneOf(const Roadway& roadway, Direction driven);
/// "i", "j", ... "z", "ii", "ij", ...
std::string legLetter(int leg);

class Way {
 public:
  Way(const RoadGraph& graph, const Network& network, RouteLine route, double straight_within);

  const RouteLine& route() const { return route_; }
  const std::vector<WayEvent>& events() const { return events_; }
  const std::vector<WayMark>& chambers() const { return chambers_; }
  /// Start, chambers and end in driving order, one a place.
  std::vector<WayMark> boundaries() const;
  /// The interval between two marks, still without letter and index.
  LockInterval between(const WayMark& begin, const WayMark& end) const;

 private:
  void addNodes(const RoadGraph& graph);
  void addTurns(const RoadGraph& graph, double straight_within);
  void addBends();
  void addChambers();
  std::string nameOfEnd(const RoadGraph& graph, double distance) const;
  std::string idOf(const LockInterval& interval, const WayMark& begin, const WayMark& end) const;

  const Network& network_;
  RouteLine route_;
  std::vector<WayEvent> events_;
  std::vector<WayMark> chambers_;
  std::string start_id_;
  std::string end_id_;
};

}  // namespace pos::map
