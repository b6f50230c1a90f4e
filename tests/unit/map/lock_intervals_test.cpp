#include "pos/map/lock_intervals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "pos/core/error.hpp"
#include "support/small_mine.hpp"

namespace pos::map {
namespace {

using test::gridMine;
using test::networkOf;
using test::straightRoadway;

/// The paper's figure 3: a double lane with chambers every 100 m on the right (and others on the left), a
/// branch at 250 m, a bend after 600 m.
TunnelMap figure3() {
  TunnelMap map{.name = "figure 3"};
  Roadway main = straightRoadway("main", {0, 0, 0}, {600, 0, 0});
  main.lanes = 2;
  main.centreline[1].arc = -kPi / 2;
  main.centreline.push_back({.p_map = {615, -15, 0}});
  main.centreline.push_back({.p_map = {615, -315, 0}});
  map.roadways = {main, straightRoadway("branch", {250, 0, 0}, {400, 259.8, 0})};
  map.junctions = {{.id = "J", .places = {{"main", 250.0}, {"branch", 0.0}}}};
  map.bends = {{.id = "B", .stretch = {"main", 600.0, 623.56}}};
  for (int k = 1; k <= 5; ++k) {
    const std::string number = std::to_string(k);
    map.chambers.push_back({.id = "r" + number, .place = {"main", 100.0 * k}, .side = Side::Right});
    map.chambers.push_back({.id = "l" + number, .place = {"main", 100.0 * k + 40.0}, .side = Side::Left});
  }
  map.chambers.push_back({.id = "k1", .place = {"main", 700.0}, .side = Side::Right});
  map.chambers.push_back({.id = "k2", .place = {"main", 800.0}, .side = Side::Right});
  for (int k = 1; k <= 3; ++k) {
    map.chambers.push_back({.id = "j" + std::to_string(k),
                            .place = {"branch", 80.0 * k},
                            .side = k == 2 ? Side::Left : Side::Right});
  }
  return map;
}

std::vector<std::string> labels(const std::vector<LockInterval>& intervals) {
  std::vector<std::string> labels;
  for (const LockInterval& interval : intervals) labels.push_back(interval.label());
  return labels;
}

std::vector<std::string> ids(const std::vector<LockInterval>& intervals) {
  std::vector<std::string> ids;
  for (const LockInterval& interval : intervals) ids.push_back(interval.id);
  return ids;
}

RouteLine whole(const Network& network, RoadwayIndex r) {
  return RouteLine({{r, network.centreline(r).chainageStart(), network.centreline(r).chainageEnd()}});
}

/// A mine with random single- and double-lane roadways and chambers.
TunnelMap randomField(std::uint64_t seed) {
  TunnelMap map = gridMine(seed, 3);
  RandomStream random(seed, 11);
  for (Roadway& roadway : map.roadways) {
    roadway.lanes = random.bernoulli(0.4) ? 2 : 1;
    if (roadway.lanes == 2) roadway.traffic = Traffic::BothWays;
    for (int i = 0; i < 4; ++i) {
      if (random.bernoulli(0.4)) continue;
      map.chambers.push_back({.id = roadway.id + "c" + std::to_string(i),
                              .place = {roadway.id, random.uniform(1.0, 199.0)},
                              .side = random.bernoulli(0.5) ? Side::Left : Side::Right});
    }
  }
  return map;
}

}  // namespace

TEST(LockIntervals, StraightOnAlongTheDoubleLaneTheLettersAreThePapers) {
  const Network network = networkOf(figure3());
  const auto intervals = divided(RoadGraph(network), network, whole(network, 0), {});
  EXPECT_EQ(labels(intervals),
            (std::vector<std::string>{"i_1", "i_2", "i_3", "i_4", "i_5", "j_0", "j_1", "j_2"}))
      << "the bend ends the first leg; this route never enters the branch, so the leg behind it is the "
         "second";
  EXPECT_EQ(intervals[2].nodes, std::vector<std::string>{"J"}) << "the junction lies inside r2 to r3";
  EXPECT_EQ(intervals[5].from, "r5");
  EXPECT_EQ(intervals[5].to, "k1");
  EXPECT_EQ(intervals[5].nodes, std::vector<std::string>{"B"});
}

TEST(LockIntervals, TurningOffGivesIndexZeroOfTheNextLetter) {
  const Network network = networkOf(figure3());
  const auto intervals =
      divided(RoadGraph(network), network, RouteLine({{0, 0.0, 250.0}, {1, 0.0, 299.0}}), {});
  EXPECT_EQ(labels(intervals), (std::vector<std::string>{"i_1", "i_2", "j_0", "j_1", "j_2", "j_3"}));
  EXPECT_EQ(intervals[2].from, "r2");
  EXPECT_EQ(intervals[2].to, "j1");
  ASSERT_EQ(intervals[2].spans.size(), 2U);
  EXPECT_EQ(intervals[2].spans[0], (IntervalSpan{0, 200.0, 250.0, Lane::Forward}));
  EXPECT_EQ(intervals[2].spans[1], (IntervalSpan{1, 0.0, 80.0, Lane::Both}));
}

TEST(LockIntervals, EachLaneHasItsOwnChambers) {
  const Network network = networkOf(figure3());
  const auto up = divided(RoadGraph(network), network, whole(network, 0), {});
  const auto down = divided(RoadGraph(network), network, whole(network, 0).reversed(), {});
  for (const LockInterval& interval : up) EXPECT_EQ(interval.from.find('l'), std::string::npos);
  EXPECT_EQ(down[0].to, "l5");
  EXPECT_EQ(down[1].from, "l5");
  EXPECT_EQ(down[1].to, "l4");
}

TEST(LockIntervals, OtherDrivingSideExchangesTheLanes) {
  TunnelMap map = figure3();
  map.driving_side = Side::Left;
  const Network network = networkOf(map);
  EXPECT_EQ(divided(RoadGraph(network), network, whole(network, 0), {})[0].to, "l1");
}

TEST(LockIntervals, BeforeTheJunctionAVehicleIsInTwoIntervals) {
  const Network network = networkOf(figure3());
  const auto all = divided(RoadGraph(network), network, {});
  EXPECT_EQ(intervalsAt(all, 0, 225.0, Lane::Forward).size(), 2U) << "going on, and branching off";
  EXPECT_EQ(intervalsAt(all, 0, 150.0, Lane::Forward).size(), 1U);
  EXPECT_GE(intervalsAt(all, 1, 40.0, Lane::Both).size(), 2U) << "from the left, from the right, and back";
}

TEST(LockIntervals, MapAndRouteGiveTheSameIntervalTheSameId) {
  const Network network = networkOf(figure3());
  const RoadGraph graph(network);
  const std::vector<std::string> all = ids(divided(graph, network, {}));
  for (const RouteLine& route : {whole(network, 0), whole(network, 0).reversed(), whole(network, 1),
                                 RouteLine({{0, 0.0, 250.0}, {1, 0.0, network.centreline(1).length()}})}) {
    for (const LockInterval& interval : divided(graph, network, route, {})) {
      const bool begins_in_the_middle = interval.from.find('J') == 0;
      EXPECT_TRUE(begins_in_the_middle || std::count(all.begin(), all.end(), interval.id) == 1)
          << interval.id;
    }
  }
}

TEST(LockIntervals, EveryPointOfARouteIsInAnInterval) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Network network = networkOf(randomField(seed));
    const RoadGraph graph(network);
    const auto route = graph.shortestRoute({0, 3.0, 0, 0}, {3, 190.0, 0, 0});
    if (!route) continue;
    for (const int merge : {1, 2, 3}) {
      const auto intervals = divided(graph, network, *route, {.merge = merge});
      double length = 0.0;
      for (const LockInterval& interval : intervals) length += interval.length();
      EXPECT_NEAR(length, route->length(), 1e-6) << "along one route they also do not overlap";
      for (double d = 0.0; d <= route->length(); d += 0.7) {
        const PlaceOnRoute place = route->at(d);
        EXPECT_FALSE(intervalsAt(intervals, place.roadway, place.chainage, Lane::Both).empty()) << d;
      }
    }
  }
}

