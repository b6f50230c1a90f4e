#include "pos/estimation/anchor_watch.hpp"

namespace pos::estimation {

bool AnchorWatch::blocked(int anchor, Stamp stamp) const {
  const State& state = anchors_[static_cast<std::size_t>(anchor)];
  return state.blocked_until && stamp < *state.blocked_until;
}

AnchorWatch::Heard AnchorWatch::heardLately(Stamp stamp) const {
  const Stamp lately = stamp - durationFromSeconds(config_.restart_after);
  Heard heard;
  for (const State& state : anchors_) {
    if (!state.heard || *state.heard < lately) continue;
    ++heard.anchors;
    heard.disagreeing += state.agrees ? 0 : 1;
  }
  return heard;
}

AnchorWatch::Finding AnchorWatch::note(int anchor, Stamp stamp, std::optional<Verdict> tested) {
  State& state = anchors_[static_cast<std::size_t>(anchor)];
  state.heard = stamp;
  Finding finding = Finding::None;
  if (tested == Verdict::Applied) {
    state.rejections = 0;
    state.agrees = true;
  } else if (tested) {
    state.agrees = false;
    if (++state.rejections >= config_.blocked_after) {
      state.rejections = 0;
      state.blocked_until = stamp + durationFromSeconds(config_.blocked_for);
      finding = Finding::Blocked;
    }
  }
  if (state.agrees && !disagreeing_since_) return finding;  // the usual case: nothing to count
  if (agreement(stamp)) {
    disagreeing_since_.reset();
    return finding;
  }
  if (!disagreeing_since_) disagreeing_since_ = stamp;
  return stamp - *disagreeing_since_ >= durationFromSeconds(config_.restart_after) ? Finding::Lost : finding;
}

/// Of the anchors heard lately, enough agree.
bool AnchorWatch::agreement(Stamp stamp) const {
  const Heard heard = heardLately(stamp);
  const int agreeing = heard.anchors - heard.disagreeing;
  return agreeing > 0 && agreeing >= config_.agreement_fraction * heard.anchors;
}

void AnchorWatch::forget() {
  anchors_.assign(anchors_.size(), State{});
  disagreeing_since_.reset();
}

}  // namespace pos::estimation
