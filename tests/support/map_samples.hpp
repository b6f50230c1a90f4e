#pragma once
/// Made-up mines for the tests of map files and drawings: a small one with everything in it, a long one, and
/// random ones.

#include <cmath>
#include <string>

#include "pos/core/angle.hpp"
#include "pos/core/random.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::map::samples {

inline Roadway roadway(const std::string& id, std::vector<CentrelinePoint> points, double width = 5.0) {
  Roadway made;
  made.id = id;
  made.centreline = std::move(points);
  made.width = width;
  return made;
}

/// A main roadway with a bend and a branch; every kind of object once, names that need care in every format.
inline TunnelMap smallMine() {
  TunnelMap mine;
  mine.name = "small mine";
  mine.origin = GeodeticOrigin{radians(37.8731), radians(112.5604), 812.25, radians(-1.25), {1.0, 2.0, 0.5}};
  mine.mine_grid = MineGrid{"local grid 7", 388000.125, 4512000.5, 800.0, radians(0.75)};
  Roadway main = roadway("R1", {{.p_map = {0.0, 0.0, 0.0}, .station = 0.0},
                                {.p_map = {120.0, 0.0, -2.4}, .arc = kPi / 2.0, .station = 120.0},
                                {.p_map = {140.0, 20.0, -2.7}},
                                {.p_map = {140.0, 100.0, -4.3}, .station = 231.5}});
  main.name = "main \"intake\" <1>";
  main.level = "upper";
  main.lanes = 2;
  main.width = 6.4;
  main.section = Section::Arch;
  main.height = 3.9;
  main.speed_limit = 25.0 / 3.6;
  main.locked = true;
  Roadway branch = roadway("R2",
                           {{.p_map = {60.0, 0.0, -1.2}},
                            {.p_map = {75.0, -60.0, -1.3}, .arc = -0.4},
                            {.p_map = {60.0, -95.0, -1.5}}},
                           4.2);
  branch.traffic = Traffic::ForwardOnly;
  branch.chainage_start = 1000.0;
  branch.level = "upper";
  Roadway lower = roadway("R3", {{.p_map = {90.0, -40.0, -14.0}}, {.p_map = {105.0, 70.0, -14.5}}}, 4.0);
  lower.level = "lower";
  mine.roadways = {main, branch, lower};
  mine.driving_side = Side::Left;
  mine.junctions = {{.id = "J1", .name = "fork", .places = {{"R1", 60.01}, {"R2", 1000.0}}}};
  mine.crossings = {{.id = "X1", .upper = {"R1", 95.5}, .lower = {"R3", 40.4}}};
  mine.bends = {{.id = "B1", .name = "", .stretch = {"R1", 120.0, 151.5}}};
  mine.chambers = {{.id = "C1",
                    .name = "n",
                    .place = {"R1", 30.0},
                    .side = Side::Left,
                    .length = 12.0,
                    .depth = 3.0,
                    .capacity = 2},
                   {.id = "C2",
                    .place = {"R1", 200.0},
                    .side = Side::Right,
                    .kind = Chamber::Kind::Refuge,
                    .length = 2.5,
                    .depth = 1.5,
                    .detection_sigma = 0.45}};
  mine.portals = {
      {.id = "P1", .name = "north portal", .place = {"R1", 0.0}, .handover_from = 0.0, .handover_to = 22.5}};
  mine.lights = {{.id = "L1", .place = {"R1", 50.0}, .side = Side::Left, .controls = Direction::Backward}};
  mine.stop_lines = {{.id = "S1", .place = {"R1", 48.0}, .controls = Direction::Backward, .light = "L1"}};
  mine.zones = {{.id = "Z1",
                 .name = "slow",
                 .stretch = {"R2", 1020.0, 1050.0},
                 .kind = RestrictedZone::Kind::SpeedLimit,
                 .speed_limit = 5.0 / 3.6}};
  mine.routes = {{.id = "T1", .name = "ore", .legs = {{"R1", 0.0, 60.01}, {"R2", 1000.0, 1090.0}}}};
  mine.anchors = {{.id = 1,
                   .name = "A one",
                   .p_map = {10.0, 3.2, 2.1},
                   .survey_sigma = 0.01,
                   .range_bias = 0.073,
                   .wall = Wall::Left,
                   .survey_date = "2024-05-03",
                   .antenna_delay = 5.1464e-7},
                  {.id = 12, .name = "12", .p_map = {55.5, -3.2, 1.0}, .survey_sigma = 0.02},
                  {.id = 40000, .name = "x,y", .p_map = {143.2, 1.0 / 3.0 + 60.0, -1.4}}};
  return mine;
}

