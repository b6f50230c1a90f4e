/// Scenario B-E5 of spec A section 7 with a hundred seeds, each into the branch and past it.

#include <gtest/gtest.h>

#include "support/drive_figures.hpp"

namespace pos::interval {

TEST(DriveCampaign, HundredSeedsOfTheIntervalDemo) {
  using testing::Aiding;
  const testing::IntervalDrive scene(testing::intervalDemo());
  const auto alone = figuresOf(scene, Aiding::None, 100);
  const auto chambers = figuresOf(scene, Aiding::Chambers, 100);
  const auto both = figuresOf(scene, Aiding::ChambersAndRoad, 100);
  testing::printHead();
  testing::print("none", alone);
  testing::print("chambers", chambers);
  testing::print("chambers + road", both);
  for (const auto* f : {&alone, &chambers, &both}) {
    EXPECT_GE(f->rightShare(), 0.999);
    EXPECT_LE(f->decided_past, 20.0);
    EXPECT_EQ(f->wrong_accepted, 0);
    EXPECT_EQ(f->trace_grew, 0);
  }
  for (const auto* f : {&chambers, &both}) {
    EXPECT_GT(f->wrong_told, 0);
    EXPECT_LE(f->along_over_bound, 1.2);
    EXPECT_LE(f->across_over_bound, 1.2);
    EXPECT_LE(f->along_sigma_over_bound, 1.2);
    EXPECT_LT(f->rms_late, 0.5 * alone.rms_late);
  }
  // A chamber fixes no heading, which the bound takes as new at every chamber: the road's heading is needed
  // for the sigma across (docs/math/intervals.md).
  EXPECT_LE(both.across_sigma_over_bound, 1.2);
  EXPECT_GT(alone.rms_late, 4.0 * alone.rms_early);
}

}  // namespace pos::interval
