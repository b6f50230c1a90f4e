#include "pos/estimation/mode_watch.hpp"

#include <gtest/gtest.h>

namespace pos::estimation {
namespace {

Stamp at(double t) {
  return stampFromSeconds(t);
}

ModeWatch steady(double period, int epochs) {
  ModeWatch watch({.overdue = 0.005, .rejected_in_a_row = 3});
  for (int i = 0; i < epochs; ++i) (void)watch.applied(at(i * period));
  return watch;
}

}  // namespace

TEST(ModeWatch, JoinsByItsFirstGoodReading) {
  ModeWatch watch({});
  EXPECT_FALSE(watch.usable());
  EXPECT_FALSE(watch.rejected(at(1.0)));
  EXPECT_TRUE(watch.applied(at(1.1)));
  EXPECT_FALSE(watch.applied(at(1.2)));
  EXPECT_TRUE(watch.usable());
  EXPECT_EQ(watch.since(), at(1.1));
}

TEST(ModeWatch, LeavesWhenTheNextReadingIsOverdueAndTellsWhenItWasDue) {
  for (const double period : {0.02, 0.05, 0.1}) {
    ModeWatch watch = steady(period, 6);
    const double due = 6 * period;
    EXPECT_FALSE(watch.advanced(at(due + 0.004))) << period;
    EXPECT_TRUE(watch.advanced(at(due + 0.006))) << period;
    EXPECT_EQ(watch.since(), at(due));
    EXPECT_FALSE(watch.usable());
  }
}

TEST(ModeWatch, ASlowSensorIsNotCalledSilentBetweenItsReadings) {
  ModeWatch watch = steady(1.0, 5);
  EXPECT_FALSE(watch.advanced(at(4.9)));
}

TEST(ModeWatch, ReadingsThatAreAllRejectedEndIt) {
  ModeWatch watch = steady(0.1, 5);
  EXPECT_FALSE(watch.rejected(at(0.5)));
  EXPECT_FALSE(watch.rejected(at(0.6)));
  EXPECT_TRUE(watch.rejected(at(0.7)));
  EXPECT_EQ(watch.since(), at(0.5));
}

TEST(ModeWatch, OneGoodReadingAmongThemKeepsIt) {
  ModeWatch watch = steady(0.1, 5);
  for (int i = 0; i < 4; ++i) {
    EXPECT_FALSE(watch.rejected(at(0.5 + 0.3 * i)));
    EXPECT_FALSE(watch.rejected(at(0.6 + 0.3 * i)));
    EXPECT_FALSE(watch.applied(at(0.7 + 0.3 * i)));
  }
  EXPECT_TRUE(watch.usable());
}

TEST(ModeWatch, AGapIsNotLearntAsAPeriod) {
  ModeWatch watch = steady(0.1, 5);
  EXPECT_TRUE(watch.advanced(at(0.6)));
  EXPECT_TRUE(watch.applied(at(1.5)));
  EXPECT_FALSE(watch.applied(at(1.6)));
  EXPECT_TRUE(watch.advanced(at(1.71)));
}

}  // namespace pos::estimation
