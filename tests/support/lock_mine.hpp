#pragma once
/// A small mine for tests of locks: a main road with two lanes from the surface, a junction, two long roads
/// with one lane and passing chambers, and a branch with a junction of its own.

#include <memory>
#include <string>
#include <vector>

#include "pos/interval/lock_map.hpp"
#include "pos/traffic/ways.hpp"

namespace pos::testing {

inline void addRoad(map::TunnelMap& mine, const std::string& id, int lanes, const Eigen::Vector3d& from,
                    const Eigen::Vector3d& to) {
  map::Roadway road;
  road.id = id;
  road.lanes = lanes;
  road.width = lanes == 1 ? 4.5 : 7.0;
  road.centreline = {{from}, {to}};
  mine.roadways.push_back(road);
}

inline void addChambers(map::TunnelMap& mine, const std::string& road, double from, double to, double spacing,
                        int capacity) {
  for (double at = from; at <= to; at += spacing) {
    map::Chamber chamber;
    chamber.id = road + "-" + std::to_string(static_cast<int>(at));
    chamber.place = {road, at};
    chamber.length = 10.0 * capacity;
    chamber.depth = 3.5;
    chamber.capacity = capacity;
    mine.chambers.push_back(chamber);
  }
}

inline std::shared_ptr<const map::TunnelMap> lockMine() {
  auto mine = std::make_shared<map::TunnelMap>();
  mine->name = "lock mine";
  addRoad(*mine, "main", 2, {0.0, 0.0, 0.0}, {800.0, 0.0, 0.0});
  addRoad(*mine, "south", 1, {800.0, 0.0, 0.0}, {2300.0, 0.0, 0.0});
  addRoad(*mine, "north", 1, {800.0, 0.0, 0.0}, {800.0, 1200.0, 0.0});
  addRoad(*mine, "branch", 1, {1500.0, 0.0, 0.0}, {1500.0, -600.0, 0.0});
  mine->junctions = {{"J1", "", {{"main", 800.0}, {"south", 0.0}, {"north", 0.0}}},
                     {"J2", "", {{"south", 700.0}, {"branch", 0.0}}}};
  addChambers(*mine, "south", 100.0, 1450.0, 120.0, 2);
  addChambers(*mine, "north", 90.0, 1150.0, 110.0, 1);
  addChambers(*mine, "branch", 120.0, 550.0, 130.0, 1);
  return mine;
}

/// The same with everything that locks need.
struct LockMine {
  explicit LockMine(std::shared_ptr<const map::TunnelMap> of)
      : network(std::move(of)),
        graph(network),
        intervals(map::divided(graph, network, map::DivisionRules{})),
        locks(network, graph, intervals, interval::LockMapRules{}) {}

  /// Ways between all open ends and portals, in both directions.
  std::vector<interval::Way> ways() const { return traffic::waysBetweenEnds(graph, locks); }

  map::Network network;
  map::RoadGraph graph;
  std::vector<map::LockInterval> intervals;
  interval::LockMap locks;
};

}  // namespace pos::testing