TEST(LockIntervals, EveryPointOfEveryLaneIsInAnIntervalOfTheMap) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Network network = networkOf(randomField(seed));
    const RoadGraph graph(network);
    const auto all = divided(graph, network, {});
    const std::vector<std::string> names = ids(all);
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), all.size()) << "ids are unique";
    for (RoadwayIndex r = 0; r < network.map().roadways.size(); ++r) {
      for (double c = 0.5; c < 200.0; c += 1.0) {
        if (network.map().roadways[r].lanes == 1) {
          EXPECT_FALSE(intervalsAt(all, r, c, Lane::Both).empty()) << "seed " << seed;
        } else {
          EXPECT_FALSE(intervalsAt(all, r, c, Lane::Forward).empty()) << "seed " << seed;
          EXPECT_FALSE(intervalsAt(all, r, c, Lane::Backward).empty()) << "seed " << seed;
        }
      }
    }
  }
}

TEST(LockIntervals, MergingKeepsTheEndsAndTheChambersInside) {
  const Network network = networkOf(figure3());
  const RoadGraph graph(network);
  const auto one = divided(graph, network, whole(network, 0), {});
  const auto two = divided(graph, network, whole(network, 0), {.merge = 2});
  EXPECT_EQ(two.front().from, one.front().from);
  EXPECT_EQ(two.back().to, one.back().to);
  EXPECT_EQ(labels(two), (std::vector<std::string>{"i_1", "i_2", "i_3", "j_0", "j_1"}));
  EXPECT_EQ(two[0].inner_chambers, std::vector<std::string>{"r1"});
  EXPECT_EQ(two[2].inner_chambers, std::vector<std::string>{}) << "the last of five stays alone";
  std::set<std::string> ends;
  for (const LockInterval& interval : one) ends.insert({interval.from, interval.to});
  for (const LockInterval& interval : two)
    EXPECT_TRUE(ends.count(interval.from) == 1 && ends.count(interval.to) == 1);
}

