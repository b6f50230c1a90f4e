#pragma once
/// When a simulated sensor measures, what the way to the recorder does to its measurements, and where its
/// random numbers come from. Common to all sensors.
///
/// Times are seconds since the scenario's start.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pos/core/random.hpp"
#include "pos/sim/sensor.hpp"

namespace pos::sim {

/// The half-open span [from, to), s since the scenario's start.
struct TimeSpan {
  double from = 0.0;
  double to = 0.0;

  bool contains(double t) const { return from <= t && t < to; }
  bool operator==(const TimeSpan&) const = default;
};

/// Throws ConfigError naming `key` unless the span ends after it begins.
void requireSpan(const TimeSpan& span, const std::string& key);

/// What all sensors of one run share.
struct RunSetup {
  Stamp start = {};        ///< stamp of the scenario's time 0
  std::uint64_t seed = 0;  ///< the run's seed
};

/// The clockwork of one sensor.
struct Timing {
  double rate = 10.0;                  ///< Hz
  double phase = 0.0;                  ///< s, moment of the first measurement
  double jitter = 0.0;                 ///< s, 1 sigma of the moment of measuring about its regular tick
                                       ///< (cut off at 0.45 periods); the stamp tells the true moment
  double latency = 0.0;                ///< s, from measuring to arrival
  double latency_jitter = 0.0;         ///< s, 1 sigma; the latency grows by |normal|, never shrinks
  double stamp_error = 0.0;            ///< s, stamp minus true moment: 0.2 = stamps 0.2 s late
  std::vector<TimeSpan> outages = {};  ///< nothing is delivered then
  double drop_probability = 0.0;       ///< of any one tick, outside outages
  std::uint64_t stream = 0;  ///< number of its first random sequence; every sensor of a scenario has its own

  bool operator==(const Timing&) const = default;
};

/// `timing` itself; throws ConfigError naming the first field that cannot be.
Timing validated(Timing timing);

/// A sensor's `stream` from its name (64-bit FNV-1a), so that sensors do not depend on their order.
/// The first leaves room for 64 random sequences, the wide one for 2^32, as radios with many links need.
std::uint64_t streamOf(std::string_view name);
std::uint64_t wideStreamOf(std::string_view name);

/// The random numbers of one purpose of one sensor. Purposes of a sensor, sensors and seeds do not overlap,
/// so that switching one error on leaves the numbers of the others as they were.
RandomStream randomStream(const RunSetup& run, const Timing& timing, std::uint32_t purpose);

/// A moment of measuring.
struct Tick {
  std::int64_t index = 0;  ///< counts from 0, lost ones included
  double t = 0.0;          ///< s, a whole number of nanoseconds
  bool lost = false;       ///< fell into an outage or was dropped
};

/// Makes the moments of measuring and stamps what was measured. Moment k is computed from k, so that nothing
/// adds up over hours. Purposes 0, 6 and 7 of randomStream are its own; sensors use 1 to 5 and those from
/// kFirstPurpose up. Outages do not shift the random numbers of later ticks.
class Ticker {
 public:
  static constexpr std::uint32_t kFirstPurpose = 8;

  /// Ticks lie in [0, duration], s.
  Ticker(const Timing& timing, const RunSetup& run, double duration);

  std::optional<Tick> next();
  /// The delivery of a reading taken at `t` and ready to send no earlier than `ready`, s. Deliveries queue:
  /// none arrives before the one sent before it.
  Delivery sent(double t, double ready, const std::string& sensor, Reading reading);
  Delivery sent(double t, const std::string& sensor, Reading reading) {
    return sent(t, t, sensor, std::move(reading));
  }

 private:
  Timing timing_;
  RunSetup run_;
  double duration_;
  std::int64_t index_ = 0;
  RandomStream jitter_;
  RandomStream drops_;
  RandomStream latency_;
  Stamp last_arrival_ = Stamp::min();
};

}  // namespace pos::sim
