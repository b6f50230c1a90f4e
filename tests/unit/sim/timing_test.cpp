#include "pos/sim/timing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "pos/core/angle.hpp"
#include "sensor_scene.hpp"
#include "unit/sim/refusals.hpp"

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

TEST(Ticker, MomentsAreExactAfterHours) {
  const RunSetup run{.start = stampFromSeconds(1e9)};
  Ticker ticker({.rate = 100.0, .phase = 0.25}, run, 10000.25);
  std::optional<Tick> last;
  while (const std::optional<Tick> tick = ticker.next()) last = tick;
  EXPECT_EQ(last->index, 1000000);
  EXPECT_DOUBLE_EQ(last->t, 10000.25);
  EXPECT_EQ(ticker.sent(last->t, "s", WheelSpeeds{}).measurement.stamp,
            run.start + durationFromSeconds(10000.25));
}

TEST(Ticker, AMomentAtTheEndIsNotLostToRounding) {
  EXPECT_EQ(ticks({.rate = 10.0}, 0.1 + 0.2).size(), 4U);
  EXPECT_EQ(ticks({.rate = 10.0}, 0.3 - 1e-12).size(), 4U);
  EXPECT_EQ(ticks({.rate = 10.0}, 0.3 - 1e-6).size(), 3U);
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

TEST(Ticker, LatencyGrowsByTheMagnitudeOfItsJitter) {
  Ticker ticker({.rate = 1.0, .latency = 0.2, .latency_jitter = 0.03}, {.seed = 4}, 10000.0);
  std::vector<double> extra;
  while (const std::optional<Tick> tick = ticker.next()) {
    extra.push_back(seconds(ticker.sent(tick->t, "s", WheelSpeeds{}).arrival - Stamp{}) - tick->t - 0.2);
  }
  // |normal|: mean sqrt(2 / pi) sigma, mean square sigma^2; none waits behind another at 1 Hz.
  const double sigma = 0.03 * std::sqrt(1.0 - 2.0 / kPi);
  EXPECT_NEAR(meanOf(extra), 0.03 * std::sqrt(2.0 / kPi), scene::meanBand(sigma, extra.size()));
  double square = 0.0;
  for (const double e : extra) square += e * e / static_cast<double>(extra.size());
  EXPECT_NEAR(square / (0.03 * 0.03), 1.0, scene::meanBand(std::sqrt(2.0), extra.size()));
}

TEST(Ticker, FastSensorsWithALatencyThatVariesStillArriveInOrder) {
  Ticker ticker({.rate = 1000.0, .latency = 0.001, .latency_jitter = 0.005}, {}, 2.0);
  Stamp last = Stamp::min();
  while (const std::optional<Tick> tick = ticker.next()) {
    const Delivery delivery = ticker.sent(tick->t, "s", WheelSpeeds{});
    EXPECT_GE(delivery.arrival, last);
    EXPECT_GE(delivery.arrival, delivery.measurement.stamp);
    last = delivery.arrival;
  }
}

TEST(Ticker, AStampErrorMovesStampsOnly) {
  Ticker ticker({.stamp_error = 0.05}, {}, 1.0);
  const Delivery delivery = ticker.sent(ticker.next()->t, "s", WheelSpeeds{});
  EXPECT_EQ(delivery.measurement.stamp, stampFromSeconds(0.05));
  EXPECT_EQ(delivery.arrival, Stamp{});
}

TEST(Ticker, NamesAndPurposesGetSequencesOfTheirOwn) {
  std::set<std::uint32_t> firsts;
  for (const char* name : {"imu", "wheels", "uwb", "uwb2", "gnss"}) {
    for (const std::uint64_t stream : {streamOf(name), wideStreamOf(name)}) {
      for (std::uint32_t purpose = 0; purpose < 64; ++purpose) {
        firsts.insert(randomStream({.seed = 1}, {.stream = stream}, purpose).bits());
      }
    }
  }
  EXPECT_EQ(firsts.size(), 5U * 2U * 64U);
}

TEST(Ticker, RandomNumbersOfSensorsPurposesAndSeedsDiffer) {
  const RunSetup run{.seed = 5};
  const double first = randomStream(run, {.stream = 1}, 8).uniform();
  EXPECT_EQ(first, randomStream(run, {.stream = 1}, 8).uniform());
  EXPECT_NE(first, randomStream(run, {.stream = 2}, 8).uniform());
  EXPECT_NE(first, randomStream(run, {.stream = 1}, 9).uniform());
  EXPECT_NE(first, randomStream({.seed = 6}, {.stream = 1}, 8).uniform());
}

TEST(Ticker, RefusesATimingThatCannotBeAndNamesTheKey) {
  const auto refused = [](const Timing& timing) { return refusedKey([&] { return validated(timing); }); };
  EXPECT_EQ(refused({.rate = 0.0}), "rate");
  EXPECT_EQ(refused({.rate = -1.0}), "rate");
  EXPECT_EQ(refused({.phase = -1.0}), "phase");
  EXPECT_EQ(refused({.jitter = -0.1}), "jitter");
  EXPECT_EQ(refused({.latency = -0.1}), "latency");
  EXPECT_EQ(refused({.latency_jitter = -0.1}), "latency_jitter");
  EXPECT_EQ(refused({.stamp_error = NAN}), "stamp_error");
  EXPECT_EQ(refused({.drop_probability = 1.2}), "drop_probability");
  EXPECT_EQ(refused({.outages = {{1.0, 2.0}, {3.0, 3.0}}}), "outages[1]");
  EXPECT_EQ(refused({}), "accepted");
}

}  // namespace pos::sim
