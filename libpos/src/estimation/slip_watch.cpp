#include "pos/estimation/slip_watch.hpp"

#include <algorithm>
#include <cmath>

namespace pos::estimation {
namespace {

constexpr double kPower = 6.0;         // sigmas of the difference in a slip that would not be missed
constexpr double kSmallestSlip = 0.2;  // m/s, of a slip that began unseen
constexpr double kJumpWindow = 1.0;    // s, of the velocities that are compared

}  // namespace

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
  entry_jump_ = evidence.jump;
  went_back_ = false;
  ++isolations_;
  return SlipAction::Isolate;
}

/// Whether agreeing velocities say that the slip is over: when a difference half as large as it began with
/// would show at three sigmas; later, when the inertial velocity is too vague for that, only if the wheels
/// went back and are steady.
bool SlipWatch::told(const SlipEvidence& evidence) const {
  const double to_be_seen = entry_jump_ != 0.0 ? std::abs(entry_jump_) : kSmallestSlip;
  if (to_be_seen >= kPower * evidence.velocity_sigma) return true;
  return evidence.wheels_steady && (went_back_ || entry_jump_ == 0.0);
}

void SlipWatch::followJumps(const SlipEvidence& evidence) {
  const double time = seconds(evidence.stamp - *since_);
  const bool beginning = time < kJumpWindow;
  // The second in which the jump was seen may not have held the whole of it.
  if (beginning && evidence.jump * entry_jump_ > 0.0 && std::abs(evidence.jump) > std::abs(entry_jump_))
    entry_jump_ = evidence.jump;
  // It may also have been noise: then the wheels are where they were, soon after.
  const bool noise =
      beginning && time > 0.5 * kJumpWindow && std::abs(evidence.offset) < 0.5 * std::abs(entry_jump_);
  went_back_ = went_back_ || noise || evidence.jump * entry_jump_ < 0.0;
}

SlipAction SlipWatch::whileIsolated(const SlipEvidence& evidence) {
  followJumps(evidence);
  agreements_ = evidence.velocities_agree && told(evidence) ? agreements_ + 1 : 0;
  if (agreements_ >= config_.release_updates) return freed(SlipAction::Release);
  const bool worn_out = evidence.position_sigma > config_.max_sigma;
  degraded_ = degraded_ || worn_out || seconds(evidence.stamp - *since_) > config_.degraded_after;
  // Steady wheels prove nothing while the inertial velocity is still good: they may spin 30 % too fast as
  // steadily as they like, and on a standing vehicle for ever.
  const bool taken_back = worn_out && evidence.wheels_steady && !evidence.standing;
  return taken_back ? freed(SlipAction::ForceBack) : SlipAction::Stay;
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
