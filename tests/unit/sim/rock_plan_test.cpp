#include "pos/sim/rock_plan.hpp"

#include <gtest/gtest.h>

#include <set>

#include "pos/core/error.hpp"
#include "pos/core/random.hpp"
#include "sensor_scene.hpp"

namespace pos::sim {
namespace {

/// Spec A 3.2: the L-shaped roadway of the quarter turn.
const Outline kLShape{{0, 4}, {14, 4}, {14, -15}, {6, -15}, {6, -4}, {0, -4}};
const std::vector<Eigen::Vector3d> kAnchors{{0, 4, 0},   {14, 4, 0}, {14, -15, 0},
                                            {6, -15, 0}, {6, -4, 0}, {0, -4, 0}};

/// The view by looking at many points of it.
bool bruteForce(const Outline& open, const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  for (int i = 1; i < 4000; ++i) {
    if (!inside(open, (p + (q - p) * (i / 4000.0)).head<2>())) return false;
  }
  return true;
}

Eigen::Vector3d somewhere(const Outline& open, RandomStream& random) {
  for (;;) {
    const Eigen::Vector3d p(random.uniform(0.0, 14.0), random.uniform(-15.0, 4.0), 0.0);
    if (inside(open, p.head<2>())) return p;
  }
}

/// Numbers (from 1, as in the paper) of the anchors that a tag sees.
std::set<int> seenFrom(const RockPlan& plan, const Eigen::Vector3d& tag) {
  std::set<int> seen;
  for (std::size_t i = 0; i < kAnchors.size(); ++i) {
    if (plan.lineOfSight(tag, kAnchors[i])) seen.insert(static_cast<int>(i) + 1);
  }
  return seen;
}

Eigen::Vector3d tagAt(double t, double lateral) {
  const Kinematics k = scene::QuarterTurn().at(t);
  return k.p_map + k.R_map_body * Eigen::Vector3d(0.0, lateral, 0.0);
}

}  // namespace

TEST(RockPlan, AgreesWithLookingAtEveryPointOfTheView) {
  const RockPlan plan = RockPlan::around(kLShape);
  RandomStream random(3, 1);
  int blocked = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p = somewhere(kLShape, random);
    const Eigen::Vector3d q = somewhere(kLShape, random);
    const bool clear = plan.lineOfSight(p, q);
    EXPECT_EQ(clear, bruteForce(kLShape, p, q)) << p.transpose() << " to " << q.transpose();
    EXPECT_EQ(clear, plan.lineOfSight(q, p));
    blocked += clear ? 0 : 1;
  }
  EXPECT_GT(blocked, 20);
  EXPECT_LT(blocked, 480);
}

TEST(RockPlan, AnchorsOnTheWallSeeOutOfIt) {
  const RockPlan plan = RockPlan::around(kLShape);
  EXPECT_TRUE(plan.lineOfSight({6, -4, 0}, {3, 0, 0}));
  EXPECT_TRUE(plan.lineOfSight({6, -4, 0}, {10, -12, 0}));
  EXPECT_FALSE(plan.lineOfSight({6, -15, 0}, {2, 0, 0}));
  EXPECT_TRUE(plan.lineOfSight({6, -15, 0}, {6, -4, 0}));  // along the wall
}

TEST(RockPlan, ViewThroughTheJointOfTwoWallsIsBlocked) {
  const RockPlan plan({{.a = {0, -1}, .b = {0, 0}}, {.a = {0, 0}, .b = {0, 1}}});
  EXPECT_FALSE(plan.lineOfSight({-1, 0, 0}, {1, 0, 0}));
}

TEST(RockPlan, ViewOverAWallIsFree) {
  const RockPlan plan({{.a = {0, -1}, .b = {0, 1}, .z_low = 0.0, .z_high = 2.0}});
  EXPECT_FALSE(plan.lineOfSight({-1, 0, 1}, {1, 0, 1}));
  EXPECT_TRUE(plan.lineOfSight({-1, 0, 2.5}, {1, 0, 2.5}));
  EXPECT_FALSE(plan.lineOfSight({-1, 0, 1}, {1, 0, 2.9}));  // 1.95 m at the wall
  EXPECT_TRUE(plan.lineOfSight({-1, 0, 1}, {1, 0, 3.1}));   // 2.05 m at the wall
}

