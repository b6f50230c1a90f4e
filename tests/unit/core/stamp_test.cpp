#include "pos/core/stamp.hpp"

#include <gtest/gtest.h>

namespace pos {

TEST(Stamp, SecondsRoundTripThroughNanoseconds) {
  EXPECT_EQ(durationFromSeconds(1.25).count(), 1'250'000'000);
  EXPECT_DOUBLE_EQ(seconds(durationFromSeconds(-0.125)), -0.125);
  EXPECT_EQ(stampFromSeconds(2.0) - stampFromSeconds(0.5), durationFromSeconds(1.5));
}

}  // namespace pos
