#pragma once
/// The roads of scenario B-E5 of spec A section 7 and where a vehicle drives on them.

#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "pos/core/angle.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::testing {

inline constexpr double kMainWidth = 7.0;  // m, two lanes
inline constexpr double kLane = 0.25 * kMainWidth;
/// m driven to the middle of the turn into the branch: the corner less the tangent, and half of the arc.
inline const double kForkDriven =
    250.0 - kLane / std::tan(kPi / 3.0) - 15.0 * std::tan(kPi / 6.0) + 15.0 * kPi / 6.0;

inline void addChamber(map::TunnelMap& map, const std::string& id, const std::string& road, double at,
                       map::Side side) {
  map::Chamber chamber;
  chamber.id = id;
  chamber.place = {road, at};
  chamber.side = side;
  chamber.length = 15.0;
  chamber.depth = 3.0;
  map.chambers.push_back(chamber);
}

/// Main road: 600 m straight, a left bend of 15 m radius, 300 m; branch of 60 degrees to the left at 250 m.
inline std::shared_ptr<const map::TunnelMap> intervalDemo() {
  auto demo = std::make_shared<map::TunnelMap>();
  demo->name = "interval demo";
  map::Roadway main{.id = "main", .width = kMainWidth, .lanes = 2};
  main.centreline = {
      {{0.0, 0.0, 0.0}}, {{600.0, 0.0, 0.0}, 0.5 * kPi}, {{615.0, 15.0, 0.0}}, {{615.0, 315.0, 0.0}}};
  map::Roadway branch{.id = "branch", .width = 4.5, .lanes = 1};
  branch.centreline = {{{250.0, 0.0, 0.0}}, {{400.0, 300.0 * std::sin(kPi / 3.0), 0.0}}};
  demo->roadways = {main, branch};
  demo->junctions = {{"J", "", {{"main", 250.0}, {"branch", 0.0}}}};
  demo->bends = {{"B", "", {"main", 600.0, 600.0 + 7.5 * kPi}}};
  for (const int at : {50, 150, 350, 450, 550, 650, 750, 850})
    addChamber(*demo, "R" + std::to_string(at), "main", at, map::Side::Right);
  for (const int at : {100, 200, 300, 400, 500, 700, 800, 900})
    addChamber(*demo, "L" + std::to_string(at), "main", at, map::Side::Left);
  for (const int at : {60, 140, 220})
    addChamber(*demo, "S" + std::to_string(at), "branch", at, map::Side::Right);
  return demo;
}

/// Where the vehicle truly drives, as a line without width: in its lane, and round the corner on an arc.
inline map::Roadway drivenLine(bool into_branch) {
  map::Roadway line{.id = "driven"};
  if (!into_branch) {
    line.centreline = {{{0.0, -kLane, 0.0}},
                       {{600.0, -kLane, 0.0}, 0.5 * kPi},
                       {{615.0 + kLane, 15.0, 0.0}},
                       {{615.0 + kLane, 310.0, 0.0}}};
    return line;
  }
  const double fork = kPi / 3.0;
  const double corner = 250.0 - kLane / std::tan(fork);
  const double cut = 15.0 * std::tan(0.5 * fork);
  const Eigen::Vector3d out(std::cos(fork), std::sin(fork), 0.0);
  const Eigen::Vector3d at(corner, -kLane, 0.0);
  line.centreline = {
      {{0.0, -kLane, 0.0}}, {{corner - cut, -kLane, 0.0}, fork}, {at + cut * out}, {at + 295.0 * out}};
  return line;
}

}  // namespace pos::testing
