#include "pos/core/stamp.hpp"

#include <gtest/gtest.h>

namespace pos {

TEST(Stamp, SecondsRoundTripThroughNanoseconds) {
  EXPECT_EQ(durationFromSeconds(1.25).count(), 1'250'000'000);
  EXPECT_DOUBLE_EQ(seconds(durationFromSeconds(-0.125)), -0.125);
  EXPECT_EQ(stampFromSeconds(2.0) - stampFromSeconds(0.5), durationFromSeconds(1.5));
}

TEST(Stamp, DurationIsRoundedToTheNearestNanosecond) {
  EXPECT_EQ(durationFromSeconds(0.6e-9).count(), 1);
  EXPECT_EQ(durationFromSeconds(-0.6e-9).count(), -1);
  EXPECT_EQ(durationFromSeconds(0.4e-9).count(), 0);
}

TEST(Stamp, PresentDayCalendarStampsKeepTheirNanoseconds) {
  const Stamp stamp{Duration{1'178'294'400'123'456'789}};
  EXPECT_EQ((stamp + Duration{1}) - stamp, Duration{1});
  EXPECT_NEAR(secondsSinceOrigin(stamp), 1178294400.123456789, 3e-7);
}

}  // namespace pos
