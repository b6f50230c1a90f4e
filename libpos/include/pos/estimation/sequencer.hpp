#pragma once
/// Puts measurements of several sensors into one time order, within a declared lag.

#include <cstdint>
#include <optional>
#include <vector>

#include "pos/core/measurement.hpp"

namespace pos::estimation {

/// Holds measurements back until `lag` of log time has passed, then gives them out by stamp; equal stamps
/// keep the order they came in. A measurement that comes later than the lag allows is given out at once, out
/// of order: the estimators answer it with TooOld, and that is counted. Memory: the measurements of one lag.
class Sequencer {
 public:
  explicit Sequencer(Duration lag) : lag_(lag) {}

  void push(Measurement measurement);
  /// The next measurement that nothing within the lag can precede any more.
  std::optional<Measurement> pop();
  /// No more measurements will come: the rest may go.
  void finish() { finished_ = true; }

 private:
  struct Waiting {
    Measurement measurement;
    std::uint64_t arrival;
  };
  static bool later(const Waiting& a, const Waiting& b);

  Duration lag_;
  std::vector<Waiting> heap_;
  std::optional<Stamp> newest_;
  std::uint64_t arrivals_ = 0;
  bool finished_ = false;
};

}  // namespace pos::estimation
