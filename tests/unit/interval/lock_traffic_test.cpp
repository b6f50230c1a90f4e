/// The short safety campaign; the long one is tests/interval_campaign.

#include "support/lock_traffic.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>

#include "support/lock_mine.hpp"

namespace pos::interval {
namespace {

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void expectSafe(const testing::TrafficResult& result) {
  EXPECT_EQ(result.opposing, 0u);
  EXPECT_EQ(result.deadlocks, 0u);
  for (std::size_t i = 0; i < std::min<std::size_t>(result.findings.size(), 5); ++i) {
    ADD_FAILURE() << i << ": " << secondsSinceOrigin(result.findings[i].stamp) << " s, vehicle "
                  << result.findings[i].vehicle << ": " << result.findings[i].what;
  }
  EXPECT_EQ(result.findings.size(), 0u);
  EXPECT_EQ(result.tally.trespasses, 0u);
}

void print(const testing::TrafficResult& r) {
  std::vector<double> waits = r.tally.waits;
  std::sort(waits.begin(), waits.end());
  std::printf(
      "requests %zu granted %zu at once %zu locks %zu doubts %zu stale %zu restarts %zu overrides %zu "
      "rejected %zu\n",
      r.tally.requests, r.tally.granted, r.tally.granted_at_once, r.tally.locks, r.tally.doubts,
      r.tally.stale, r.tally.restarts, r.tally.overrides, r.tally.rejected);
  std::printf("simulated %.0f s, ways %zu, driven %.0f km, wait mean %.1f s p95 %.1f s max %.1f s\n",
              r.simulated, r.ways_finished, r.driven / 1000.0, mean(waits), waits[waits.size() * 95 / 100],
              waits.back());
}

}  // namespace

TEST(LockTraffic, RandomTrafficNeverOpposesInOneBlockAndNeverJams) {
  const testing::LockMine mine(testing::lockMine());
  const std::vector<Way> ways = mine.ways();
  ASSERT_GE(ways.size(), 12u);
  for (const std::uint64_t seed : {1, 2}) {
    const auto result =
        testing::LockTraffic(mine.locks.site(), ways, {.seed = seed, .vehicles = 20, .requests = 1500}).run();
    expectSafe(result);
    EXPECT_GT(result.tally.doubts, 20u);
    EXPECT_GT(result.tally.stale, 20u);
    print(result);
  }
}

}  // namespace pos::interval
