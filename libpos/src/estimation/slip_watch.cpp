#include "pos/estimation/slip_watch.hpp"

#include <algorithm>

namespace pos::estimation {

SlipAction SlipWatch::observe(const SlipEvidence& evidence) {
  if (since_) return whileIsolated(evidence);
  recent_.push_back(evidence.disagrees);
  if (static_cast<int>(recent_.size()) > config_.window) recent_.pop_front();
  if (config_.handling == SlipConfig::Handling::None) return SlipAction::Use;
  if (!evidence.disagrees) return SlipAction::Use;
  if (config_.handling == SlipConfig::Handling::Gate) return SlipAction::Skip;
  if (std::count(recent_.begin(), recent_.end(), true) < config_.exceedances) return SlipAction::Skip;
  since_ = evidence.stamp;
  agreements_ = 0;
  ++isolations_;
  return SlipAction::Isolate;
}

SlipAction SlipWatch::whileIsolated(const SlipEvidence& evidence) {
  agreements_ = evidence.velocities_agree ? agreements_ + 1 : 0;
  if (agreements_ >= config_.release_updates) return freed(SlipAction::Release);
  if (seconds(evidence.stamp - *since_) > config_.max_time || evidence.position_sigma > config_.max_sigma) {
    degraded_ = true;
    // Wheels that turn while the vehicle stands may turn as steadily as they like.
    if (evidence.wheels_steady && !evidence.standing) return freed(SlipAction::ForceBack);
  }
  return SlipAction::Stay;
}

SlipAction SlipWatch::freed(SlipAction how) {
  since_.reset();
  recent_.clear();
  degraded_ = false;
  return how;
}

void SlipWatch::forget() {
  since_.reset();
  recent_.clear();
  agreements_ = 0;
  degraded_ = false;
}

}  // namespace pos::estimation
