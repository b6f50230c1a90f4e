#include "pos/eval/compute_stats.hpp"

#include <algorithm>
#include <cmath>

namespace pos::eval {

void ComputeStats::add(Duration spent) {
  const double ns = std::max(static_cast<double>(spent.count()), kSmallest_ns);
  const auto bin = static_cast<std::size_t>(kBinsPerOctave * std::log2(ns / kSmallest_ns));
  ++bins_[std::min(bin, kBins - 1)];
  ++count_;
  total_ += spent;
  max_ = std::max(max_, spent);
}

double ComputeStats::microseconds(double probability) const {
  if (count_ == 0) return 0.0;
  const auto wanted = std::max(1.0, std::ceil(probability * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  std::size_t bin = 0;
  for (; bin + 1 < kBins; ++bin) {
    seen += bins_[bin];
    if (static_cast<double>(seen) >= wanted) break;
  }
  const double upper_ns = kSmallest_ns * std::exp2(static_cast<double>(bin + 1) / kBinsPerOctave);
  return 1e-3 * std::min(upper_ns, static_cast<double>(max_.count()));
}

double ComputeStats::realTimeFactor(Duration log_span) const {
  return total_ > Duration{0} ? seconds(log_span) / seconds(total_) : 0.0;
}

}  // namespace pos::eval
