#include "pos/estimation/imu_track.hpp"

#include <algorithm>

namespace pos::estimation {
namespace {

constexpr double kHold = 0.1;     // s that a sample is held when the next one does not come
constexpr double kSilent = 0.25;  // s between samples beyond which they say nothing of the time between
constexpr double kNoTime = 1e-9;  // s

}  // namespace

ImuTrack::Share ImuTrack::held(double dt) const {
  Share share;
  const double room = rate_ ? std::max(0.0, kHold - ahead_.dt) : 0.0;
  const double hold = std::min(dt, room);
  if (hold > 0.0) share.increment = {hold * rate_->angle, hold * rate_->velocity, hold};
  share.coast = dt - hold;
  return share;
}

void ImuTrack::note(const Share& share) {
  ahead_.angle += share.increment.angle;
  ahead_.velocity += share.increment.velocity;
  ahead_.dt += share.increment.dt + share.coast;
}

ImuTrack::Share ImuTrack::arrived(const ins::ImuIncrement& raw) {
  Share share;
  if (raw.dt <= 0.0) return share;
  const double left = raw.dt - ahead_.dt;
  if (raw.dt > kSilent) {
    share.coast = std::max(0.0, left);
    share.was_silent = true;
    owed_ = {};
  } else {
    owed_.angle += raw.angle - ahead_.angle;
    owed_.velocity += raw.velocity - ahead_.velocity;
    if (left > kNoTime) {
      share.increment = {owed_.angle, owed_.velocity, left};
      owed_ = {};
    }
  }
  rate_ = ins::ImuIncrement{raw.angle / raw.dt, raw.velocity / raw.dt, 1.0};
  ahead_ = {};
  return share;
}

}  // namespace pos::estimation
