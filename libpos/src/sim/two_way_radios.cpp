#include "two_way_radios.hpp"

#include <cmath>

#include "radio_channel.hpp"

namespace pos::sim {
namespace {

enum Kind : std::uint32_t { kTagClocks = 16, kAnchorClocks = 17, kReceive = 18 };

RadioClock clockOf(const UwbConfig& config, RandomStream random) {
  const double limit = config.devices.rate_error_max;
  const double wrap = std::ldexp(config.two_way.tick, config.two_way.counter_bits);
  RadioClock clock;
  clock.rate_error = random.uniform(-limit, limit);
  clock.offset = random.uniform(0.0, wrap);
  clock.antenna_delay = random.normal(config.devices.antenna_delay, config.devices.antenna_delay_sigma);
  return clock;
}

}  // namespace

TwoWayRadios::TwoWayRadios(const UwbConfig& config, std::size_t anchors, const RunSetup& run)
    : config_(config.two_way), antenna_delay_(config.devices.antenna_delay) {
  for (std::size_t tag = 0; tag < config.tags.size(); ++tag) {
    tags_.push_back(clockOf(config, linkRandom(run, config.timing, kTagClocks, tag)));
  }
  for (std::size_t anchor = 0; anchor < anchors; ++anchor) {
    anchors_.push_back(clockOf(config, linkRandom(run, config.timing, kAnchorClocks, anchor)));
  }
  for (std::size_t link = 0; link < config.tags.size() * anchors; ++link) {
    receive_.push_back(linkRandom(run, config.timing, kReceive, link));
  }
}

double TwoWayRadios::range(std::size_t tag, std::size_t anchor, double begin,
                           const std::array<double, 3>& flights) {
  RandomStream& random = receive_[tag * anchors_.size() + anchor];
  const TwoWayTimes times = exchange(begin, flights, tags_[tag], anchors_[anchor], config_, random);
  return kSpeedOfLight * (flightTime(counted(times, config_), config_) - 2.0 * antenna_delay_);
}

std::vector<BenchExchange> twoWayBench(const std::vector<double>& distances, double jitter,
                                       std::uint64_t seed) {
  RandomStream random(seed, 0);
  std::vector<BenchExchange> bench;
  for (const double reply_b : {0.3e-3, 1e-3, 3e-3}) {
    for (const double reply_a : {0.3e-3, 1e-3, 3e-3}) {
      for (const double rate_a : {-20e-6, 0.0, 20e-6}) {
        for (const double rate_b : {-20e-6, 0.0, 20e-6}) {
          for (const double d : distances) {
            BenchExchange one{.distance = d, .rate_error_a = rate_a, .rate_error_b = rate_b};
            one.config = {.reply_responder = reply_b, .reply_initiator = reply_a, .receive_jitter = jitter};
            const RadioClock a{.rate_error = rate_a, .offset = random.uniform(0.0, 17.2)};
            const RadioClock b{.rate_error = rate_b, .offset = random.uniform(0.0, 17.2)};
            one.stamps = counted(exchange(0.0, {d, d, d}, a, b, one.config, random), one.config);
            one.range = kSpeedOfLight * flightTime(one.stamps, one.config);
            bench.push_back(one);
          }
        }
      }
    }
  }
  return bench;
}

}  // namespace pos::sim
