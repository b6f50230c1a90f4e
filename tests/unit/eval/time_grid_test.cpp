#include "pos/eval/time_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pos::eval {
namespace {

TimeGrid grid() {
  return {.origin = stampFromSeconds(100.0), .step = durationFromSeconds(0.5), .count = 4};
}

ErrorSample sampleAt(double t, double xy) {
  ErrorSample sample;
  sample.stamp = stampFromSeconds(t);
  sample.xy = xy;
  return sample;
}

TEST(TimeGrid, AStampBelongsToTheNearestMoment) {
  EXPECT_EQ(grid().indexOf(stampFromSeconds(99.75)), 0U);
  EXPECT_EQ(grid().indexOf(stampFromSeconds(100.0)), 0U);
  EXPECT_EQ(grid().indexOf(stampFromSeconds(100.24)), 0U);
  EXPECT_EQ(grid().indexOf(stampFromSeconds(100.26)), 1U);
  EXPECT_EQ(grid().indexOf(stampFromSeconds(101.7)), 3U);
}

TEST(TimeGrid, StampsBeyondTheEndsBelongToNone) {
  EXPECT_FALSE(grid().indexOf(stampFromSeconds(99.7)));
  EXPECT_FALSE(grid().indexOf(stampFromSeconds(101.76)));
  EXPECT_FALSE(grid().indexOf(stampFromSeconds(-1e9)));
}

TEST(GridCells, TheNearestSampleWinsAndEmptyMomentsSayNothing) {
  const auto cells = gridCells(
      {sampleAt(99.9, 7.0), sampleAt(100.05, 3.0), sampleAt(100.2, 8.0), sampleAt(101.4, 2.0)}, grid());
  ASSERT_EQ(cells.size(), 4U);
  EXPECT_DOUBLE_EQ(cells[0].squared_xy, 9.0);
  EXPECT_TRUE(std::isnan(cells[1].squared_xy));
  EXPECT_TRUE(std::isnan(cells[2].squared_xy));
  EXPECT_DOUBLE_EQ(cells[3].squared_xy, 4.0);
  EXPECT_TRUE(std::isnan(cells[0].nees_xy));
}

TEST(GridCells, NeesComesWithTheSampleThatHasIt) {
  ErrorSample sample = sampleAt(100.5, 1.0);
  sample.nees_xy = 1.5;
  sample.nees_pose = 2.5;
  const auto cells = gridCells({sample}, grid());
  EXPECT_DOUBLE_EQ(cells[1].nees_xy, 1.5);
  EXPECT_DOUBLE_EQ(cells[1].nees_pose, 2.5);
}

TEST(NisGrid, SumsAppliedReadingsOfAStep) {
  NisGrid nis(grid());
  nis.add(stampFromSeconds(100.4), {.verdict = Verdict::Applied, .dof = 1, .nis = 0.5});
  nis.add(stampFromSeconds(100.6), {.verdict = Verdict::Applied, .dof = 2, .nis = 3.0});
  nis.add(stampFromSeconds(100.5), {.verdict = Verdict::Gated, .dof = 1, .nis = 50.0});
  nis.add(stampFromSeconds(100.5), {.verdict = Verdict::Applied, .dof = 0, .nis = 9.0});
  nis.add(stampFromSeconds(500.0), {.verdict = Verdict::Applied, .dof = 1, .nis = 9.0});
  const auto cells = nis.into(gridCells({}, grid()));
  EXPECT_DOUBLE_EQ(cells[1].nis, 3.5);
  EXPECT_DOUBLE_EQ(cells[1].nis_dof, 3.0);
  EXPECT_DOUBLE_EQ(cells[0].nis, 0.0);
}

}  // namespace
}  // namespace pos::eval
