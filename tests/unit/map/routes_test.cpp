#include "pos/map/routes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/small_mine.hpp"

namespace pos::map {
namespace {

using test::gridMine;
using test::networkOf;
using test::straightRoadway;

/// Every way that uses no edge twice the same way, by exhaustion.
class SlowSearch {
 public:
  SlowSearch(const RoadGraph& graph, const TunnelPoint& goal) : graph_(graph), goal_(goal) {}

  double shortest(const TunnelPoint& start) {
    const std::size_t e = *graph_.edgeAt(start.roadway, start.chainage);
    for (const Direction way : {Direction::Forward, Direction::Backward}) drive(e, way, start.chainage, 0.0);
    return best_;
  }

 private:
  void drive(std::size_t e, Direction way, double from, double cost) {
    const GraphEdge& edge = graph_.edges()[e];
    if (!graph_.allows(e, way) || cost >= best_) return;
    const bool forward = way == Direction::Forward;
    const bool ahead = forward ? goal_.chainage >= from : goal_.chainage <= from;
    if (e == *graph_.edgeAt(goal_.roadway, goal_.chainage) && ahead)
      best_ = std::min(best_, cost + std::abs(goal_.chainage - from));
    const double end = forward ? edge.to : edge.from;
    const std::size_t node = forward ? edge.node_to : edge.node_from;
    if (std::count(used_.begin(), used_.end(), node) > 0) return;
    used_.push_back(node);
    for (std::size_t next = 0; next < graph_.edges().size(); ++next) {
      const GraphEdge& candidate = graph_.edges()[next];
      if (next != e && candidate.node_from == node)
        drive(next, Direction::Forward, candidate.from, cost + std::abs(end - from));
      if (next != e && candidate.node_to == node)
        drive(next, Direction::Backward, candidate.to, cost + std::abs(end - from));
    }
    used_.pop_back();
  }