TEST(LockIntervals, ReversedSingleLaneRouteHasTheSameIntervals) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    TunnelMap map = randomField(seed);
    for (Roadway& roadway : map.roadways) {
      roadway.lanes = 1;
      roadway.traffic = Traffic::BothWays;
    }
    const Network network = networkOf(map);
    const RoadGraph graph(network);
    const auto route = graph.shortestRoute({0, 3.0, 0, 0}, {3, 190.0, 0, 0});
    ASSERT_TRUE(route.has_value());
    std::vector<std::string> there = ids(divided(graph, network, *route, {}));
    const std::vector<std::string> back = ids(divided(graph, network, route->reversed(), {}));
    std::reverse(there.begin(), there.end());
    EXPECT_EQ(there, back);
  }
}

TEST(LockIntervals, AddingAChamberElsewhereKeepsAllOtherIds) {
  TunnelMap map = figure3();
  const auto idsOf = [](const TunnelMap& m) {
    const Network network = networkOf(m);
    const auto all = ids(divided(RoadGraph(network), network, {}));
    return std::set<std::string>(all.begin(), all.end());
  };
  const std::set<std::string> before = idsOf(map);
  map.chambers.push_back({.id = "new", .place = {"branch", 200.0}, .side = Side::Left});
  const std::set<std::string> after = idsOf(map);
  std::vector<std::string> gone;
  std::set_difference(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(gone));
  EXPECT_EQ(gone.size(), 1U) << "only the interval that is divided";
}

TEST(LockIntervals, RingWithoutChambersIsCovered) {
  TunnelMap map{.name = "ring"};
  Roadway ring;
  ring.id = "ring";
  ring.centreline = {
      {.p_map = {0, 0, 0}, .arc = kPi}, {.p_map = {0, 40, 0}, .arc = kPi}, {.p_map = {0, 0, 0}}};
  map.roadways = {ring};
  map.junctions = {{.id = "J", .places = {{"ring", 0.0}, {"ring", 40.0 * kPi}}}};
  const Network network = networkOf(map);
  const auto all = divided(RoadGraph(network), network, {});
  ASSERT_FALSE(all.empty());
  for (double c = 0.0; c < 125.0; c += 1.0) EXPECT_FALSE(intervalsAt(all, 0, c, Lane::Both).empty());
}

TEST(LockIntervals, MergeFactorHasToBePositive) {
  EXPECT_THROW(validated(DivisionRules{.merge = 0}), ConfigError);
}

}  // namespace pos::map
