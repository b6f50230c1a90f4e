#pragma once
/// When a simulated sensor measures and when its readings arrive. Common to all sensors.

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "pos/core/random.hpp"
#include "pos/core/stamp.hpp"
#include "pos/sim/motion.hpp"

namespace pos::sim {

/// A stretch of time, s since the scenario's start; a moment t is inside when from <= t < to.
struct TimeWindow {
  double from = 0.0;
  double to = 0.0;

  bool contains(double t) const { return from <= t && t < to; }
  bool operator==(const TimeWindow&) const = default;
};

struct SensorTiming {
  double rate = 100.0;            ///< Hz
  double phase = 0.0;             ///< s, first reading after the start of the scenario
  double latency = 0.0;           ///< s from measurement to arrival
  double jitter_sigma = 0.0;      ///< s, of the latency; a reading never arrives before it is made
  double stamp_offset = 0.0;      ///< s, added to every stamp: a clock that is off (a fault, not a latency)
  double loss_probability = 0.0;  ///< of each reading, 0..1
  std::vector<TimeWindow> outages = {};  ///< nothing arrives of what is measured then

  bool operator==(const SensorTiming&) const = default;
};

/// The timing itself when it makes sense; throws ConfigError with the key.
SensorTiming validated(const SensorTiming& timing);

/// Which of the independent sequences of one sensor a random number belongs to, so that switching one error
/// on leaves the others' numbers as they were.
enum class Purpose : unsigned { Timing = 0, Constants, Noise, Drift, Faults, Extra };

/// Where a sensor's random numbers come from: the scenario's seed and a number of its own (by convention
/// `streamOf(label)`, so that sensors do not depend on their order).
struct SensorSeed {
  std::uint64_t seed = 1;
  std::uint64_t stream = 0;

  /// `part` tells apart like things in one sensor (its gyros from its accelerometers, left from right).
  RandomStream sequence(Purpose purpose, unsigned part = 0) const {
    return RandomStream(seed, stream * 64U + part * 8U + static_cast<std::uint64_t>(purpose));
  }
};

/// What every sensor stream is told beside its own model.
struct StreamContext {
  std::shared_ptr<const Motion> motion = {};
  SensorSeed seed = {};
  Stamp start = {};       ///< stamp of t = 0
  double duration = 0.0;  ///< s, nothing is measured later
};

/// A stream number from a sensor's label (64-bit FNV-1a, its upper six bits given up).
std::uint64_t streamOf(std::string_view label);

/// Walks through a sensor's moments and says what becomes of each. Moment k is at phase + k / rate, computed
/// from k, so that nothing adds up over hours.
class SensorClock {
 public:
  SensorClock(const SensorTiming& timing, SensorSeed seed, Stamp start);

  /// One moment: when, how it will be stamped and when it arrives; arrivals do not overtake each other.
  struct Tick {
    double t = 0.0;  ///< s since the start
    Stamp stamp = {};
    Stamp arrival = {};
    bool lost = false;  ///< measured, but it never arrives
  };
  /// The next moment; the caller ends when t passes the scenario's end.
  Tick next();

 private:
  SensorTiming timing_;
  RandomStream random_;
  Stamp start_;
  Stamp last_arrival_ = {};
  std::uint64_t count_ = 0;
};

}  // namespace pos::sim
