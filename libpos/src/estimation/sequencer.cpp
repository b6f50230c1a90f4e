#include "pos/estimation/sequencer.hpp"

#include <algorithm>
#include <tuple>

namespace pos::estimation {

bool Sequencer::later(const Waiting& a, const Waiting& b) {
  return std::tie(a.measurement.stamp, a.arrival) > std::tie(b.measurement.stamp, b.arrival);
}

void Sequencer::push(Measurement measurement) {
  newest_ = newest_ ? std::max(*newest_, measurement.stamp) : measurement.stamp;
  heap_.push_back({std::move(measurement), arrivals_++});
  // Without a lag one measurement waits at a time, and the heap need not touch it (bench/replay).
  if (heap_.size() > 1) std::push_heap(heap_.begin(), heap_.end(), later);
}

std::optional<Measurement> Sequencer::pop() {
  if (heap_.empty()) return std::nullopt;
  if (!finished_ && heap_.front().measurement.stamp > *newest_ - lag_) return std::nullopt;
  std::pop_heap(heap_.begin(), heap_.end(), later);
  std::optional<Measurement> next(std::move(heap_.back().measurement));
  heap_.pop_back();
  return next;
}

}  // namespace pos::estimation
