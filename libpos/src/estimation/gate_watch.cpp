#include "pos/estimation/gate_watch.hpp"

namespace pos::estimation {
namespace {
constexpr int kFewestRejections = 4;  // a gate that closed once or twice has not locked anything out
constexpr int kPatienceWithOne = 3;   // times open_after while a single anchor is heard
}  // namespace

bool GateWatch::opens(Stamp stamp, AnchorId anchor, Verdict verdict) {
  Heard& heard = heard_[anchor];
  heard.last = stamp;
  if (verdict == Verdict::Applied) heard.passed = stamp;
  const Duration window = durationFromSeconds(config_.open_after);
  if (agreement(stamp - window)) {
    disagreeing_since_.reset();
    rejected_ = 0;
    openings_ = 0;
    return false;
  }
  if (!disagreeing_since_) disagreeing_since_ = stamp;
  if (verdict == Verdict::Gated) ++rejected_;
  const int patience = heardSince(stamp - window) > 1 ? 1 : kPatienceWithOne;
  if (stamp - *disagreeing_since_ < patience * window || rejected_ < kFewestRejections) return false;
  disagreeing_since_ = stamp;
  rejected_ = 0;
  ++openings_;
  return true;
}

void GateWatch::forget() {
  *this = GateWatch(config_);
}

bool GateWatch::agreement(Stamp since) const {
  int passed = 0;
  for (const auto& [anchor, heard] : heard_) passed += heard.passed && *heard.passed >= since ? 1 : 0;
  return passed > 0 && passed >= config_.agreement_fraction * heardSince(since);
}

int GateWatch::heardSince(Stamp since) const {
  int count = 0;
  for (const auto& [anchor, heard] : heard_) count += heard.last >= since ? 1 : 0;
  return count;
}

}  // namespace pos::estimation
