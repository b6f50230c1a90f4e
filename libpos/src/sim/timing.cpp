#include "pos/sim/timing.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/config_checks.hpp"

namespace pos::sim {
namespace {

constexpr double kJitterLimit = 0.45;  // periods: ticks never change their order

enum Purpose : std::uint32_t { kJitter = 0, kDrops = 1, kLatency = 2 };

}  // namespace

void requireSpan(const TimeSpan& span, const std::string& key) {
  if (span.from < span.to) return;
  refuse("the span ends before it begins", key, std::to_string(span.from) + " to " + std::to_string(span.to),
         "a span that ends after it begins, s");
}

Timing validated(Timing timing, const std::string& key) {
  requirePositive(timing.rate, key + ".rate", "Hz");
  requireNotNegative(timing.phase, key + ".phase", "s");
  requireNotNegative(timing.jitter, key + ".jitter", "s");
  requireNotNegative(timing.latency, key + ".latency", "s");
  requireNotNegative(timing.latency_jitter, key + ".latency_jitter", "s");
  requireFinite(timing.stamp_error, key + ".stamp_error", "s");
  requireShare(timing.drop_probability, key + ".drop_probability");
  for (const TimeSpan& outage : timing.outages) requireSpan(outage, key + ".outages");
  return timing;
}

RandomStream randomStream(const RunSetup& run, const Timing& timing, std::uint32_t purpose) {
  return {run.seed, (std::uint64_t{timing.stream} << 32U) | purpose};
}

Ticker::Ticker(const Timing& timing, const RunSetup& run, double duration)
    : timing_(validated(timing, "timing")),
      run_(run),
      duration_(duration),
      jitter_(randomStream(run, timing, kJitter)),
      drops_(randomStream(run, timing, kDrops)),
      latency_(randomStream(run, timing, kLatency)) {}

std::optional<Tick> Ticker::next() {
  double t = timing_.phase + static_cast<double>(index_) / timing_.rate;
  if (timing_.jitter > 0.0) {
    const double limit = kJitterLimit / timing_.rate;
    t += std::clamp(jitter_.normal(0.0, timing_.jitter), -limit, limit);
  }
  t = std::max(0.0, seconds(durationFromSeconds(t)));
  if (t > duration_) return {};
  const bool dropped = timing_.drop_probability > 0.0 && drops_.bernoulli(timing_.drop_probability);
  const bool out = std::any_of(timing_.outages.begin(), timing_.outages.end(),
                               [t](const TimeSpan& outage) { return outage.contains(t); });
  return Tick{.index = index_++, .t = t, .lost = dropped || out};
}

Delivery Ticker::sent(double t, double ready, const std::string& sensor, Reading reading) {
  double delay = timing_.latency;
  if (timing_.latency_jitter > 0.0) delay += std::abs(latency_.normal(0.0, timing_.latency_jitter));
  last_arrival_ = std::max(last_arrival_, run_.start + durationFromSeconds(ready + delay));
  return {.arrival = last_arrival_,
          .measurement = {.stamp = run_.start + durationFromSeconds(t + timing_.stamp_error),
                          .sensor = sensor,
                          .reading = std::move(reading)}};
}

}  // namespace pos::sim
