#include "pos/sim/two_way_ranging.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pos/core/error.hpp"
#include "pos/sim/uwb_stream.hpp"
#include "sensor_scene.hpp"

namespace pos::sim {
namespace {

constexpr std::array<double, 3> kReplies{0.3e-3, 1e-3, 3e-3};

TwoWayTimes measured(double distance, const TwoWayConfig& config, const RadioClock& a = {},
                     const RadioClock& b = {}) {
  RandomStream random(1, 1);
  return exchange(0.0, {distance, distance, distance}, a, b, config, random);
}

TwoWayConfig replies(double responder, double initiator) {
  return {.reply_responder = responder, .reply_initiator = initiator};
}

}  // namespace

TEST(TwoWayRanging, PerfectClocksWithoutCountsReproduceTheRange) {
  for (const double d1 : kReplies) {
    for (const double d2 : kReplies) {
      for (const double distance : {0.0, 0.5, 20.0, 100.0, 300.0}) {
        EXPECT_NEAR(kSpeedOfLight * flightTime(measured(distance, replies(d1, d2))), distance, 1e-9);
      }
    }
  }
}

// Spec A, erratum A2: T^ = 2 ka kb / (ka + kb) T for any reply times.
TEST(TwoWayRanging, ClockErrorsFollowTheExactLaw) {
  for (const double d1 : kReplies) {
    for (const double d2 : kReplies) {
      for (const double ea : {-20e-6, -7e-6, 20e-6}) {
        for (const double eb : {-20e-6, 13e-6, 20e-6}) {
          const double distance = 100.0;
          const double T = distance / kSpeedOfLight;
          const double law = T * 2.0 * (1.0 + ea) * (1.0 + eb) / (2.0 + ea + eb);
          const double found =
              flightTime(measured(distance, replies(d1, d2), {.rate_error = ea}, {.rate_error = eb}));
          EXPECT_NEAR(found / law, 1.0, 1e-12) << d1 << ' ' << d2 << ' ' << ea << ' ' << eb;
        }
      }
    }
  }
}

// The specification's figure: 100 m, +20 and -10 ppm give +0.500 mm.
TEST(TwoWayRanging, HundredMetresWithPlus20AndMinus10PpmAreHalfAMillimetreLong) {
  const TwoWayTimes times =
      measured(100.0, replies(1e-3, 2e-3), {.rate_error = 20e-6}, {.rate_error = -10e-6});
  EXPECT_NEAR(kSpeedOfLight * flightTime(times) - 100.0, 0.5e-3, 1e-6);
}

// Erratum A1: with the printed sign of the first reply the same stamps give about twice the range.
TEST(TwoWayRanging, PrintedEquationWouldDoubleTheRange) {
  const auto t = measured(20.0, replies(1e-3, 1e-3)).t;
  const long double R1 = t[3] - t[0];
  const long double D1 = t[2] - t[1];
  const long double R2 = t[5] - t[2];
  const long double D2 = t[4] - t[3];
  const long double printed = (R1 * R2 - D1 * D2) / (R1 + R2 - D1 + D2);
  EXPECT_NEAR(kSpeedOfLight * static_cast<double>(printed), 39.997, 0.01);
}

TEST(TwoWayRanging, AntennaDelaysOfBothRadiosAddToTheFlight) {
  const TwoWayTimes times =
      measured(30.0, replies(1e-3, 1e-3), {.antenna_delay = 100e-9}, {.antenna_delay = 50e-9});
  EXPECT_NEAR(flightTime(times), 30.0 / kSpeedOfLight + 150e-9, 1e-17);
}

TEST(TwoWayRanging, CountsWrapWithoutHarm) {
  TwoWayConfig config = replies(1e-3, 1e-3);
  const double wrap = std::ldexp(config.tick, config.counter_bits);
  EXPECT_NEAR(wrap, 17.2, 0.01);
  int wrapped = 0;
  for (const double before : {0.2e-3, 0.9e-3, 1.5e-3, 1.9e-3}) {
    for (const RadioClock& a : {RadioClock{.offset = wrap - before}, RadioClock{.offset = 3.0}}) {
      const TwoWayStamps stamps = counted(measured(50.0, config, a, {.offset = 2.0 * wrap - before}), config);
      for (const std::int64_t count : stamps.count) {
        EXPECT_GE(count, 0);
        EXPECT_LT(count, std::int64_t{1} << 40);
      }
      wrapped += stamps.count[5] < stamps.count[1] ? 1 : 0;
      // Six stamps rounded down: the range is off by less than a count's length either way.
      EXPECT_NEAR(kSpeedOfLight * flightTime(stamps, config), 50.0, kSpeedOfLight * config.tick);
    }
  }
  EXPECT_EQ(wrapped, 8);
}

TEST(TwoWayRanging, ReceiveJitterReachesTheFlightTimeWithItsKnownWeights) {
  constexpr int kRuns = 20000;
  RandomStream random(7, 3);
  for (const auto& [d1, d2] : {std::pair{1e-3, 1e-3}, {0.3e-3, 3e-3}, {3e-3, 0.3e-3}}) {
    TwoWayConfig config = replies(d1, d2);
    config.receive_jitter = 0.2e-9;
    const double T = 40.0 / kSpeedOfLight;
    const double w2 = (d2 + T) / (2.0 * (d1 + d2 + 2.0 * T));
    const double w6 = (d1 + T) / (2.0 * (d1 + d2 + 2.0 * T));
    const double expected = config.receive_jitter * std::sqrt(w2 * w2 + 0.25 + w6 * w6);
    std::vector<double> found;
    for (int i = 0; i < kRuns; ++i) {
      found.push_back(flightTime(exchange(0.0, {40.0, 40.0, 40.0}, {}, {}, config, random)));
    }
    EXPECT_NEAR(scene::meanOf(found), T, scene::meanBand(expected, found.size()));
    EXPECT_NEAR(scene::sigmaOf(found), expected, scene::sigmaBand(expected, found.size()));
    if (d1 == d2) {
      EXPECT_NEAR(expected / config.receive_jitter, 0.612, 0.001);
    }
  }
}

TEST(TwoWayRanging, MovingRadioGivesTheDistanceAtMidExchange) {
  RandomStream random(1, 1);
  const TwoWayTimes times = exchange(0.0, {30.0, 30.002, 30.004}, {}, {}, replies(1e-3, 1e-3), random);
  EXPECT_NEAR(kSpeedOfLight * flightTime(times), 30.002, 1e-6);
}

// Spec A 3.5, A3: at most 2.1 mm per 100 m, and a count.
TEST(TwoWayRanging, BenchStaysWithinTheClockLawAndACount) {
  const std::vector<BenchExchange> bench = twoWayBench({1.0, 10.0, 50.0, 100.0}, 0.0, 11);
  EXPECT_EQ(bench.size(), 9U * 9U * 4U);
  for (const BenchExchange& one : bench) {
    EXPECT_NEAR(one.range, one.distance, 2.1e-5 * one.distance + kSpeedOfLight * one.config.tick);
    EXPECT_DOUBLE_EQ(one.range, kSpeedOfLight * flightTime(one.stamps, one.config));
  }
}

TEST(TwoWayRanging, RefusesRepliesWhoseProductsOverflowOrThatOutlastTheCounter) {
  EXPECT_THROW((void)validated(replies(0.041, 1e-3), "x"), ConfigError);
  EXPECT_THROW((void)validated(TwoWayConfig{.counter_bits = 26}, "x"), ConfigError);
  EXPECT_THROW((void)validated(TwoWayConfig{.tick = 1e-12, .reply_initiator = 0.01}, "x"), ConfigError);
  EXPECT_NO_THROW((void)validated(TwoWayConfig{}, "x"));
}

}  // namespace pos::sim
