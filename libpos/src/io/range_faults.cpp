#include "pos/io/range_faults.hpp"

#include <algorithm>

#include "pos/core/random.hpp"

namespace pos::io {
namespace {
constexpr double kShortest = 0.05;  // m, a radio never reports less
}  // namespace

Measurement RangeFaults::applied(Measurement measurement) {
  auto* range = std::get_if<BeaconRange>(&measurement.reading);
  if (range == nullptr || rates_.probability <= 0.0) return measurement;
  RandomStream random(rates_.seed, ranges_++);
  if (!random.bernoulli(rates_.probability)) return measurement;
  const double sign = random.bernoulli(0.5) ? 1.0 : -1.0;
  range->range = std::max(kShortest, range->range + sign * random.uniform(rates_.min, rates_.max));
  ++count_;
  return measurement;
}

}  // namespace pos::io
