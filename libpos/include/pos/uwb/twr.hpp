#pragma once
/// Double-sided two-way ranging: six counter stamps of two radios to one range. Works in whole ticks; the
/// only division is the last step.
///
/// A starts the exchange and stamps 1, 4, 5; B answers and stamps 2, 3, 6:
///   A sends (1) -> B hears (2), B sends (3) -> A hears (4), A sends (5) -> B hears (6).
/// R1 = t4 - t1, D1 = t3 - t2, R2 = t6 - t3, D2 = t5 - t4 (R = round trip, D = reply time).

#include <array>
#include <cstdint>
#include <string_view>

namespace pos::uwb {

inline constexpr double kSpeedOfLight = 299792458.0;  ///< m/s, vacuum; air is 0.03 % slower (range scale)

/// The six stamps as the radios' counters gave them; each radio's counter wraps by itself.
struct TwrStamps {
  std::uint64_t t1 = 0;  ///< A
  std::uint64_t t2 = 0;  ///< B
  std::uint64_t t3 = 0;  ///< B
  std::uint64_t t4 = 0;  ///< A
  std::uint64_t t5 = 0;  ///< A
  std::uint64_t t6 = 0;  ///< B
};

/// The radios and the limits of a sane exchange. Defaults suit DW1000-like radios.
struct TwrConfig {
  int counter_bits = 40;                     ///< width of the counters, 8 to 62
  double tick = 1.0 / (128.0 * 499.2e6);     ///< s, 15.65 ps
  double antenna_delay_a = 0.0;              ///< s, both directions of radio A together, halved
  double antenna_delay_b = 0.0;              ///< s, the same of radio B
  double reply_min = 50e-6;                  ///< s, shorter reply times are refused
  double reply_max = 40e-3;                  ///< s, longer ones as well
  double range_max = 1000.0;                 ///< m
  double propagation_speed = kSpeedOfLight;  ///< m/s
  std::array<double, 6> stamp_sigma{0.0, 0.2e-9, 0.0, 0.2e-9, 0.0, 0.2e-9};  ///< s, jitter of t1 .. t6
};

/// The config itself; throws ConfigError for a width, a tick, a speed or limits that cannot be.
TwrConfig validated(TwrConfig config);

enum class TwrVerdict : std::uint8_t {
  Valid,
  OrderViolated,  ///< a later stamp lies before an earlier one of the same radio
  ReplyTooShort,  ///< below reply_min
  ReplyTooLong,   ///< above reply_max
  RangeNegative,  ///< below zero by more than three sigma
  RangeTooLong,   ///< above range_max
};
std::string_view name(TwrVerdict verdict);

/// Range in m with its standard deviation from the stamps' jitter; both are meaningful for the verdicts
/// Valid, RangeNegative and RangeTooLong.
struct TwrRange {
  TwrVerdict verdict = TwrVerdict::OrderViolated;
  double time_of_flight = 0.0;  ///< s, antenna delays taken off
  double range = 0.0;           ///< m
  double sigma = 0.0;           ///< m
};

/// T = (R1 R2 - D1 D2) / (R1 + R2 + D1 + D2), spec A erratum A1 (Neirynck, Luk, McLaughlin 2016). Differences
/// are taken modulo the counter's width, the numerator in whole ticks without rounding.
TwrRange twrRange(const TwrStamps& stamps, const TwrConfig& config);

/// The four intervals of an exchange, in any one unit of time.
struct TwrIntervals {
  double round_1 = 0.0;
  double reply_1 = 0.0;
  double round_2 = 0.0;
  double reply_2 = 0.0;
};

/// d T / d t1 .. t6, exact for any reply times.
std::array<double, 6> twrSensitivities(const TwrIntervals& intervals);

/// Measured over true time of flight for clocks that run (1 + error) fast: 2 ka kb / (ka + kb), exact for any
/// reply times (erratum A2). 20 ppm make 2 mm in 100 m.
constexpr double twrClockFactor(double clock_error_a, double clock_error_b) {
  const double ka = 1.0 + clock_error_a;
  const double kb = 1.0 + clock_error_b;
  return 2.0 * ka * kb / (ka + kb);
}

}  // namespace pos::uwb
