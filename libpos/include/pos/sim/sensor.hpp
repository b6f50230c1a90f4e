#pragma once
/// A simulated sensor: a stream of measurements made one at a time, so that hours need no memory.

#include <optional>

#include "pos/core/measurement.hpp"

namespace pos::sim {

/// A measurement and the moment the recorder gets it. `measurement.stamp` is when it was measured.
struct Delivery {
  Stamp arrival = {};
  Measurement measurement = {};
};

/// One sensor of a scenario. Same seed, same deliveries, bit for bit, whoever else runs.
class SensorStream {
 public:
  SensorStream() = default;
  SensorStream(const SensorStream&) = delete;
  SensorStream& operator=(const SensorStream&) = delete;
  SensorStream(SensorStream&&) = delete;
  SensorStream& operator=(SensorStream&&) = delete;
  virtual ~SensorStream() = default;

  /// The next delivery, in order of arrival; nothing when the scenario is over.
  virtual std::optional<Delivery> next() = 0;
};

}  // namespace pos::sim
