#pragma once
/// Damage done to ranges on purpose, to see what the estimators make of it.

#include <cstdint>

#include "pos/core/measurement.hpp"

namespace pos::io {

/// A share `probability` of the ranges gets an error of +-U(min, max) m, each sign as likely.
struct RangeFaultRates {
  double probability = 0.0;
  double min = 3.0;   ///< m
  double max = 20.0;  ///< m
  std::uint64_t seed = 1;
};

/// Applies faults to a stream. What happens to the k-th range depends on seed and k alone.
class RangeFaults {
 public:
  explicit RangeFaults(const RangeFaultRates& rates) : rates_(rates) {}

  /// The measurement, spoilt when its turn has come; a spoilt range stays at least 0.05 m. Others pass
  /// untouched.
  Measurement applied(Measurement measurement);
  std::uint64_t count() const { return count_; }

 private:
  RangeFaultRates rates_;
  std::uint64_t ranges_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace pos::io
