#include "pos/eval/interval_figures.hpp"

#include <gtest/gtest.h>

#include "pos/core/angle.hpp"

namespace pos::eval {
namespace {

/// 300 m with one lane and chambers every 100 m; at 150 m a branch of 100 m leaves to the left.
IntervalScene scene() {
  auto mine = std::make_shared<map::TunnelMap>();
  mine->name = "test";
  map::Roadway main{.id = "main", .width = 5.0, .lanes = 1};
  main.centreline = {{{0.0, 0.0, 0.0}}, {{300.0, 0.0, 0.0}}};
  map::Roadway branch{.id = "branch", .width = 5.0, .lanes = 1};
  branch.centreline = {{{150.0, 0.0, 0.0}}, {{150.0, 100.0, 0.0}}};
  mine->roadways = {main, branch};
  mine->junctions = {{"J", "", {{"main", 150.0}, {"branch", 0.0}}}};
  for (const double at : {100.0, 200.0}) {
    map::Chamber chamber;
    chamber.id = "C" + std::to_string(static_cast<int>(at));
    chamber.place = {"main", at};
    chamber.length = 10.0;
    chamber.depth = 3.0;
    mine->chambers.push_back(chamber);
  }
  const map::Network network(mine);
  const map::RoadGraph graph(network);
  return {network, map::divided(graph, network, map::DivisionRules{})};
}

Pose3 poseAt(double x, double y, double yaw = 0.0) {
  return Pose3::fromPlanar({x, y, yaw});
}

/// Drives the main road at 2 m/s, one sample a second.
Truth drive() {
  Truth truth;
  for (int k = 0; k <= 145; ++k) truth.poses.push_back({stampFromSeconds(k), poseAt(5.0 + 2.0 * k, 0.0)});
  return truth;
}

/// What a tracker would say that is `behind` metres off.
IntervalRecord told(const IntervalScene& s, double behind) {
  IntervalRecord record;
  for (int k = 0; k <= 145; ++k) {
    const double chainage = std::max(0.0, 5.0 + 2.0 * k - behind);
    IntervalSample sample{
        .stamp = stampFromSeconds(k), .matched = true, .point = {0, chainage}, .along_sigma = 1.0};
    sample.named = map::intervalsAt(s.intervals, 0, chainage, map::Lane::Both);
    std::sort(sample.named.begin(), sample.named.end());
    record.samples.push_back(sample);
  }
  return record;
}

}  // namespace

TEST(IntervalFigures, PerfectAnswersAreAllRight) {
  const IntervalScene s = scene();
  const Truth truth = drive();
  const IntervalFigures f = intervalFigures(told(s, 0.0), s, &truth, {});
  EXPECT_EQ(f.judged, 146u);
  EXPECT_EQ(f.rightShare(), 1.0);
  EXPECT_EQ(f.rightShareClear(), 1.0);
  EXPECT_LT(f.judged_clear, f.judged);
  EXPECT_EQ(f.matched_share, 1.0);
}

TEST(IntervalFigures, AnswersThatLagAreWrongNearBoundariesOnly) {
  const IntervalScene s = scene();
  const Truth truth = drive();
  const IntervalFigures f = intervalFigures(told(s, 2.5), s, &truth, {});
  EXPECT_LT(*f.rightShare(), 1.0);
  EXPECT_GT(*f.rightShare(), 0.9);
  EXPECT_EQ(f.rightShareClear(), 1.0);  // 2.5 m are within 3 sigma of 1 m
  const IntervalFigures far = intervalFigures(told(s, 10.0), s, &truth, {});
  EXPECT_LT(*far.rightShareClear(), 1.0);
}

TEST(IntervalFigures, EntryTimesAreComparedWithTheTruthsOwn) {
  const IntervalScene s = scene();
  const Truth truth = drive();
  IntervalRecord record = told(s, 0.0);
  const auto second = map::intervalsAt(s.intervals, 0, 250.0, map::Lane::Both);
  ASSERT_FALSE(second.empty());
  // 200 m is passed at (200 - 5) / 2 = 97.5 s; it is told 2 s late.
  record.visits = {{.interval = second.front(), .entered = stampFromSeconds(99.5)}};
  const IntervalFigures f = intervalFigures(record, s, &truth, {});
  EXPECT_EQ(f.entries_matched, 1u);
  EXPECT_NEAR(*f.entryTimeRmse(), 2.0, 0.51);  // the truth is sampled once a second
  record.visits.front().entered = stampFromSeconds(30.0);
  EXPECT_EQ(intervalFigures(record, s, &truth, {}).entryTimeRmse(), std::nullopt);
}

TEST(IntervalFigures, WithoutTruthThereAreNoShares) {
  const IntervalScene s = scene();
  const IntervalFigures f = intervalFigures(told(s, 0.0), s, nullptr, {});
  EXPECT_EQ(f.judged, 0u);
  EXPECT_EQ(f.rightShare(), std::nullopt);
  EXPECT_EQ(f.rightShareClear(), std::nullopt);
}

TEST(TrueInterval, ThePlaceIsOnTheRoadwayWhoseCentrelineIsNearest) {
  const IntervalScene s = scene();
  const auto on_main = trueInterval(s, poseAt(120.0, 1.0), true);
  ASSERT_TRUE(on_main);
  EXPECT_EQ(on_main->roadway, 0u);
  EXPECT_NEAR(on_main->chainage, 120.0, 1e-9);
  const auto on_branch = trueInterval(s, poseAt(150.5, 60.0, 0.5 * kPi), true);
  ASSERT_TRUE(on_branch);
  EXPECT_EQ(on_branch->roadway, 1u);
  EXPECT_NEAR(on_branch->chainage, 60.0, 1e-9);
  EXPECT_NE(on_main->intervals, on_branch->intervals);
}

TEST(TrueInterval, NothingIsTrueInTheRock) {
  const IntervalScene s = scene();
  EXPECT_FALSE(trueInterval(s, poseAt(120.0, 30.0), true));
  EXPECT_FALSE(trueInterval(s, poseAt(-20.0, 0.0), true));
}

}  // namespace pos::eval
