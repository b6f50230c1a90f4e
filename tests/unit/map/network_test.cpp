#include "pos/map/network.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "pos/core/error.hpp"
#include "pos/map/clearance.hpp"
#include "support/small_mine.hpp"

namespace pos::map {
namespace {

using test::networkOf;
using test::randomMine;
using test::straightRoadway;

/// Two roadways, 4 m wide and 3 m high, that cross at right angles with 4 m between their floors.
TunnelMap bridge() {
  TunnelMap map{.name = "bridge"};
  map.roadways = {straightRoadway("low", {-50, 0, 0}, {50, 0, 0}),
                  straightRoadway("high", {0, -50, 4}, {0, 50, 4})};
  return map;
}

/// Brute force over every segment, sharing nothing with the tree.
Projection slowProjection(const Network& network, const Eigen::Vector3d& p) {
  Projection best;
  double best_excess = 1e9;
  double best_distance = 1e9;
  for (RoadwayIndex r = 0; r < network.map().roadways.size(); ++r) {
    const Roadway& roadway = network.map().roadways[r];
    for (std::size_t s = 0; s < network.centreline(r).segments().size(); ++s) {
      const Centreline::Foot foot = network.centreline(r).footOnSegment(s, p);
      const double across = std::max(0.0, std::abs(foot.offset) - roadway.width / 2);
      const double up = foot.height < 0 ? -foot.height : std::max(0.0, foot.height - roadway.height);
      const double excess = std::hypot(across, up, foot.beyond);
      const double distance = std::hypot(foot.offset, foot.height, foot.beyond);
      if (excess > best_excess + 1e-12 || (excess > best_excess - 1e-12 && distance >= best_distance))
        continue;
      best_excess = excess;
      best_distance = distance;
      best = {{r, foot.chainage, foot.offset, foot.height}, foot.beyond, excess};
    }
  }
  return best;
}

/// Open space by its definition: everything near enough to the centrelines walked in steps of half a metre.
class SlowSpace {
 public:
  explicit SlowSpace(const Network& network) {
    for (RoadwayIndex r = 0; r < network.map().roadways.size(); ++r) {
      const Centreline& line = network.centreline(r);
      for (double c = line.chainageStart(); c <= line.chainageEnd(); c += 0.5) {
        points_.push_back({line.at(c).p_map, &network.map().roadways[r]});
      }
    }
  }

  bool holds(const Eigen::Vector3d& p, double slack) const {
    return std::any_of(points_.begin(), points_.end(), [&](const Point& point) {
      const Eigen::Vector3d d = p - point.p_map;
      return d.head<2>().norm() <= point.roadway->width / 2 + slack && d.z() >= -slack &&
             d.z() <= point.roadway->height + slack;
    });
  }
  bool inSight(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double slack) const {
    const int steps = static_cast<int>((b - a).norm() / 0.2) + 1;
    for (int i = 0; i <= steps; ++i) {
      if (!holds(a + (b - a) * i / steps, slack)) return false;
    }
    return true;
  }

 private:
  struct Point {
    Eigen::Vector3d p_map;
    const Roadway* roadway;
  };
  std::vector<Point> points_;
};

/// Whether the foot is at a kink, where the way back is not defined.
bool isAtKink(const Network& network, const TunnelPoint& point) {
  const auto& segments = network.centreline(point.roadway).segments();
  return std::any_of(segments.begin(), segments.end(), [&](const CentrelineSegment& segment) {
    return std::abs(segment.chainage - point.chainage) < 1e-9;
  });
}

}  // namespace

TEST(Network, LevelsAreToldApartByHeight) {
  const Network network = networkOf(bridge());
  EXPECT_EQ(network.project({1.0, 0.5, 1.5})->point.roadway, 0U);
  EXPECT_EQ(network.project({1.0, 0.5, 2.9})->point.roadway, 0U)
      << "inside the lower, nearer to the upper floor";
  EXPECT_EQ(network.project({1.0, 0.5, 4.2})->point.roadway, 1U);
  EXPECT_EQ(network.project({1.0, 0.5, 3.9})->point.roadway, 1U)
      << "in the rock, 0.1 m under the upper floor";
  EXPECT_EQ(network.candidates({1.0, 0.5, 3.5}, 1.0).size(), 2U);
  EXPECT_EQ(network.candidates({1.0, 0.5, 1.0}, 1.0).size(), 1U);
}

TEST(Network, ProjectionAndItsInverseAgree) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Network network = networkOf(randomMine(seed, 8, 8));
    RandomStream random(seed, 2);
    for (int i = 0; i < 200; ++i) {
      const RoadwayIndex r = random.bits() % 8;
      const Centreline& line = network.centreline(r);
      const TunnelPoint point{r, random.uniform(line.chainageStart(), line.chainageEnd()),
                              random.uniform(-1.4, 1.4), random.uniform(0.0, 3.0)};
      const Eigen::Vector3d p = network.toMap(point);
      const std::vector<Projection> all = network.candidates(p, 0.5);
      const bool back = std::any_of(all.begin(), all.end(), [&](const Projection& q) {
        return q.beyond == 0.0 && (isAtKink(network, q.point) || (network.toMap(q.point) - p).norm() < 1e-9);
      });
      EXPECT_TRUE(back) << "seed " << seed << " point " << i;
    }
  }
}

