#include "pos/sim/sensor_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "unit/sim/refusals.hpp"

namespace pos::sim {

TEST(SensorClocks, MomentsAreExactAfterHours) {
  SensorClock clock({.rate = 100.0, .phase = 0.25}, {}, Stamp{} + durationFromSeconds(1e9));
  SensorClock::Tick tick;
  for (int i = 0; i <= 1000000; ++i) tick = clock.next();
  EXPECT_DOUBLE_EQ(tick.t, 10000.25);
  EXPECT_EQ(tick.stamp, Stamp{} + durationFromSeconds(1e9) + durationFromSeconds(10000.25));
}

TEST(SensorClocks, LatencyAndItsJitterHaveTheirFiguresAndArrivalsDoNotOvertake) {
  SensorClock clock({.rate = 1.0, .latency = 0.2, .jitter_sigma = 0.03}, {.seed = 4, .stream = 9}, Stamp{});
  double mean = 0.0;
  double variance = 0.0;
  Stamp last = Stamp::min();
  constexpr int kCount = 10000;
  for (int i = 0; i < kCount; ++i) {
    const auto tick = clock.next();
    const double delay = seconds(tick.arrival - tick.stamp);
    mean += delay / kCount;
    variance += (delay - 0.2) * (delay - 0.2) / kCount;
    EXPECT_GE(tick.arrival, last);
    EXPECT_GE(delay, 0.0);
    last = tick.arrival;
  }
  EXPECT_NEAR(mean, 0.2, 4.0 * 0.03 / std::sqrt(kCount));
  EXPECT_NEAR(std::sqrt(variance) / 0.03, 1.0, 4.0 / std::sqrt(2.0 * kCount));
}

TEST(SensorClocks, FastSensorsWithJitterStillArriveInOrder) {
  SensorClock clock({.rate = 1000.0, .latency = 0.001, .jitter_sigma = 0.005}, {}, Stamp{});
  Stamp last = Stamp::min();
  for (int i = 0; i < 2000; ++i) {
    const auto tick = clock.next();
    EXPECT_GE(tick.arrival, last);
    EXPECT_GE(tick.arrival, tick.stamp);
    last = tick.arrival;
  }
}

TEST(SensorClocks, LossesHaveTheirRateAndOutagesLoseAll) {
  SensorClock clock({.rate = 10.0, .loss_probability = 0.2, .outages = {{100.0, 110.0}}}, {.seed = 2},
                    Stamp{});
  int lost = 0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const auto tick = clock.next();
    const bool out = tick.t >= 100.0 && tick.t < 110.0;
    EXPECT_TRUE(tick.lost || !out);
    if (!out && tick.lost) ++lost;
  }
  EXPECT_NEAR(lost / (kCount - 100.0), 0.2, 4.0 * std::sqrt(0.2 * 0.8 / kCount));
}

TEST(SensorClocks, AnOffsetMovesStampsOnly) {
  SensorClock clock({.stamp_offset = 0.05}, {}, Stamp{});
  const auto tick = clock.next();
  EXPECT_EQ(tick.stamp, stampFromSeconds(0.05));
  EXPECT_EQ(tick.arrival, Stamp{});
}

TEST(SensorSeeds, LabelsAndPurposesGetSequencesOfTheirOwn) {
  std::set<std::uint32_t> firsts;
  for (const char* label : {"imu", "wheels", "uwb", "uwb2", "gnss"}) {
    const SensorSeed seed{1, streamOf(label)};
    for (const Purpose purpose : {Purpose::Timing, Purpose::Constants, Purpose::Noise, Purpose::Drift,
                                  Purpose::Faults, Purpose::Extra}) {
      for (unsigned part = 0; part < 8; ++part) firsts.insert(seed.sequence(purpose, part).bits());
    }
  }
  EXPECT_EQ(firsts.size(), 5U * 6U * 8U);
}

TEST(SensorClocks, RefusalsNameTheKey) {
  const auto refused = [](const SensorTiming& timing) {
    return refusedKey([&] { return validated(timing); });
  };
  EXPECT_EQ(refused({.rate = -1}), "rate");
  EXPECT_EQ(refused({.phase = -1}), "phase");
  EXPECT_EQ(refused({.loss_probability = 1.5}), "loss_probability");
  EXPECT_EQ(refused({.outages = {{2, 1}}}), "outages[0]");
}

}  // namespace pos::sim