/// 6 km on two levels: about 40 chambers and 120 anchors.
inline TunnelMap longMine() {
  TunnelMap mine;
  mine.name = "long mine";
  Roadway main = roadway("R1", {{.p_map = {0.0, 0.0, 0.0}},
                                {.p_map = {1800.0, 250.0, -40.0}, .arc = 0.7},
                                {.p_map = {2100.0, 420.0, -46.0}},
                                {.p_map = {3300.0, 1500.0, -70.0}}});
  main.name = "main drift";
  main.level = "900";
  Roadway branch = roadway("R2", {{.p_map = {900.0, 125.0, -20.0}}, {.p_map = {1300.0, -700.0, -60.0}}}, 4.5);
  branch.name = "ramp";
  Roadway lower = roadway("R3", {{.p_map = {1300.0, -700.0, -60.0}},
                                 {.p_map = {2400.0, -650.0, -62.0}, .arc = 1.0},
                                 {.p_map = {2700.0, 200.0, -64.0}},
                                 {.p_map = {2300.0, 1200.0, -66.0}}});
  lower.level = "840";
  mine.roadways = {main, branch, lower};
  mine.junctions = {{.id = "J1", .places = {{"R1", 908.7}, {"R2", 0.0}}},
                    {.id = "J2", .places = {{"R2", 917.6}, {"R3", 0.0}}}};
  mine.portals = {
      {.id = "P1", .name = "south portal", .place = {"R1", 0.0}, .handover_from = 0.0, .handover_to = 60.0}};
  for (int k = 1; k <= 40; ++k) {
    const bool first = k <= 24;
    mine.chambers.push_back({.id = "C" + std::to_string(k),
                             .place = {first ? "R1" : "R3", first ? 140.0 * k : 140.0 * (k - 24)},
                             .side = k % 2 == 0 ? Side::Left : Side::Right,
                             .length = 15.0,
                             .depth = 3.5});
  }
  return mine;
}

/// Text with everything that a format could trip over.
inline std::string randomText(RandomStream& random) {
  static const std::string kPieces[] = {
      "a", "B7", "12",  " ",   "\"",     "\\",           "'",          ",",    ":",  "#",
      "{", "]",  "<&>", "%%d", "\u00e4", "\u7164\u77ff", "\U0001F683", "true", "-0", "\\U+00E4"};
  std::string text = "x";
  const int pieces = static_cast<int>(random.uniform(0.0, 5.0));
  for (int k = 0; k < pieces; ++k) text += kPieces[random.bits() % std::size(kPieces)];
  return text;
}

inline std::vector<CentrelinePoint> randomCentreline(RandomStream& random, bool level) {
  std::vector<CentrelinePoint> points;
  Eigen::Vector3d p(random.uniform(-500.0, 500.0), random.uniform(-500.0, 500.0), random.uniform(-50.0, 0.0));
  double heading = random.uniform(-kPi, kPi);
  const int count = 2 + static_cast<int>(random.uniform(0.0, 5.0));
  for (int k = 0; k < count; ++k) {
    CentrelinePoint point{.p_map = p};
    if (random.bernoulli(0.4)) point.arc = random.uniform(-3.1, 3.1);
    if (random.bernoulli(0.3)) point.station = random.uniform(0.0, 900.0);
    points.push_back(point);
    heading += random.uniform(-0.8, 0.8);
    const double step = random.uniform(15.0, 120.0);
    p += step *
         Eigen::Vector3d(std::cos(heading), std::sin(heading), level ? 0.0 : random.uniform(-0.15, 0.15));
  }
  return points;
}

