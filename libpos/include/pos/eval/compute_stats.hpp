#pragma once
/// How long an estimator took per measurement. Durations are handed in; nothing here reads a clock.

#include <array>
#include <cstdint>

#include "pos/core/stamp.hpp"

namespace pos::eval {

/// Times in bins that are 4.4 % wide (16 per factor of two) from 10 ns to about 170 s, so the memory is fixed
/// and a percentile is good to that width.
class ComputeStats {
 public:
  void add(Duration spent);

  std::uint64_t count() const { return count_; }
  Duration total() const { return total_; }
  Duration max() const { return max_; }
  /// Upper edge of the bin that holds this share of the times, at most the longest; us. 0 when empty.
  double microseconds(double probability) const;
  /// Length of the log / time spent on it: 50 = fifty times faster than real time. 0 when nothing was timed.
  double realTimeFactor(Duration log_span) const;

 private:
  static constexpr int kBinsPerOctave = 16;
  static constexpr std::size_t kBins = std::size_t{16} * 34;
  static constexpr double kSmallest_ns = 10.0;

  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  Duration total_{0};
  Duration max_{0};
};

}  // namespace pos::eval
