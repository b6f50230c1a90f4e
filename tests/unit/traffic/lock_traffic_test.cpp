/// The short safety campaign; the long one is tests/interval_campaign.

#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "support/lock_mine.hpp"
#include "support/traffic_figures.hpp"

namespace pos::traffic {

TEST(LockTraffic, RandomTrafficNeverOpposesInOneBlockAndNeverJams) {
  const testing::LockMine mine(testing::lockMine());
  const std::vector<interval::Way> ways = mine.ways();
  ASSERT_GE(ways.size(), 12u);
  for (const std::uint64_t seed : {1U, 2U}) {
    const auto result =
        runTraffic(mine.locks.site(), ways, {}, {.seed = seed, .vehicles = 20, .requests = 1500});
    testing::print(result);
    testing::expectSafe(result);
    EXPECT_GT(result.tally.doubts, 20u);
    EXPECT_GT(result.tally.stale, 20u);
  }
}

TEST(LockTraffic, SameSeedSameTraffic) {
  const testing::LockMine mine(testing::lockMine());
  const TrafficOptions options{.seed = 5, .vehicles = 8, .requests = 200};
  const auto a = runTraffic(mine.locks.site(), mine.ways(), {}, options);
  const auto b = runTraffic(mine.locks.site(), mine.ways(), {}, options);
  EXPECT_EQ(a.tally.waits, b.tally.waits);
  EXPECT_EQ(a.driven, b.driven);
}

TEST(LockTraffic, TheWatchSeesWhatTheAuditSees) {
  const testing::LockMine mine(testing::lockMine());
  const TrafficOptions options{.seed = 5, .vehicles = 4, .requests = 60};
  interval::LockAudit again(mine.locks.site(), {});
  std::size_t seconds = 0;
  double furthest = 0.0;
  const auto result =
      runTraffic(mine.locks.site(), mine.ways(), {}, options,
                 {.event = [&](const auto& event, const auto& records) { again.take(event, records); },
                  .places =
                      [&](double, const std::vector<TruePlace>& places) {
                        ++seconds;
                        for (const TruePlace& p : places) furthest = std::max(furthest, p.distance);
                      }});
  EXPECT_EQ(again.tally().events, result.tally.events);
  EXPECT_EQ(again.tally().waits, result.tally.waits);
  EXPECT_EQ(static_cast<double>(seconds), result.simulated);
  EXPECT_GT(furthest, 1000.0);
}

TEST(LockTraffic, OptionsThatMakeNoSenseAreRefused) {
  EXPECT_THROW(validated(TrafficOptions{.vehicles = 0}), ConfigError);
  EXPECT_THROW(validated(TrafficOptions{.jump_per_s = -0.1}), ConfigError);
  EXPECT_THROW(validated(TrafficOptions{.restart_per_s = 1.5}), ConfigError);
  EXPECT_THROW(validated(TrafficOptions{.stuck_after = 0.0}), ConfigError);
  EXPECT_NO_THROW(validated(TrafficOptions{}));
}

TEST(LockTraffic, WaysWithoutAWayBackAreRefused) {
  const testing::LockMine mine(testing::lockMine());
  EXPECT_THROW(runTraffic(mine.locks.site(), {mine.ways().front()}, {}, {}), DataError);
  EXPECT_THROW(runTraffic(mine.locks.site(), {}, {}, {}), DataError);
}

}  // namespace pos::traffic