/// A map that `validated` takes, with every kind of object; `level` roadways do not climb.
inline TunnelMap randomMine(RandomStream& random, bool level = false) {
  TunnelMap mine;
  mine.name = randomText(random);
  const auto id = [](const char* letter, std::size_t k) { return letter + std::to_string(k + 1); };
  const std::size_t roadways = 1 + random.bits() % 4;
  for (std::size_t k = 0; k < roadways; ++k) {
    Roadway made = roadway(id("R", k), randomCentreline(random, level), random.uniform(2.0, 7.0));
    made.name = random.bernoulli(0.5) ? randomText(random) : "";
    made.height = random.uniform(0.6 * made.width, 8.0);
    made.section = random.bernoulli(0.5) ? Section::Arch : Section::Rectangle;
    made.lanes = random.bernoulli(0.3) ? 2 : 1;
    if (made.lanes == 1 && random.bernoulli(0.4)) made.traffic = Traffic::BackwardOnly;
    if (random.bernoulli(0.5)) made.speed_limit = random.uniform(0.5, 12.0);
    if (random.bernoulli(0.5)) made.chainage_start = random.uniform(-100.0, 2000.0);
    made.locked = random.bernoulli(0.5);
    mine.roadways.push_back(std::move(made));
  }
  const auto place = [&]() -> RoadwayPlace {
    const Roadway& on = mine.roadways[random.bits() % mine.roadways.size()];
    return {on.id, on.chainage_start + random.uniform(0.0, 15.0)};
  };
  const auto stretch = [&]() -> RoadwayStretch {
    const RoadwayPlace from = place();
    return {from.roadway, from.chainage, from.chainage + random.uniform(0.0, 40.0)};
  };
  const auto side = [&] { return random.bernoulli(0.5) ? Side::Left : Side::Right; };
  for (std::size_t k = 0; k < random.bits() % 4; ++k) {
    mine.junctions.push_back({.id = id("J", k), .name = "", .places = {place(), place()}});
    mine.chambers.push_back({.id = id("C", k),
                             .name = randomText(random),
                             .place = place(),
                             .side = side(),
                             .length = random.uniform(1.0, 20.0),
                             .depth = random.uniform(0.5, 4.0)});
    mine.crossings.push_back({.id = id("X", k), .upper = place(), .lower = place()});
    mine.bends.push_back({.id = id("B", k), .name = "", .stretch = stretch()});
    const RoadwayStretch zone = stretch();
    mine.portals.push_back({.id = id("P", k),
                            .name = "",
                            .place = {zone.roadway, zone.from},
                            .handover_from = zone.from,
                            .handover_to = zone.to});
    mine.lights.push_back({.id = id("L", k), .place = place(), .side = side()});
    mine.stop_lines.push_back({.id = id("S", k), .place = place(), .light = id("L", k)});
    mine.zones.push_back(
        {.id = id("Z", k), .name = "", .stretch = stretch(), .kind = RestrictedZone::Kind::NoMeeting});
    mine.routes.push_back({.id = id("T", k), .name = "", .legs = {stretch(), stretch()}});
  }
  for (AnchorId k = 0; k < static_cast<AnchorId>(random.bits() % 12); ++k) {
    mine.anchors.push_back({.id = 7 * k - 10,
                            .name = randomText(random),
                            .p_map = {random.uniform(-500.0, 500.0), random.normal(), random.normal() * 1e-9},
                            .survey_sigma = random.uniform(),
                            .range_bias = random.normal()});
  }
  if (random.bernoulli(0.5))
    mine.mine_grid =
        MineGrid{"g", random.uniform(1e5, 1e7), random.uniform(1e5, 1e7), 12.5, random.uniform(-3.0, 3.0)};
  if (random.bernoulli(0.5))
    mine.origin = GeodeticOrigin{random.uniform(-1.5, 1.5),
                                 random.uniform(-3.1, 3.1),
                                 100.0,
                                 random.uniform(-3.0, 3.0),
                                 {1.0, 0.0, 0.0}};
  return mine;
}

}  // namespace pos::map::samples
