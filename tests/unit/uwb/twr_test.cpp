#include "pos/uwb/twr.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pos/core/error.hpp"
#include "pos/core/random.hpp"

namespace pos::uwb {
namespace {

/// A true exchange: distance, reply times, clocks, and where the two counters stood at the start.
struct Exchange {
  double distance = 20.0;  ///< m
  double reply_1 = 1e-3;   ///< s, true time
  double reply_2 = 1e-3;   ///< s
  double error_a = 0.0;    ///< clock A runs this much fast
  double error_b = 0.0;
  std::uint64_t start_a = 123456789;
  std::uint64_t start_b = 987654321;
};

/// Stamps as the counters would give them, rounded to ticks and wrapped.
TwrStamps stampsOf(const Exchange& e, const TwrConfig& config) {
  const double T = e.distance / config.propagation_speed;
  const std::uint64_t mask = (std::uint64_t{1} << config.counter_bits) - 1;
  const auto count = [&](double t, double error, std::uint64_t start) {
    return (start + static_cast<std::uint64_t>(std::llround(t * (1.0 + error) / config.tick))) & mask;
  };
  const double t2 = T;
  const double t3 = t2 + e.reply_1;
  const double t4 = t3 + T;
  const double t5 = t4 + e.reply_2;
  const double t6 = t5 + T;
  return {count(0.0, e.error_a, e.start_a), count(t2, e.error_b, e.start_b), count(t3, e.error_b, e.start_b),
          count(t4, e.error_a, e.start_a),  count(t5, e.error_a, e.start_a), count(t6, e.error_b, e.start_b)};
}

/// Rounding every stamp by half a tick at most moves the flight by the sum of the sensitivities' sizes.
double quantisation(const TwrConfig& config) {
  return 0.5 * (0.25 * 4.0 + 0.5 * 2.0) * 1.6 * config.tick * config.propagation_speed;
}

/// The paper's equation 1 as printed, for the test that shows why it is wrong.
double printedFlight(const TwrIntervals& k) {
  return (k.round_1 * k.round_2 - k.reply_1 * k.reply_2) / (k.round_1 + k.round_2 - k.reply_1 + k.reply_2);
}

TwrIntervals intervalsOf(double T, double reply_1, double reply_2) {
  return {2.0 * T + reply_1, reply_1, 2.0 * T + reply_2, reply_2};
}

double flight(const TwrIntervals& k) {
  return (k.round_1 * k.round_2 - k.reply_1 * k.reply_2) / (k.round_1 + k.round_2 + k.reply_1 + k.reply_2);
}

TEST(Twr, RangeIsExactToAQuantumForAnyReplyTimes) {
  const TwrConfig config;
  for (const double distance : {0.5, 1.0, 20.0, 100.0, 450.0}) {
    for (const double reply_1 : {0.3e-3, 1e-3, 3e-3, 20e-3}) {
      for (const double reply_2 : {0.3e-3, 1e-3, 3e-3, 20e-3}) {
        const TwrRange range = twrRange(stampsOf({distance, reply_1, reply_2}, config), config);
        ASSERT_EQ(range.verdict, TwrVerdict::Valid);
        EXPECT_NEAR(range.range, distance, quantisation(config));
      }
    }
  }
}

// Spec A3: at most 2.1 mm per 100 m and the quantisation, over all reply times and +-20 ppm.
TEST(Twr, ClocksOffByTwentyPpmCostTwoMillimetresPerHundredMetres) {
  const TwrConfig config;
  double worst = 0.0;
  for (const double distance : {1.0, 3.0, 10.0, 30.0, 100.0}) {
    for (const double reply_1 : {0.3e-3, 1e-3, 3e-3}) {
      for (const double reply_2 : {0.3e-3, 1e-3, 3e-3}) {
        for (const double a : {-20e-6, 0.0, 20e-6}) {
          for (const double b : {-20e-6, 0.0, 20e-6}) {
            const TwrRange range = twrRange(stampsOf({distance, reply_1, reply_2, a, b}, config), config);
            const double error = std::abs(range.range - distance) - quantisation(config);
            worst = std::max(worst, error / distance * 100.0);
          }
        }
      }
    }
  }
  RecordProperty("worst_mm_per_100_m", std::to_string(1e3 * worst));
  EXPECT_LE(worst, 2.1e-3);
}

TEST(Twr, ClockLawIsExactForAnyReplyTimes) {
  const double T = 100.0 / kSpeedOfLight;
  for (const double a : {20e-6, -7e-6}) {
    for (const double b : {-10e-6, 3e-6}) {
      for (const double reply_1 : {0.3e-3, 3e-3}) {
        const TwrIntervals k{(1 + a) * (2 * T + reply_1), (1 + b) * reply_1, (1 + b) * (2 * T + 1e-3),
                             (1 + a) * 1e-3};
        // long double keeps the cancellation of R1 R2 - D1 D2 out of the comparison
        const long double numerator =
            static_cast<long double>(k.round_1) * k.round_2 - static_cast<long double>(k.reply_1) * k.reply_2;
        const long double sum = static_cast<long double>(k.round_1) + k.round_2 + k.reply_1 + k.reply_2;
        EXPECT_NEAR(static_cast<double>(numerator / sum) / (T * twrClockFactor(a, b)), 1.0, 1e-11);
      }
    }
  }
  EXPECT_NEAR((twrClockFactor(20e-6, -10e-6) - 1.0) * 100.0, 0.5e-3, 1e-7);  // spec: +0.500 mm in 100 m
}

TEST(Twr, RolesOfTheRadiosMayBeSwapped) {
  // Seen from B's replies the same four intervals come back with 1 and 2 exchanged.
  const TwrIntervals k = intervalsOf(3e-7, 0.7e-3, 2.1e-3);
  const TwrIntervals swapped{k.round_2, k.reply_2, k.round_1, k.reply_1};
  EXPECT_DOUBLE_EQ(flight(k), flight(swapped));
}

TEST(Twr, CounterMayWrapAnywhereInTheExchange) {
  const TwrConfig config;
  const std::uint64_t width = std::uint64_t{1} << config.counter_bits;
  const Exchange unwrapped{37.0, 1e-3, 2e-3};
  const double expected = twrRange(stampsOf(unwrapped, config), config).range;
  for (const double before : {0.0, 0.5e-3, 1.5e-3, 2.9e-3}) {
    Exchange e = unwrapped;
    e.start_a = width - 1 - static_cast<std::uint64_t>(before / config.tick);
    e.start_b = width - 1 - static_cast<std::uint64_t>(before / config.tick);
    const TwrRange range = twrRange(stampsOf(e, config), config);
    ASSERT_EQ(range.verdict, TwrVerdict::Valid);
    EXPECT_NEAR(range.range, expected, 2.0 * quantisation(config));
  }
}

TEST(Twr, LongRepliesLoseNoDigits) {
  // 39 ms are 2.5e9 ticks: products of intervals (6e18) are near the end of 64 bits.
  const TwrConfig config;
  const TwrRange range = twrRange(stampsOf({80.0, 39e-3, 39e-3}, config), config);
  EXPECT_EQ(range.verdict, TwrVerdict::Valid);
  EXPECT_NEAR(range.range, 80.0, quantisation(config));
}

TEST(Twr, AntennaDelaysShortenTheRange) {
  TwrConfig config;
  config.antenna_delay_a = 1e-9;
  config.antenna_delay_b = 0.5e-9;
  const TwrConfig plain;
  const TwrStamps stamps = stampsOf({25.0}, plain);
  EXPECT_NEAR(twrRange(stamps, plain).range - twrRange(stamps, config).range, 1.5e-9 * kSpeedOfLight, 1e-12);
}

TEST(Twr, EveryInsaneExchangeHasItsVerdict) {
  TwrConfig config;
  const auto verdictOf = [&](const Exchange& e) { return twrRange(stampsOf(e, config), config).verdict; };
  EXPECT_EQ(verdictOf({20.0, 10e-6, 1e-3}), TwrVerdict::ReplyTooShort);
  EXPECT_EQ(verdictOf({20.0, 1e-3, 60e-3}), TwrVerdict::ReplyTooLong);
  EXPECT_EQ(verdictOf({2000.0, 1e-3, 1e-3}), TwrVerdict::RangeTooLong);
  TwrStamps stamps = stampsOf({20.0}, config);
  std::swap(stamps.t4, stamps.t1);
  EXPECT_EQ(twrRange(stamps, config).verdict, TwrVerdict::OrderViolated);
  config.antenna_delay_a = 100e-9;  // 30 m more than there are
  EXPECT_EQ(verdictOf({20.0}), TwrVerdict::RangeNegative);
  config.antenna_delay_a = (20.0 + 0.05) / kSpeedOfLight;  // within three sigma of zero
  EXPECT_EQ(verdictOf({20.0}), TwrVerdict::Valid);
}

TEST(Twr, SensitivitiesAreThoseOfTheSpecForEqualReplies) {
  const std::array<double, 6> expected{-0.25, 0.25, -0.5, 0.5, -0.25, 0.25};
  const std::array<double, 6> found = twrSensitivities(intervalsOf(1e-7, 1e-3, 1e-3));
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(found[i], expected[i], 1e-4);
}

TEST(Twr, SensitivitiesAreTheDerivatives) {
  const TwrIntervals k = intervalsOf(3e-4, 1e-3, 2.3e-3);  // a flight long enough for differences to show
  const std::array<double, 6> found = twrSensitivities(k);
  const double step = 1e-9;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto at = [&](double moved) {
      std::array<double, 6> t{};
      t[i] = moved;
      TwrIntervals m = k;
      m.round_1 += t[3] - t[0];
      m.reply_1 += t[2] - t[1];
      m.round_2 += t[5] - t[2];
      m.reply_2 += t[4] - t[3];
      return flight(m);
    };
    EXPECT_NEAR(found[i], (at(step) - at(-step)) / (2.0 * step), 1e-6) << "t" << i + 1;
  }
}

TEST(Twr, SigmaIsWhatJitterOfTheReceiveStampsMakes) {
  const TwrConfig config;
  const TwrStamps exact = stampsOf({50.0}, config);
  EXPECT_NEAR(twrRange(exact, config).sigma, 0.612 * 0.2e-9 * kSpeedOfLight, 2e-4);
  RandomStream random(3, 1);
  constexpr int kDraws = 4000;
  double sum = 0.0;
  for (int k = 0; k < kDraws; ++k) {
    TwrStamps stamps = exact;
    const auto jitter = [&] {
      return static_cast<std::uint64_t>(std::llround(random.normal(0.0, 0.2e-9) / config.tick));
    };
    stamps.t2 += jitter();
    stamps.t4 += jitter();
    stamps.t6 += jitter();
    sum += std::pow(twrRange(stamps, config).range - twrRange(exact, config).range, 2);
  }
  // the sample sigma of 4000 draws scatters by 1.1 %; 4 of its sigmas
  EXPECT_NEAR(std::sqrt(sum / kDraws) / twrRange(exact, config).sigma, 1.0, 0.045);
}

TEST(Twr, PrintedEquationOneDoublesTheRange) {
  const double T = 20.0 / kSpeedOfLight;
  EXPECT_NEAR(flight(intervalsOf(T, 1e-3, 1e-3)) * kSpeedOfLight, 20.0, 1e-6);
  EXPECT_NEAR(printedFlight(intervalsOf(T, 1e-3, 1e-3)) * kSpeedOfLight, 39.99, 0.01);
  EXPECT_NEAR(printedFlight(intervalsOf(5.0 * T, 1e-3, 2e-3)) * kSpeedOfLight, 149.98, 0.01);
}

TEST(Twr, ConfigurationsThatCannotBeAreRefused) {
  EXPECT_NO_THROW((void)validated(TwrConfig{}));
  EXPECT_THROW((void)validated(TwrConfig{.counter_bits = 63}), ConfigError);
  EXPECT_THROW((void)validated(TwrConfig{.tick = 0.0}), ConfigError);
  EXPECT_THROW((void)validated(TwrConfig{.reply_min = 1.0, .reply_max = 0.1}), ConfigError);
  EXPECT_THROW((void)validated(TwrConfig{.range_max = -1.0}), ConfigError);
}

}  // namespace
}  // namespace pos::uwb
