#include "pos/uwb/twr.hpp"

#include <cmath>
#include <optional>
#include <string>

#include "pos/core/config_checks.hpp"

namespace pos::uwb {
namespace {

/// Whole ticks; a difference of two stamps of one radio.
struct Ticks {
  std::int64_t round_1 = 0;
  std::int64_t reply_1 = 0;
  std::int64_t round_2 = 0;
  std::int64_t reply_2 = 0;
};

/// later - earlier modulo the counter's width. More than half the width means that the order was violated.
std::optional<std::int64_t> elapsed(std::uint64_t earlier, std::uint64_t later, int bits) {
  const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
  const std::uint64_t difference = (later - earlier) & mask;
  if (difference > mask / 2) return std::nullopt;
  return static_cast<std::int64_t>(difference);
}

std::optional<Ticks> ticksOf(const TwrStamps& s, int bits) {
  const auto round_1 = elapsed(s.t1, s.t4, bits);
  const auto reply_1 = elapsed(s.t2, s.t3, bits);
  const auto round_2 = elapsed(s.t3, s.t6, bits);
  const auto reply_2 = elapsed(s.t4, s.t5, bits);
  if (!round_1 || !reply_1 || !round_2 || !reply_2) return std::nullopt;
  return Ticks{*round_1, *reply_1, *round_2, *reply_2};
}

/// R1 R2 - D1 D2 written with small factors, so that no product of whole ticks overflows, nor loses a digit.
std::int64_t numerator(const Ticks& k) {
  return (k.round_1 - k.reply_1) * k.reply_2 + k.round_1 * (k.round_2 - k.reply_2);
}

TwrVerdict verdictOf(const TwrRange& result, const TwrConfig& config) {
  if (result.range < -3.0 * result.sigma) return TwrVerdict::RangeNegative;
  return result.range > config.range_max ? TwrVerdict::RangeTooLong : TwrVerdict::Valid;
}

}  // namespace

TwrConfig validated(TwrConfig config) {
  if (config.counter_bits < 8 || config.counter_bits > 62) {
    refuse("the counter's width cannot be", "counter_bits", std::to_string(config.counter_bits), "8 to 62");
  }
  requirePositive(config.tick, "tick_s", "s");
  requireNotNegative(config.reply_min, "reply_min_s", "s");
  require(config.reply_min < config.reply_max, "reply_min_s", "below reply_max_s",
          "no reply time would be accepted");
  require(config.reply_max <= 0.5, "reply_max_s", "at most 0.5",
          "reply times of this length overflow the arithmetic");
  requirePositive(config.range_max, "range_max_m", "m");
  requirePositive(config.propagation_speed, "propagation_speed_m_per_s", "m/s");
  for (const double sigma : config.stamp_sigma) requireNotNegative(sigma, "stamp_sigma_s", "s");
  return config;
}

std::string_view name(TwrVerdict verdict) {
  switch (verdict) {
    case TwrVerdict::Valid:
      return "valid";
    case TwrVerdict::OrderViolated:
      return "order_violated";
    case TwrVerdict::ReplyTooShort:
      return "reply_too_short";
    case TwrVerdict::ReplyTooLong:
      return "reply_too_long";
    case TwrVerdict::RangeNegative:
      return "range_negative";
    case TwrVerdict::RangeTooLong:
      return "range_too_long";
  }
  return "unknown";
}

TwrRange twrRange(const TwrStamps& stamps, const TwrConfig& config) {
  TwrRange result;
  const auto ticks = ticksOf(stamps, config.counter_bits);
  if (!ticks) return result;
  const auto seconds = [&](std::int64_t n) { return config.tick * static_cast<double>(n); };
  const TwrIntervals intervals{seconds(ticks->round_1), seconds(ticks->reply_1), seconds(ticks->round_2),
                               seconds(ticks->reply_2)};
  result.verdict = TwrVerdict::ReplyTooShort;
  if (intervals.reply_1 < config.reply_min || intervals.reply_2 < config.reply_min) return result;
  result.verdict = TwrVerdict::ReplyTooLong;
  if (intervals.reply_1 > config.reply_max || intervals.reply_2 > config.reply_max) return result;
  const std::int64_t sum = ticks->round_1 + ticks->round_2 + ticks->reply_1 + ticks->reply_2;
  const double flight_ticks = static_cast<double>(numerator(*ticks)) / static_cast<double>(sum);
  result.time_of_flight = config.tick * flight_ticks - config.antenna_delay_a - config.antenna_delay_b;
  result.range = config.propagation_speed * result.time_of_flight;
  double variance = 0.0;
  const std::array<double, 6> sensitivity = twrSensitivities(intervals);
  for (std::size_t i = 0; i < 6; ++i) variance += std::pow(sensitivity[i] * config.stamp_sigma[i], 2);
  result.sigma = config.propagation_speed * std::sqrt(variance);
  result.verdict = verdictOf(result, config);
  return result;
}

std::array<double, 6> twrSensitivities(const TwrIntervals& k) {
  const double sum = k.round_1 + k.round_2 + k.reply_1 + k.reply_2;
  const double T = (k.round_1 * k.round_2 - k.reply_1 * k.reply_2) / sum;
  const double by_round_1 = (k.round_2 - T) / sum;  // d T / d R1, and so on
  const double by_round_2 = (k.round_1 - T) / sum;
  const double by_reply_1 = -(k.reply_2 + T) / sum;
  const double by_reply_2 = -(k.reply_1 + T) / sum;
  return {-by_round_1, -by_reply_1, by_reply_1 - by_round_2, by_round_1 - by_reply_2, by_reply_2, by_round_2};
}

}  // namespace pos::uwb
