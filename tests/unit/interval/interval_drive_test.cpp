/// Scenario B-E5 of spec A section 7 with few seeds; the campaign is tests/interval_campaign.

#include <gtest/gtest.h>

#include "support/drive_figures.hpp"

namespace pos::interval {
namespace {

using testing::Aiding;
using testing::DriveFigures;

constexpr std::uint64_t kSeeds = 8;

class IntervalDriveTest : public ::testing::Test {
 protected:
  testing::IntervalDrive scene{testing::intervalDemo()};
};

}  // namespace

TEST_F(IntervalDriveTest, WithChamberFixesTheErrorsKeepToTheBoundAndWithoutThemTheyGrow) {
  const DriveFigures alone = figuresOf(scene, Aiding::None, kSeeds);
  const DriveFigures chambers = figuresOf(scene, Aiding::Chambers, kSeeds);
  const DriveFigures both = figuresOf(scene, Aiding::ChambersAndRoad, kSeeds);
  testing::printHead();
  testing::print("none", alone);
  testing::print("chambers", chambers);
  testing::print("chambers + road", both);
  for (const DriveFigures* f : {&alone, &chambers, &both}) {
    EXPECT_GE(f->rightShare(), 0.999);
    EXPECT_LE(f->decided_past, 20.0);
    EXPECT_EQ(f->wrong_accepted, 0);
    EXPECT_EQ(f->trace_grew, 0);
  }
  for (const DriveFigures* f : {&chambers, &both}) {
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