TEST(RockPlan, PillarOfALoopHidesItsFarSide) {
  const RockPlan loop = RockPlan::around({{0, 0}, {12, 0}, {12, 7}, {0, 7}})
                            .joined(RockPlan::around({{2.2, 2.2}, {9.8, 2.2}, {9.8, 4.8}, {2.2, 4.8}}));
  EXPECT_FALSE(loop.lineOfSight({6, 1, 0}, {6, 6, 0}));
  EXPECT_TRUE(loop.lineOfSight({1, 1, 0}, {11, 1, 0}));
  EXPECT_TRUE(loop.lineOfSight({1, 1, 0}, {1, 6, 0}));
  EXPECT_TRUE(loop.predicate()({1, 1, 0}, {11, 1, 0}));
}

// Spec A 3.2: anchors 3 and 4 are hidden at the start; never fewer than four are seen.
TEST(RockPlan, QuarterTurnSeesAtLeastFourAnchorsAllAlong) {
  const RockPlan plan = RockPlan::around(kLShape);
  EXPECT_NEAR(scene::QuarterTurn().at(20.0).p_map.x(), 7.0, 1e-3);
  EXPECT_NEAR(scene::QuarterTurn().at(35.0).p_map.y(), -12.42, 0.01);
  EXPECT_EQ(seenFrom(plan, tagAt(0.0, 0.375)), (std::set<int>{1, 2, 5, 6}));
  EXPECT_EQ(seenFrom(plan, tagAt(0.0, -0.375)), (std::set<int>{1, 2, 5, 6}));
  std::size_t fewest = 6;
  std::size_t most = 0;
  for (int i = 0; i <= 3500; ++i) {
    for (const double lateral : {0.375, -0.375}) {
      const std::size_t seen = seenFrom(plan, tagAt(0.01 * i, lateral)).size();
      fewest = std::min(fewest, seen);
      most = std::max(most, seen);
    }
  }
  for (const double t : {19.5, 22.0, 25.5}) EXPECT_EQ(seenFrom(plan, tagAt(t, 0.375)).size(), 6U) << t;
  EXPECT_EQ(fewest, 4U);
  EXPECT_EQ(most, 6U);
  EXPECT_EQ(seenFrom(plan, tagAt(35.0, 0.375)), (std::set<int>{2, 3, 4, 5}));
}

TEST(Zone, HoldsInItsTimeAndPlaceAndRunsAlongItsRamp) {
  const Zone zone{.time = TimeSpan{10.0, 20.0},
                  .place = {{11, -2}, {27, -2}, {27, 2}, {11, 2}},
                  .ramp_from = Eigen::Vector2d(11, 0),
                  .ramp_to = Eigen::Vector2d(27, 0)};
  EXPECT_TRUE(zone.contains(10.0, {15, 0}));
  EXPECT_FALSE(zone.contains(20.0, {15, 0}));
  EXPECT_FALSE(zone.contains(15.0, {10, 0}));
  EXPECT_DOUBLE_EQ(zone.progress(15.0, {19, 1}), 0.5);
  EXPECT_DOUBLE_EQ(zone.progress(15.0, {40, 1}), 1.0);
  EXPECT_DOUBLE_EQ((Zone{.time = TimeSpan{10.0, 20.0}}.progress(12.5, {0, 0})), 0.25);
  EXPECT_NEAR((SigmaRamp{0.02, 1.0}.at(0.5)), std::sqrt(0.02), 1e-15);
  EXPECT_EQ((SigmaRamp{0.0, 0.0}.at(0.5)), 0.0);
}

TEST(Zone, RefusesHalfARampAndAnOutlineOfTwoPoints) {
  EXPECT_THROW((void)validated(Zone{.ramp_from = Eigen::Vector2d(0, 0)}, "z"), ConfigError);
  EXPECT_THROW((void)validated(Zone{.place = {{0, 0}, {1, 1}}}, "z"), ConfigError);
  EXPECT_THROW((void)validated(Zone{.time = TimeSpan{3.0, 2.0}}, "z"), ConfigError);
}

}  // namespace pos::sim