TEST(Network, ProjectionAgreesWithBruteForce) {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Network network = networkOf(randomMine(seed, 12, 10));
    RandomStream random(seed, 3);
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d p(random.uniform(-250, 250), random.uniform(-250, 250), random.uniform(-16, 6));
      const Projection slow = slowProjection(network, p);
      const Projection fast = *network.project(p);
      EXPECT_NEAR(fast.excess, slow.excess, 1e-9);
      EXPECT_EQ(fast.point.roadway, slow.point.roadway);
      EXPECT_NEAR(fast.point.chainage, slow.point.chainage, 1e-6);
      ++compared;
    }
  }
  EXPECT_EQ(compared, 3000);
}

TEST(Network, CandidatesAreOnePerRoadwayAndSorted) {
  const Network network = networkOf(randomMine(1, 20, 10));
  RandomStream random(5, 0);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p(random.uniform(-200, 200), random.uniform(-200, 200), random.uniform(-14, 4));
    const auto found = network.candidates(p, 15.0);
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_LE(found[k].excess, 15.0);
      if (k > 0) {
        EXPECT_LE(found[k - 1].excess, found[k].excess);
      }
      for (std::size_t j = 0; j < k; ++j) EXPECT_NE(found[j].point.roadway, found[k].point.roadway);
    }
    const Projection nearest = *network.project(p);
    ASSERT_EQ(found.empty(), nearest.excess > 15.0);
    if (found.empty()) continue;
    EXPECT_EQ(found.front().point, nearest.point);
  }
}

TEST(Network, SightRunsAlongARoadwayAndNotThroughRock) {
  const Network network = networkOf(bridge());
  EXPECT_TRUE(network.inSight({-49, 1.9, 0.1}, {49, -1.9, 2.9}));
  EXPECT_FALSE(network.inSight({-49, 0, 1}, {0, 40, 5})) << "another level, round the corner";
  EXPECT_FALSE(network.inSight({0, 0, 1}, {0, 0, 5})) << "straight up through the rock between the levels";
  EXPECT_FALSE(network.inSight({-49, 0, 1}, {52, 0, 1})) << "past the end";
  EXPECT_FALSE(network.inSight({-49, 2.2, 1}, {49, 2.2, 1})) << "in the wall";
}

TEST(Network, AnchorAFewCentimetresInTheRockIsStillSeen) {
  const Network network = networkOf(bridge());
  EXPECT_TRUE(network.inSight({-49, 0, 1}, {20, 2.04, 1}));
  EXPECT_FALSE(network.inSight({-49, 0, 1}, {20, 2.04, 1}, 0.0));
}

TEST(Network, CornerOfAQuarterTurnHidesWhatIsBehindIt) {
  TunnelMap map{.name = "corner"};
  map.roadways = {straightRoadway("a", {0, 0, 0}, {10, 0, 0}),
                  straightRoadway("b", {10, 2, 0}, {10, -20, 0})};
  const Network network = networkOf(map);
  // Inner corner at (8, -2).
  EXPECT_TRUE(network.inSight({0, 1.9, 1}, {11.9, -3.85, 1}, 0.0));
  EXPECT_FALSE(network.inSight({0, 1.9, 1}, {11.9, -3.95, 1}, 0.0));
}

TEST(Network, KinkIsFilledOutToItsOuterCorner) {
  TunnelMap map{.name = "kink"};
  Roadway roadway = straightRoadway("a", {0, 0, 0}, {10, 0, 0});
  roadway.centreline.push_back({.p_map = {10, 10, 0}});
  map.roadways = {roadway};
  const Network network = networkOf(map);
  EXPECT_TRUE(network.isInside({11.99, -1.99, 1.0}));
  EXPECT_FALSE(network.isInside({12.01, -1.99, 1.0}));
  EXPECT_TRUE(network.inSight({1, -1.9, 1}, {11.9, -1.9, 1}));
  EXPECT_TRUE(network.inSight({11.9, -1.9, 1}, {11.9, 9, 1}));
}

