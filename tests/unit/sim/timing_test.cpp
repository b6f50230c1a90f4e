#include "pos/sim/timing.hpp"

#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "sensor_scene.hpp"

namespace pos::sim {
namespace {

using scene::meanOf;

std::vector<Tick> ticks(const Timing& timing, double duration, std::uint64_t seed = 1) {
  Ticker ticker(timing, {.seed = seed}, duration);
  std::vector<Tick> all;
  while (const std::optional<Tick> tick = ticker.next()) all.push_back(*tick);
  return all;
}

}  // namespace

TEST(Ticker, TicksAtItsRateFromItsPhaseToTheEndWithoutDrift) {
  const std::vector<Tick> all = ticks({.rate = 3.0, .phase = 0.1}, 1000.1);
  ASSERT_EQ(all.size(), 3001U);
  EXPECT_DOUBLE_EQ(all.front().t, 0.1);
  EXPECT_NEAR(all.back().t, 1000.1, 1e-9);
  EXPECT_EQ(all.back().index, 3000);
}

TEST(Ticker, TicksAreWholeNanoseconds) {
  for (const Tick& tick : ticks({.rate = 7.0}, 10.0)) {
    EXPECT_EQ(tick.t, seconds(durationFromSeconds(tick.t)));
  }
}

TEST(Ticker, OutagesLoseTheirTicksAndShiftNoOthers) {
  const Timing plain{.rate = 10.0, .jitter = 0.01, .drop_probability = 0.2};
  Timing interrupted = plain;
  interrupted.outages = {{2.0, 3.0}, {5.0, 5.5}};
  const std::vector<Tick> a = ticks(plain, 10.0);
  const std::vector<Tick> b = ticks(interrupted, 10.0);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].t, b[i].t);
    const bool out = (b[i].t >= 2.0 && b[i].t < 3.0) || (b[i].t >= 5.0 && b[i].t < 5.5);
    EXPECT_EQ(b[i].lost, out || a[i].lost);
  }
}

TEST(Ticker, DropsTheGivenShare) {
  const std::vector<Tick> all = ticks({.rate = 100.0, .drop_probability = 0.3}, 500.0);
  const auto lost = std::count_if(all.begin(), all.end(), [](const Tick& tick) { return tick.lost; });
  EXPECT_NEAR(static_cast<double>(lost) / static_cast<double>(all.size()), 0.3,
              scene::rateBand(0.3, all.size()));
}

TEST(Ticker, JitterSpreadsMomentsButKeepsTheirOrder) {
  const std::vector<Tick> all = ticks({.rate = 100.0, .jitter = 0.001}, 200.0);
  std::vector<double> off;
  for (const Tick& tick : all) off.push_back(tick.t - static_cast<double>(tick.index) / 100.0);
  off.erase(off.begin());  // the first cannot be before 0
  EXPECT_NEAR(meanOf(off), 0.0, scene::meanBand(0.001, off.size()));
  EXPECT_NEAR(scene::sigmaOf(off), 0.001, scene::sigmaBand(0.001, off.size()));
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_GT(all[i].t, all[i - 1].t);
}

TEST(Ticker, StampsTheMomentAndDeliversAfterTheLatencyInOrder) {
  const RunSetup run{.start = stampFromSeconds(1000.0), .seed = 4};
  Ticker ticker({.rate = 10.0, .latency = 0.2, .latency_jitter = 0.3, .stamp_error = 0.05}, run, 100.0);
  Stamp last = Stamp::min();
  std::vector<double> extra;
  while (const std::optional<Tick> tick = ticker.next()) {
    const Delivery delivery = ticker.sent(tick->t, "s", WheelSpeeds{});
    EXPECT_EQ(delivery.measurement.stamp, run.start + durationFromSeconds(tick->t + 0.05));
    EXPECT_GE(delivery.arrival, last);
    EXPECT_GE(delivery.arrival, run.start + durationFromSeconds(tick->t + 0.2));
    last = delivery.arrival;
    extra.push_back(seconds(delivery.arrival - run.start) - tick->t - 0.2);
  }
  // |normal| has mean 0.8 sigma; waiting behind others makes it longer, never shorter.
  EXPECT_GT(meanOf(extra), 0.8 * 0.3 - scene::meanBand(0.6 * 0.3, extra.size()));
}

TEST(Ticker, RandomNumbersOfSensorsPurposesAndSeedsDiffer) {
  const RunSetup run{.seed = 5};
  const double first = randomStream(run, {.stream = 1}, 8).uniform();
  EXPECT_EQ(first, randomStream(run, {.stream = 1}, 8).uniform());
  EXPECT_NE(first, randomStream(run, {.stream = 2}, 8).uniform());
  EXPECT_NE(first, randomStream(run, {.stream = 1}, 9).uniform());
  EXPECT_NE(first, randomStream({.seed = 6}, {.stream = 1}, 8).uniform());
}

TEST(Ticker, RefusesATimingThatCannotBe) {
  EXPECT_THROW((void)validated(Timing{.rate = 0.0}, "t"), ConfigError);
  EXPECT_THROW((void)validated(Timing{.latency = -0.1}, "t"), ConfigError);
  EXPECT_THROW((void)validated(Timing{.drop_probability = 1.2}, "t"), ConfigError);
  EXPECT_THROW((void)validated(Timing{.outages = {{3.0, 3.0}}}, "t"), ConfigError);
}

}  // namespace pos::sim
