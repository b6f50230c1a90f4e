#include "pos/io/range_faults.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pos::io {
namespace {

Measurement rangeOf(double metres) {
  BeaconRange range;
  range.range = metres;
  return {Stamp{}, "uwb", range};
}

double spoilt(RangeFaults& faults, double metres) {
  return std::get<BeaconRange>(faults.applied(rangeOf(metres)).reading).range;
}

}  // namespace

TEST(RangeFaults, ZeroProbabilityChangesNothing) {
  RangeFaults faults({});
  for (int i = 0; i < 100; ++i) EXPECT_EQ(spoilt(faults, 10.0), 10.0);
  EXPECT_EQ(faults.count(), 0U);
}

TEST(RangeFaults, TheShareSignAndSizeAreAsAskedFor) {
  RangeFaults faults({.probability = 0.2, .min = 3.0, .max = 20.0, .seed = 4});
  constexpr int kRanges = 20000;
  int longer = 0;
  for (int i = 0; i < kRanges; ++i) {
    const double error = spoilt(faults, 50.0) - 50.0;
    if (error == 0.0) continue;
    EXPECT_GE(std::abs(error), 3.0);
    EXPECT_LE(std::abs(error), 20.0);
    longer += error > 0.0 ? 1 : 0;
  }
  // Two-sided bounds at four standard deviations of the binomial counts.
  EXPECT_NEAR(static_cast<double>(faults.count()), 4000.0, 4.0 * std::sqrt(kRanges * 0.2 * 0.8));
  EXPECT_NEAR(longer, 2000.0, 4.0 * std::sqrt(4000.0 * 0.25));
}

TEST(RangeFaults, ASpoiltRangeStaysPositive) {
  RangeFaults faults({.probability = 1.0, .min = 3.0, .max = 20.0, .seed = 4});
  for (int i = 0; i < 200; ++i) EXPECT_GE(spoilt(faults, 1.0), 0.05);
}

TEST(RangeFaults, OtherReadingsPassUntouchedAndDoNotShiftTheSequence) {
  RangeFaults with({.probability = 0.5, .seed = 9});
  RangeFaults without({.probability = 0.5, .seed = 9});
  for (int i = 0; i < 50; ++i) {
    (void)with.applied({Stamp{}, "ticks", WheelTicks{}});
    EXPECT_EQ(spoilt(with, 50.0), spoilt(without, 50.0));
  }
}

}  // namespace pos::io