  const RoadGraph& graph_;
  TunnelPoint goal_;
  std::vector<std::size_t> used_;
  double best_ = std::numeric_limits<double>::infinity();
};

}  // namespace

TEST(RouteLine, WalksItsLegsBothWays) {
  const RouteLine route({{0, 10.0, 40.0}, {1, 25.0, 5.0}});
  EXPECT_DOUBLE_EQ(route.length(), 50.0);
  EXPECT_DOUBLE_EQ(route.at(12.0).chainage, 22.0);
  EXPECT_EQ(route.at(35.0).roadway, 1U);
  EXPECT_DOUBLE_EQ(route.at(35.0).chainage, 20.0);
  EXPECT_EQ(route.at(35.0).direction, Direction::Backward);
  EXPECT_DOUBLE_EQ(route.at(99.0).chainage, 5.0);
  EXPECT_DOUBLE_EQ(route.reversed().at(15.0).chainage, 20.0);
  EXPECT_EQ(route.reversed().at(15.0).direction, Direction::Forward);
}

TEST(RouteLine, DistanceIsFoundAtEveryPassage) {
  const RouteLine there_and_back({{0, 0.0, 30.0}, {0, 30.0, 0.0}});
  EXPECT_EQ(there_and_back.distancesOf(0, 10.0), (std::vector<double>{10.0, 50.0}));
  EXPECT_TRUE(there_and_back.distancesOf(0, 31.0).empty());
  EXPECT_TRUE(there_and_back.distancesOf(1, 10.0).empty());
}

TEST(RouteLine, LegsThatGoOnAreOne) {
  EXPECT_EQ(RouteLine({{0, 0.0, 30.0}, {0, 30.0, 50.0}}).legs().size(), 1U);
  EXPECT_EQ(RouteLine({{0, 0.0, 30.0}, {0, 30.0, 20.0}}).legs().size(), 2U) << "turned round";
}

TEST(RoadGraph, JunctionsPortalsAndOpenEndsAreNodes) {
  TunnelMap map{.name = "T"};
  map.roadways = {straightRoadway("main", {0, 0, 0}, {100, 0, 0}),
                  straightRoadway("side", {40, 0, 0}, {40, 60, 0})};
  map.junctions = {{.id = "J", .places = {{"main", 40.0}, {"side", 0.0}}}};
  map.portals = {{.id = "P", .place = {"main", 0.0}}};
  const RoadGraph graph(networkOf(map));
  EXPECT_EQ(graph.edges().size(), 3U);
  ASSERT_EQ(graph.nodes().size(), 4U);
  EXPECT_EQ(graph.nodes()[0].id, "J");
  EXPECT_EQ(graph.nodes()[1].kind, GraphNode::Kind::Portal);
  EXPECT_EQ(graph.nodes()[2].id, "main:end");
  EXPECT_EQ(graph.nodes()[3].id, "side:end");
  EXPECT_EQ(graph.edgesOf(0).size(), 3U);
}

TEST(RoadGraph, AJunctionPastARoadwaysEndStandsAtThatEnd) {
  TunnelMap map{.name = "typing mistakes"};
  map.roadways = {straightRoadway("A", {0, 0, 0}, {100, 0, 0}),
                  straightRoadway("B", {100, 0, 0}, {100, 50, 0})};
  map.junctions = {{.id = "J", .places = {{"A", 6000.0}, {"B", -20.0}}}};
  const RoadGraph graph(networkOf(map));
  ASSERT_EQ(graph.edges().size(), 2U);
  for (const GraphEdge& edge : graph.edges()) EXPECT_LT(edge.from, edge.to);
  EXPECT_EQ(graph.edges()[0].to, 100.0);
  EXPECT_EQ(graph.nodes()[graph.edges()[0].node_to].id, "J");
  EXPECT_EQ(graph.edgesOn(1).size(), 1U);
  EXPECT_EQ(graph.edgesOn(1)[0].node_from, graph.edges()[0].node_to);
}

TEST(RoadGraph, ShortestRouteAgreesWithExhaustion) {
  int found = 0;
  int none = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Network network = networkOf(gridMine(seed, 3));
    const RoadGraph graph(network);
    RandomStream random(seed, 7);
    for (int i = 0; i < 25; ++i) {
      const auto anywhere = [&] {
        const RoadwayIndex r = random.bits() % network.map().roadways.size();
        return TunnelPoint{r, random.uniform(0.0, network.centreline(r).length()), 0.0, 0.0};
      };
      const TunnelPoint start = anywhere();
      const TunnelPoint goal = anywhere();
      const double slow = SlowSearch(graph, goal).shortest(start);
      const auto route = graph.shortestRoute(start, goal);
      ASSERT_EQ(route.has_value(), std::isfinite(slow)) << "seed " << seed << " pair " << i;
      none += route ? 0 : 1;
      if (!route) continue;
      ++found;
      EXPECT_NEAR(route->length(), slow, 1e-9);
      EXPECT_EQ(route->at(0.0).roadway, start.roadway);
      EXPECT_DOUBLE_EQ(route->at(0.0).chainage, start.chainage);
      EXPECT_NEAR(route->at(route->length()).chainage, goal.chainage, 1e-9);
    }
  }
  EXPECT_GT(found, 60);
  EXPECT_GT(none, 3);
}

TEST(RoadGraph, RouteHasNoGapsInSpace) {
  const Network network = networkOf(gridMine(2, 4));
  const RoadGraph graph(network);
  const auto route = graph.shortestRoute({0, 5.0, 0, 0}, {3, 190.0, 0, 0});
  ASSERT_TRUE(route.has_value());
  for (double d = 0.0; d + 0.5 < route->length(); d += 0.5) {
    const PlaceOnRoute a = route->at(d);
    const PlaceOnRoute b = route->at(d + 0.5);
    EXPECT_LT((network.centreline(a.roadway).at(a.chainage).p_map -
               network.centreline(b.roadway).at(b.chainage).p_map)
                  .norm(),
              0.5 + 1e-9);
  }
}

TEST(RoadGraph, ClosedZoneIsDrivenRound) {
  TunnelMap map = gridMine(1, 3);
  for (Roadway& roadway : map.roadways) roadway.traffic = Traffic::BothWays;
  const TunnelPoint start{0, 10.0, 0, 0};
  const TunnelPoint goal{0, 90.0, 0, 0};
  EXPECT_NEAR(RoadGraph(networkOf(map)).shortestRoute(start, goal)->length(), 80.0, 1e-9);
  map.zones = {{.id = "Z", .stretch = {"H0", 70.0, 72.0}}};
  EXPECT_NEAR(RoadGraph(networkOf(map)).shortestRoute(start, goal)->length(), 180.0, 1e-9)
      << "up, along the next roadway and down again";
  map.zones[0].stretch = {"H0", 60.0, 62.0};
  EXPECT_NEAR(RoadGraph(networkOf(map)).shortestRoute({0, 55.0, 0, 0}, {0, 65.0, 0, 0})->length(), 190.0,
              1e-9);
}

}  // namespace pos::map
