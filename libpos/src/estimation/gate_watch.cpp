#include "pos/estimation/gate_watch.hpp"

namespace pos::estimation {
namespace {
constexpr int kFewestRejections = 4;  // a gate that closed once or twice has not locked anything out
constexpr int kPatienceWithOne = 3;   // times open_after while a single anchor is heard
}  // namespace

bool GateWatch::opens(Stamp stamp, AnchorId anchor, Verdict verdict) {
  const Duration span = durationFromSeconds(config_.open_after);
  note({stamp, anchor, verdict == Verdict::Applied});
  dropOlderThan(stamp - span);
  if (agreement()) {
    disagreeing_since_.reset();
    rejected_ = 0;
    openings_ = 0;
    return false;
  }
  if (!disagreeing_since_) disagreeing_since_ = stamp;
  if (verdict == Verdict::Gated) ++rejected_;
  const int patience = tallies_.size() > 1 ? 1 : kPatienceWithOne;
  if (stamp - *disagreeing_since_ < patience * span || rejected_ < kFewestRejections) return false;
  disagreeing_since_ = stamp;
  rejected_ = 0;
  ++openings_;
  return true;
}

void GateWatch::forget() {
  *this = GateWatch(config_);
}

void GateWatch::note(const Heard& heard) {
  window_.push_back(heard);
  Tally& tally = tallies_[heard.anchor];
  ++tally.heard;
  tally.passed += heard.passed ? 1 : 0;
}

void GateWatch::dropOlderThan(Stamp stamp) {
  while (!window_.empty() && window_.front().stamp < stamp) {
    const auto tally = tallies_.find(window_.front().anchor);
    tally->second.passed -= window_.front().passed ? 1 : 0;
    if (--tally->second.heard == 0) tallies_.erase(tally);
    window_.pop_front();
  }
}

bool GateWatch::agreement() const {
  int agreeing = 0;
  for (const auto& [anchor, tally] : tallies_) agreeing += 2 * tally.passed >= tally.heard ? 1 : 0;
  return agreeing > 0 && agreeing >= config_.agreement_fraction * static_cast<double>(tallies_.size());
}

}  // namespace pos::estimation
