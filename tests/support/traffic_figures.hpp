#pragma once
/// What a run of random traffic has to show, and its figures as a table.

#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>

#include "pos/traffic/lock_traffic.hpp"

namespace pos::testing {

inline void expectSafe(const traffic::TrafficResult& r) {
  EXPECT_EQ(r.opposing, 0u);
  EXPECT_EQ(r.deadlocks, 0u) << r.jam;
  for (std::size_t i = 0; i < std::min<std::size_t>(r.findings.size(), 5); ++i) {
    ADD_FAILURE() << secondsSinceOrigin(r.findings[i].stamp) << " s, vehicle " << r.findings[i].vehicle
                  << ": " << r.findings[i].what;
  }
  EXPECT_EQ(r.findings.size(), 0u);
  // Nobody trespasses; a report that is off by more than its sigma admits can look like it, which locks more
  // road for a while. One in a hundred thousand events is the most that the simulated jumps of few sigmas
  // explain.
  EXPECT_LE(static_cast<double>(r.tally.trespasses), 1.0 + 1e-5 * static_cast<double>(r.tally.events));
}

inline void print(const traffic::TrafficResult& r) {
  std::vector<double> waits = r.tally.waits;
  std::sort(waits.begin(), waits.end());
  const double mean = std::accumulate(waits.begin(), waits.end(), 0.0) / static_cast<double>(waits.size());
  std::printf("requests %zu, granted %zu (at once %.1f %%), locks %zu, without finding %.3f %%\n",
              r.tally.requests, r.tally.granted,
              100.0 * static_cast<double>(r.tally.granted_at_once) / static_cast<double>(r.tally.granted),
              r.tally.locks, 100.0 * r.lockSuccess());
  std::printf("opposing seconds %zu, deadlocks %zu, findings %zu, trespasses %zu\n", r.opposing, r.deadlocks,
              r.findings.size(), r.tally.trespasses);
  std::printf("waiting: mean %.1f s, median %.1f s, 95 %% %.1f s, longest %.0f s\n", mean,
              waits[waits.size() / 2], waits[waits.size() * 95 / 100], waits.back());
  std::printf("faults met: %zu doubts, %zu silences, %zu restarts, %zu overrides, %zu rejected events\n",
              r.tally.doubts, r.tally.stale, r.tally.restarts, r.tally.overrides, r.tally.rejected);
  std::printf("simulated %.1f h, %zu ways finished, %.0f km driven, %zu events\n", r.simulated / 3600.0,
              r.ways_finished, r.driven / 1000.0, r.tally.events);
}

}  // namespace pos::testing
