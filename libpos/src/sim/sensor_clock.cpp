#include "pos/sim/sensor_clock.hpp"

#include <algorithm>

#include "pos/core/config_checks.hpp"

namespace pos::sim {

SensorTiming validated(const SensorTiming& timing) {
  requirePositive(timing.rate, "rate");
  requireNotNegative(timing.phase, "phase");
  requireNotNegative(timing.latency, "latency");
  requireNotNegative(timing.jitter_sigma, "jitter_sigma");
  requireFinite(timing.stamp_offset, "stamp_offset");
  requireShare(timing.loss_probability, "loss_probability");
  for (std::size_t i = 0; i < timing.outages.size(); ++i) {
    const TimeWindow& outage = timing.outages[i];
    if (!(outage.from < outage.to)) {
      refuse("the outage ends before it begins", indexed("outages", i), std::to_string(outage.to),
             "more than " + std::to_string(outage.from) + " s");
    }
  }
  return timing;
}

std::uint64_t streamOf(std::string_view label) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char letter : label) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3U;
  return hash >> 6U;
}

SensorClock::SensorClock(const SensorTiming& timing, SensorSeed seed, Stamp start)
    : timing_(validated(timing)),
      random_(seed.sequence(Purpose::Timing)),
      start_(start),
      last_arrival_(Stamp::min()) {}

SensorClock::Tick SensorClock::next() {
  Tick tick{.t = timing_.phase + static_cast<double>(count_++) / timing_.rate};
  const Stamp moment = start_ + durationFromSeconds(tick.t);
  // Both numbers are drawn at every tick, so that one setting does not shift the other's sequence.
  const double jitter = timing_.jitter_sigma * random_.normal();
  const bool lost = random_.bernoulli(timing_.loss_probability);
  const bool out = std::any_of(timing_.outages.begin(), timing_.outages.end(),
                               [&](const TimeWindow& window) { return window.contains(tick.t); });
  tick.lost = lost || out;
  tick.stamp = moment + durationFromSeconds(timing_.stamp_offset);
  tick.arrival =
      std::max(last_arrival_, moment + durationFromSeconds(std::max(0.0, timing_.latency + jitter)));
  last_arrival_ = tick.arrival;
  return tick;
}

}  // namespace pos::sim
