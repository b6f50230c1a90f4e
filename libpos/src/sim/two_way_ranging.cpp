#include "pos/sim/two_way_ranging.hpp"

#include <cmath>

#include "pos/core/config_checks.hpp"

namespace pos::sim {
namespace {

constexpr double kLongestReply = 0.040;  // s: the products of two intervals in counts stay below 2^63

/// R1, D1, R2, D2 of either kind of stamps.
template <typename Number>
struct Intervals {
  Number R1, D1, R2, D2;
};

template <typename Number>
Number modulo(Number value, Number width) {
  const Number rest = value % width;
  return rest < 0 ? rest + width : rest;
}

std::int64_t counterWidth(const TwoWayConfig& config) {
  return std::int64_t{1} << config.counter_bits;
}

}  // namespace

TwoWayConfig validated(TwoWayConfig config, const std::string& key) {
  requirePositive(config.tick, key + ".tick", "s");
  require(config.counter_bits >= 8 && config.counter_bits <= 62, key + ".counter_bits", "8 to 62");
  for (const double reply : {config.reply_responder, config.reply_initiator}) {
    requirePositive(reply, key + ".reply", "s");
    require(reply <= kLongestReply, key + ".reply", "at most 0.040 s");
    // A round trip must fit the counter, else its length is lost.
    require(2.0 * reply < std::ldexp(config.tick, config.counter_bits), key + ".counter_bits",
            "a counter that does not wrap within an exchange");
  }
  require(config.reply_responder / config.tick < 2.6e9 && config.reply_initiator / config.tick < 2.6e9,
          key + ".tick", "replies of less than 2.6e9 counts, so that products fit 64 bits");
  requireNotNegative(config.receive_jitter, key + ".receive_jitter", "s");
  return config;
}

TwoWayTimes exchange(double begin, const std::array<double, 3>& flights, const RadioClock& a,
                     const RadioClock& b, const TwoWayConfig& config, RandomStream& random) {
  // True moments of the stamps after `begin`: a stamp is taken at the radio, antenna_delay before the antenna
  // when sending and after it when receiving. Long double: 1e-16 m of range would still show.
  const long double k_a = 1.0L + static_cast<long double>(a.rate_error);
  const long double k_b = 1.0L + static_cast<long double>(b.rate_error);
  const long double antennas = static_cast<long double>(a.antenna_delay) + b.antenna_delay;
  const auto flight = [&](std::size_t i) {
    return flights[i] / static_cast<long double>(kSpeedOfLight) + antennas;
  };
  const long double sent_poll = 0.0L;
  const long double heard_poll = sent_poll + flight(0);
  const long double sent_answer = heard_poll + config.reply_responder / k_b;
  const long double heard_answer = sent_answer + flight(1);
  const long double sent_final = heard_answer + config.reply_initiator / k_a;
  const long double heard_final = sent_final + flight(2);
  const auto clock_a = [&](long double t) { return a.offset + k_a * (begin + t); };
  const auto clock_b = [&](long double t) { return b.offset + k_b * (begin + t); };
  const auto jitter = [&] {
    return config.receive_jitter > 0.0 ? random.normal(0.0, config.receive_jitter) : 0.0;
  };
  TwoWayTimes times;
  times.t = {clock_a(sent_poll),   clock_b(heard_poll) + jitter(),
             clock_b(sent_answer), clock_a(heard_answer) + jitter(),
             clock_a(sent_final),  clock_b(heard_final) + jitter()};
  return times;
}

TwoWayStamps counted(const TwoWayTimes& times, const TwoWayConfig& config) {
  TwoWayStamps stamps;
  for (std::size_t i = 0; i < times.t.size(); ++i) {
    const auto count = static_cast<std::int64_t>(std::floor(times.t[i] / config.tick));
    stamps.count[i] = modulo(count, counterWidth(config));
  }
  return stamps;
}

double flightTime(const TwoWayTimes& times) {
  const auto& t = times.t;
  const Intervals<long double> i{.R1 = t[3] - t[0], .D1 = t[2] - t[1], .R2 = t[5] - t[2], .D2 = t[4] - t[3]};
  const long double difference = (i.R1 - i.D1) * i.D2 + i.R1 * (i.R2 - i.D2);  // = R1 R2 - D1 D2
  return static_cast<double>(difference / (i.R1 + i.R2 + i.D1 + i.D2));
}

double flightTime(const TwoWayStamps& stamps, const TwoWayConfig& config) {
  const auto& n = stamps.count;
  const std::int64_t width = counterWidth(config);
  const Intervals<std::int64_t> i{.R1 = modulo(n[3] - n[0], width),
                                  .D1 = modulo(n[2] - n[1], width),
                                  .R2 = modulo(n[5] - n[2], width),
                                  .D2 = modulo(n[4] - n[3], width)};
  const std::int64_t difference = i.R1 * i.R2 - i.D1 * i.D2;
  return config.tick * static_cast<double>(difference) / static_cast<double>(i.R1 + i.R2 + i.D1 + i.D2);
}

double exchangeDuration(const TwoWayConfig& config, double distance) {
  return config.reply_responder + config.reply_initiator + 3.0 * distance / kSpeedOfLight;
}

}  // namespace pos::sim
