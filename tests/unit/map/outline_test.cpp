#include "pos/map/outline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/map_samples.hpp"

namespace pos::map {
namespace {

Roadway bend() {
  return samples::roadway("R",
                          {{.p_map = {0.0, 0.0, 0.0}},
                           {.p_map = {30.0, 0.0, -1.0}, .arc = kPi / 2.0},
                           {.p_map = {50.0, 20.0, -2.0}},
                           {.p_map = {50.0, 60.0, -2.0}}},
                          5.0);
}

TEST(Outline, ChordsStayWithinTheToleranceAtTheWall) {
  const Roadway roadway = bend();
  const Centreline line(roadway);
  const PlanLine wall =
      offsetLine(line, sampleChainages(line, line.chainageStart(), line.chainageEnd(), 0.01, 2.5), -2.5);
  double most = 0.0;
  for (std::size_t i = 0; i + 1 < wall.size(); ++i) {
    const Eigen::Vector2d middle = 0.5 * (wall[i] + wall[i + 1]);
    most = std::max(most, std::abs(line.foot({middle.x(), middle.y(), 0.0}).offset + 2.5));
  }
  EXPECT_LE(most, 0.01 + 1e-9);
  EXPECT_GE(most, 0.002);  // not many times finer than asked for
}

TEST(Outline, AStripHasTheAreaOfItsRoadway) {
  const Roadway roadway = bend();
  const Centreline line(roadway);
  const PlanLine polygon = strip(line, line.chainageStart(), line.chainageEnd(), 2.5, -2.5, 1e-4);
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  // An even strip around a smooth line: plan length times width.
  EXPECT_NEAR(std::abs(0.5 * twice), 5.0 * (30.0 + 10.0 * kPi + 40.0), 0.02);
}

TEST(Outline, WallsStayParallelAtAKink) {
  const Roadway roadway = samples::roadway(
      "R", {{.p_map = {0.0, 0.0, 0.0}}, {.p_map = {10.0, 0.0, 0.0}}, {.p_map = {10.0, 10.0, 0.0}}}, 4.0);
  const Centreline line(roadway);
  const PlanLine left = offsetLine(line, {0.0, 10.0, 20.0}, 2.0);
  EXPECT_NEAR((left[1] - Eigen::Vector2d(8.0, 2.0)).norm(), 0.0, 1e-12);
}

TEST(Outline, SamplesRunTheOtherWayToo) {
  const Centreline line(bend());
  const auto there = sampleChainages(line, 5.0, 50.0, 0.05);
  auto back = sampleChainages(line, 50.0, 5.0, 0.05);
  EXPECT_DOUBLE_EQ(back.front(), 50.0);
  std::reverse(back.begin(), back.end());
  EXPECT_EQ(there, back);
}

TEST(Outline, AChamberBeginsAtTheWallOfItsSide) {
  const Roadway roadway = bend();
  const Chamber chamber{.id = "C", .place = {"R", 10.0}, .side = Side::Right, .length = 6.0, .depth = 2.0};
  for (const Eigen::Vector2d& p : chamberOutline(roadway, Centreline(roadway), chamber, 0.01)) {
    EXPECT_TRUE(std::abs(p.y() + 2.5) < 1e-9 || std::abs(p.y() + 4.5) < 1e-9) << p.y();
    EXPECT_NEAR(std::abs(p.x() - 10.0), 3.0, 0.01);  // chainage is slope distance
  }
}

}  // namespace
}  // namespace pos::map
