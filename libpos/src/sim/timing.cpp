#include "pos/sim/timing.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/config_checks.hpp"

namespace pos::sim {
namespace {

constexpr double kJitterLimit = 0.45;  // periods: ticks never change their order

constexpr double kRounding = 1e-9;  // s, of a moment that should be the last one

enum Purpose : std::uint32_t { kJitter = 0, kDrops = 6, kLatency = 7 };

std::uint64_t hashed(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3U;
  return hash;
}

}  // namespace

void requireSpan(const TimeSpan& span, const std::string& key) {
  if (span.from < span.to) return;
  refuse("the span ends before it begins", key, std::to_string(span.from) + " to " + std::to_string(span.to),
         "a span that ends after it begins, s");
}

Timing validated(Timing timing) {
  requirePositive(timing.rate, "rate", "Hz");
  requireNotNegative(timing.phase, "phase", "s");
  requireNotNegative(timing.jitter, "jitter", "s");
  requireNotNegative(timing.latency, "latency", "s");
  requireNotNegative(timing.latency_jitter, "latency_jitter", "s");
  requireFinite(timing.stamp_error, "stamp_error", "s");
  requireShare(timing.drop_probability, "drop_probability");
  for (std::size_t i = 0; i < timing.outages.size(); ++i) {
    requireSpan(timing.outages[i], indexed("outages", i));
  }
  return timing;
}

std::uint64_t streamOf(std::string_view name) {
  return hashed(name) & ~std::uint64_t{63};
}

std::uint64_t wideStreamOf(std::string_view name) {
  return (hashed(name) >> 6U) << 32U;
}

RandomStream randomStream(const RunSetup& run, const Timing& timing, std::uint32_t purpose) {
  return {run.seed, timing.stream + purpose};
}

Ticker::Ticker(const Timing& timing, const RunSetup& run, double duration)
    : timing_(validated(timing)),
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
  if (t > duration_ + kRounding) return {};
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
