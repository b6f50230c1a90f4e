#include "pos/map/centreline.hpp"

#include <gtest/gtest.h>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"
#include "support/small_mine.hpp"

namespace pos::map {
namespace {

/// 10 m east, a quarter turn to the left of radius 5 m, 20 m north rising by 15 m (25 m in space).
Roadway hook() {
  Roadway roadway;
  roadway.id = "R";
  roadway.chainage_start = 100.0;
  roadway.centreline = {{.p_map = {0, 0, 0}},
                        {.p_map = {10, 0, 0}, .arc = kPi / 2},
                        {.p_map = {15, 5, 0}},
                        {.p_map = {15, 25, 15}}};
  return roadway;
}

}  // namespace

TEST(Centreline, LengthIsMeasuredInSpaceAlongLinesAndArcs) {
  const Centreline line(hook());
  EXPECT_DOUBLE_EQ(line.chainageStart(), 100.0);
  EXPECT_NEAR(line.length(), 10.0 + 2.5 * kPi + 25.0, 1e-12);
}

TEST(Centreline, StateInTheMiddleOfTheArcIsOnTheCircle) {
  const CentrelineState state = Centreline(hook()).at(110.0 + 1.25 * kPi);
  EXPECT_NEAR(state.p_map.x(), 10.0 + 5.0 * std::sin(kPi / 4), 1e-12);
  EXPECT_NEAR(state.p_map.y(), 5.0 - 5.0 * std::cos(kPi / 4), 1e-12);
  EXPECT_NEAR(state.heading, kPi / 4, 1e-12);
  EXPECT_NEAR(state.curvature, 0.2, 1e-12) << "a left turn is positive";
}

TEST(Centreline, RightTurnIsTheMirrorImage) {
  Roadway mirrored = hook();
  for (CentrelinePoint& point : mirrored.centreline) {
    point.p_map.y() *= -1.0;
    point.arc *= -1.0;
  }
  const Centreline left(hook());
  const Centreline right(mirrored);
  for (double c = 95.0; c < 150.0; c += 1.7) {
    const CentrelineState a = left.at(c);
    const CentrelineState b = right.at(c);
    EXPECT_LT((a.p_map - Eigen::Vector3d(b.p_map.x(), -b.p_map.y(), b.p_map.z())).norm(), 1e-12);
    EXPECT_NEAR(a.heading, -b.heading, 1e-12);
  }
}

TEST(Centreline, GradeAndHeightFollowTheSlope) {
  const CentrelineState state = Centreline(hook()).at(110.0 + 2.5 * kPi + 12.5);
  EXPECT_NEAR(state.p_map.z(), 7.5, 1e-12);
  EXPECT_NEAR(state.p_map.y(), 15.0, 1e-12);
  EXPECT_NEAR(std::tan(state.grade), 0.75, 1e-12);
}

TEST(Centreline, PastItsEndsItGoesOnStraight) {
  const Centreline line(hook());
  EXPECT_LT((line.at(96.0).p_map - Eigen::Vector3d(-4, 0, 0)).norm(), 1e-12);
  EXPECT_LT((line.at(line.chainageEnd() + 5.0).p_map - Eigen::Vector3d(15, 29, 18)).norm(), 1e-12);
}

TEST(Centreline, LeftOfTheWayIsPositive) {
  const Centreline::Foot foot = Centreline(hook()).foot({4.0, 1.5, 2.0});
  EXPECT_NEAR(foot.chainage, 104.0, 1e-12);
  EXPECT_NEAR(foot.offset, 1.5, 1e-12);
  EXPECT_NEAR(foot.height, 2.0, 1e-12);
  EXPECT_EQ(foot.beyond, 0.0);
}

TEST(Centreline, PointBehindTheStartIsBeyondIt) {
  const Centreline::Foot foot = Centreline(hook()).foot({-3.0, -1.0, 0.0});
  EXPECT_DOUBLE_EQ(foot.chainage, 100.0);
  EXPECT_NEAR(foot.beyond, 3.0, 1e-12);
  EXPECT_NEAR(foot.offset, -1.0, 1e-12);
}

TEST(Centreline, OutsideAKinkTheOffsetIsTheWholeDistance) {
  Roadway corner;
  corner.centreline = {{.p_map = {0, 0, 0}}, {.p_map = {10, 0, 0}}, {.p_map = {10, 10, 0}}};
  const Centreline::Foot foot = Centreline(corner).foot({13.0, -4.0, 0.0});
  EXPECT_DOUBLE_EQ(foot.chainage, 10.0);
  EXPECT_NEAR(foot.offset, -5.0, 1e-12);
  EXPECT_EQ(foot.beyond, 0.0);
}

/// Brute force: the centreline walked in steps of a millimetre.
TEST(Centreline, FootIsTheNearestOfAllPointsWalked) {
  RandomStream random(3, 0);
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Centreline line(test::randomMine(seed, 1, 6).roadways[0]);
    for (int i = 0; i < 25; ++i) {
      const CentrelineState near = line.at(random.uniform(line.chainageStart(), line.chainageEnd()));
      const Eigen::Vector3d p =
          near.p_map + Eigen::Vector3d(random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(0, 3));
      double nearest = 1e9;
      for (double c = line.chainageStart(); c <= line.chainageEnd(); c += 0.005) {
        nearest = std::min(nearest, (line.at(c).p_map - p).head<2>().norm());
      }
      const Centreline::Foot foot = line.foot(p);
      EXPECT_NEAR(std::hypot(foot.offset, foot.beyond), nearest, 1e-4);
      EXPECT_NEAR((line.at(foot.chainage).p_map - p).head<2>().norm(), nearest, 1e-4);
    }
  }
}

TEST(Centreline, ArcOfThreeQuartersIsWalkedTheLongWay) {
  Roadway loop;
  loop.centreline = {{.p_map = {0, 0, 0}, .arc = -1.5 * kPi}, {.p_map = {-5, -5, 0}}};
  const Centreline line(loop);
  EXPECT_NEAR(line.length(), 7.5 * kPi, 1e-12);
  const Centreline::Foot foot = line.foot({0.0, -11.0, 0.0});
  EXPECT_NEAR(foot.offset, 1.0, 1e-12) << "to the left of a right turn is outside";
  EXPECT_NEAR(foot.chainage, 5.0 * kPi, 1e-9);
}

TEST(Centreline, TwoPointsAtOnePlaceAreRefused) {
  Roadway roadway = hook();
  roadway.centreline[2].p_map = roadway.centreline[1].p_map;
  EXPECT_THROW(Centreline{roadway}, ConfigError);
}

}  // namespace pos::map
