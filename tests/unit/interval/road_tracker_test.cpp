#include "pos/interval/road_tracker.hpp"

#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "support/interval_drive.hpp"

namespace pos::interval {
namespace {

class RoadTrackerTest : public ::testing::Test {
 protected:
  Estimate at(double t, const Pose2& pose, double sigma = 0.5, double yaw_sigma = 0.01) const {
    const Matrix<3, 3> P = Vector<3>(sigma * sigma, sigma * sigma, yaw_sigma * yaw_sigma).asDiagonal();
    return planarEstimate(stampFromSeconds(t), pose, P);
  }
  /// Drives from `from` to `to` in steps of half a metre at 5 m/s, heading `yaw`.
  double drive(double t, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double yaw) {
    const auto steps = static_cast<int>((to - from).norm() / 0.5);
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector2d p = from + (to - from) * i / steps;
      road.take(at(t += 0.1, {p.x(), p.y(), yaw}));
    }
    return t;
  }
  testing::IntervalDrive scene{testing::intervalDemo()};
  RoadTracker road{scene.network, scene.graph, {}};
  const double fork = kPi / 3.0;
};

}  // namespace

TEST_F(RoadTrackerTest, FindsTheRoadAndTheDirection) {
  road.take(at(0.0, {100.0, -1.5, kPi}));
  ASSERT_EQ(road.state(), MatchState::Decided);
  const RoadHypothesis& on = *road.best();
  EXPECT_EQ(on.foot.roadway, 0u);
  EXPECT_NEAR(on.foot.chainage, 100.0, 1e-9);
  EXPECT_NEAR(std::abs(on.foot.offset), 1.5, 1e-9);
  EXPECT_TRUE(on.facing);
  EXPECT_NEAR(std::abs(on.foot.heading), kPi, 1e-9);
}

TEST_F(RoadTrackerTest, KeepsOneHypothesisForEachBranchAndTheirWeightsSumToOne) {
  drive(0.0, {100.0, 0.0}, {240.0, 0.0}, 0.0);
  EXPECT_EQ(road.hypotheses().size(), 2u);
  double sum = 0.0;
  for (const RoadHypothesis& h : road.hypotheses()) {
    sum += h.probability;
    EXPECT_NEAR(h.probability, 0.5, 1e-9);
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_EQ(road.state(), MatchState::Decided);  // before the fork both are on the main road
}

TEST_F(RoadTrackerTest, DecidesForTheBranchThatIsTaken) {
  double t = drive(0.0, {100.0, 0.0}, {250.0, 0.0}, 0.0);
  t = drive(t, {250.0, 0.0}, {250.0 + 10.0 * std::cos(fork), 10.0 * std::sin(fork)}, fork);
  EXPECT_EQ(road.state(), MatchState::Decided);
  EXPECT_EQ(road.best()->foot.roadway, 1u);
  EXPECT_NEAR(road.best()->foot.chainage, 10.0, 0.1);
}

TEST_F(RoadTrackerTest, StaysOpenWhileTheHeadingIsHalfWayBetweenTheBranches) {
  const double t = drive(0.0, {100.0, 0.0}, {250.0, 0.0}, 0.0);
  const Eigen::Vector2d between(2.0 * std::cos(0.5 * fork), 2.0 * std::sin(0.5 * fork));
  road.take(at(t + 0.4, {250.0 + between.x(), between.y(), 0.5 * fork}));
  EXPECT_EQ(road.state(), MatchState::Branching);
}

TEST_F(RoadTrackerTest, AVehicleThatReversesKeepsItsFacingAndItsRoad) {
  const double t = drive(0.0, {100.0, 0.0}, {260.0, 0.0}, 0.0);
  drive(t, {260.0, 0.0}, {200.0, 0.0}, 0.0);
  EXPECT_EQ(road.state(), MatchState::Decided);
  EXPECT_NEAR(road.best()->foot.chainage, 200.0, 1e-6);
  EXPECT_TRUE(road.best()->facing);
  EXPECT_NEAR(road.speed(), -5.0, 0.1);
}

TEST_F(RoadTrackerTest, BacksOutOfTheBranchIntoTheMainRoad) {
  const Eigen::Vector2d out(std::cos(fork), std::sin(fork));
  const Eigen::Vector2d node(250.0, 0.0);
  double t = drive(0.0, node + 60.0 * out, node, fork);  // nose outwards, moving back
  EXPECT_LT(road.speed(), -4.0);
  t = drive(t, {250.0, 0.0}, {215.0, 0.0}, 0.0);
  EXPECT_EQ(road.state(), MatchState::Decided);
  EXPECT_EQ(road.best()->foot.roadway, 0u);
  EXPECT_NEAR(road.best()->foot.chainage, 215.0, 0.1);
}

TEST_F(RoadTrackerTest, AChamberSeenOnABranchDecidesForIt) {
  const double t = drive(0.0, {100.0, 0.0}, {250.0, 0.0}, 0.0);
  const Eigen::Vector2d between(2.0 * std::cos(0.5 * fork), 2.0 * std::sin(0.5 * fork));
  road.take(at(t + 0.4, {250.0 + between.x(), between.y(), 0.5 * fork}));
  ASSERT_EQ(road.state(), MatchState::Branching);
  road.witness(1, 2.0, 0.3);
  EXPECT_EQ(road.state(), MatchState::Decided);
  EXPECT_EQ(road.best()->foot.roadway, 1u);
}

TEST_F(RoadTrackerTest, SaysItIsLostInRockAndFindsTheRoadAgain) {
  double t = drive(0.0, {100.0, 0.0}, {150.0, 0.0}, 0.0);
  bool lost = false;
  for (double y = 0.0; y < 40.0; y += 0.5) {
    road.take(at(t += 0.1, {150.0, y, 0.0}));
    lost = lost || road.state() == MatchState::Lost || road.state() == MatchState::Waiting;
  }
  EXPECT_TRUE(lost);
  drive(t, {160.0, 0.0}, {180.0, 0.0}, 0.0);
  EXPECT_EQ(road.state(), MatchState::Decided);
  EXPECT_NEAR(road.best()->foot.chainage, 180.0, 1e-6);
}

TEST_F(RoadTrackerTest, RefusesRulesThatMakeNoSense) {
  EXPECT_THROW(RoadTracker(scene.network, scene.graph, {.commit = 0.3}), ConfigError);
}

TEST_F(RoadTrackerTest, ThePathCoordinateOfAPlaceSurvivesLegsThatComeAndGo) {
  RoadPath path(scene.graph, {*scene.graph.edgeAt(0, 100.0), map::Direction::Forward});
  const double before = *path.distanceOf(0, 200.0);
  path.append({*scene.graph.edgeAt(1, 10.0), map::Direction::Forward});
  EXPECT_EQ(*path.distanceOf(0, 200.0), before);
  EXPECT_NEAR(*path.distanceOf(1, 30.0), before + 80.0, 1e-9);
  path.dropFirst();
  EXPECT_NEAR(*path.distanceOf(1, 30.0), before + 80.0, 1e-9);
  path.prepend({*scene.graph.edgeAt(0, 300.0), map::Direction::Backward});
  EXPECT_NEAR(*path.distanceOf(0, 260.0), before + 40.0, 1e-9);
}

}  // namespace pos::interval
