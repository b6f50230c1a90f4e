/// The lock safety campaign: a hundred thousand requests by twenty vehicles.

#include <gtest/gtest.h>

#include "support/lock_mine.hpp"
#include "support/traffic_figures.hpp"

namespace pos::interval {

TEST(LockCampaign, AHundredThousandRequestsByTwentyVehicles) {
  const testing::LockMine mine(testing::lockMine());
  const auto result =
      testing::LockTraffic(mine.locks.site(), mine.ways(), {.seed = 11, .vehicles = 20, .requests = 100000})
          .run();
  testing::print(result);
  testing::expectSafe(result);
  EXPECT_GE(result.tally.requests, 100000u);
  EXPECT_GE(testing::lockSuccess(result), 0.995);
}

}  // namespace pos::interval
