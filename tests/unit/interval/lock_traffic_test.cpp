/// The short safety campaign; the long one is tests/interval_campaign.

#include <gtest/gtest.h>

#include "support/lock_mine.hpp"
#include "support/traffic_figures.hpp"

namespace pos::interval {

TEST(LockTraffic, RandomTrafficNeverOpposesInOneBlockAndNeverJams) {
  const testing::LockMine mine(testing::lockMine());
  const std::vector<Way> ways = mine.ways();
  ASSERT_GE(ways.size(), 12u);
  for (const std::uint64_t seed : {1U, 2U}) {
    const auto result =
        testing::LockTraffic(mine.locks.site(), ways, {.seed = seed, .vehicles = 20, .requests = 1500}).run();
    testing::print(result);
    testing::expectSafe(result);
    EXPECT_GT(result.tally.doubts, 20u);
    EXPECT_GT(result.tally.stale, 20u);
  }
}

TEST(LockTraffic, SameSeedSameTraffic) {
  const testing::LockMine mine(testing::lockMine());
  const testing::TrafficOptions options{.seed = 5, .vehicles = 8, .requests = 200};
  const auto a = testing::LockTraffic(mine.locks.site(), mine.ways(), options).run();
  const auto b = testing::LockTraffic(mine.locks.site(), mine.ways(), options).run();
  EXPECT_EQ(a.tally.waits, b.tally.waits);
  EXPECT_EQ(a.driven, b.driven);
}

}  // namespace pos::interval