TEST(Network, SightAgreesWithAWalkAlongTheLine) {
  int seen = 0;
  int hidden = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    TunnelMap mine = randomMine(seed, 4, 5);
    for (Roadway& roadway : mine.roadways) roadway.section = Section::Rectangle;
    const Network network = networkOf(mine);
    const SlowSpace slow(network);
    RandomStream random(seed, 4);
    for (int i = 0; i < 60; ++i) {
      const RoadwayIndex r = random.bits() % 4;
      const Centreline& line = network.centreline(r);
      const double c = random.uniform(line.chainageStart() + 1.0, line.chainageEnd() - 1.0);
      const double d =
          std::clamp(c + random.uniform(-80.0, 80.0), line.chainageStart() + 1.0, line.chainageEnd() - 1.0);
      const Eigen::Vector3d a = network.toMap({r, c, random.uniform(-1.4, 1.4), random.uniform(0.2, 3.0)});
      const Eigen::Vector3d b = network.toMap({r, d, random.uniform(-1.4, 1.4), random.uniform(0.2, 3.0)});
      // The walk knows the walls to a few centimetres; kinks are rounded there and mitred here.
      const bool surely = slow.inSight(a, b, -0.05);
      const bool perhaps = slow.inSight(a, b, 0.9);
      const bool fast = network.inSight(a, b, 0.0);
      EXPECT_TRUE(fast || !surely) << "seed " << seed << " line " << i;
      EXPECT_TRUE(perhaps || !fast) << "seed " << seed << " line " << i;
      seen += surely ? 1 : 0;
      hidden += perhaps ? 0 : 1;
    }
  }
  EXPECT_GT(seen, 60);
  EXPECT_GT(hidden, 60);
}

TEST(Network, InsideFollowsTheArch) {
  TunnelMap map{.name = "arch"};
  map.roadways = {straightRoadway("a", {0, 0, 0}, {100, 0, 0})};
  map.roadways[0].section = Section::Arch;
  const Network network = networkOf(map);  // 4 m wide, walls 1 m, semicircle of 2 m
  EXPECT_TRUE(network.isInside({50, 0, 2.95}));
  EXPECT_TRUE(network.isInside({50, 1.9, 0.9}));
  EXPECT_FALSE(network.isInside({50, 1.9, 2.0}));
  EXPECT_DOUBLE_EQ(roofHeight(map.roadways[0], 0.0), 3.0);
  EXPECT_NEAR(roofHeight(map.roadways[0], 1.2), 1.0 + 1.6, 1e-12);
}

TEST(Network, ChamberIsOpenSpace) {
  TunnelMap map{.name = "niche"};
  map.roadways = {straightRoadway("a", {0, 0, 0}, {100, 0, 0})};
  map.chambers = {{.id = "C", .place = {"a", 50.0}, .side = Side::Left, .length = 6.0, .depth = 3.0}};
  const Network network = networkOf(map);
  EXPECT_TRUE(network.isInside({52.9, 4.9, 1.0}));
  EXPECT_FALSE(network.isInside({52.9, -4.9, 1.0}));
  EXPECT_FALSE(network.isInside({53.1, 4.9, 1.0}));
  EXPECT_TRUE(network.inSight({50, 4.5, 1}, {52, -1, 1}));
}

TEST(Network, ChambersAreListedByRoadwayInMapOrder) {
  TunnelMap map{.name = "three chambers"};
  map.roadways = {straightRoadway("A", {0, 0, 0}, {100, 0, 0}),
                  straightRoadway("B", {0, 50, 0}, {100, 50, 0})};
  map.chambers = {{.id = "C1", .place = {"B", 80.0}},
                  {.id = "C2", .place = {"A", 10.0}},
                  {.id = "C3", .place = {"B", 20.0}}};
  const Network network = networkOf(map);
  EXPECT_EQ(network.chambersOn(0), (std::vector<std::size_t>{1}));
  EXPECT_EQ(network.chambersOn(1), (std::vector<std::size_t>{0, 2}));
}

TEST(Network, VisibleAnchorsAreThoseInRangeAndInSight) {
  TunnelMap map = bridge();
  for (int i = -5; i <= 5; ++i) {
    map.anchors.push_back({.id = i, .p_map = {10.0 * i, 2.0, 2.0}});
    map.anchors.push_back({.id = 100 + i, .p_map = {2.0, 10.0 * i, 6.0}});
  }
  const Network network = networkOf(map);
  const Eigen::Vector3d p(3.0, 0.0, 1.0);
  std::vector<std::size_t> slow;
  for (std::size_t i = 0; i < map.anchors.size(); ++i) {
    if ((map.anchors[i].p_map - p).norm() <= 25.0 && network.inSight(p, map.anchors[i].p_map))
      slow.push_back(i);
  }
  EXPECT_EQ(network.visibleAnchors(p, 25.0), slow);
  EXPECT_EQ(slow.size(), 5U) << "-20, -10, 0, 10, 20 of the lower level";
}

TEST(Network, WithoutRoadwaysNothingIsHidden) {
  const Network network = networkOf({.name = "open"});
  EXPECT_FALSE(network.project({0, 0, 0}).has_value());
  EXPECT_TRUE(network.inSight({0, 0, 0}, {1000, 5, 5}));
  EXPECT_TRUE(network.isInside({1, 2, 3}));
}

TEST(Network, UnknownRoadwayIsNamedWithTheNearestOne) {
  const Network network = networkOf(bridge());
  EXPECT_EQ(network.indexOf("high"), 1U);
  try {
    (void)network.indexOf("higt");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.complaint().suggestion, "did you mean high?");
  }
}

}  // namespace pos::map
