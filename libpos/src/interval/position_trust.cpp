#include "pos/interval/position_trust.hpp"

#include <algorithm>
#include <cmath>

namespace pos::interval {

void PositionTrust::forget() {
  state_ = State::Trusted;
  track_.reset();
  believed_.reset();
}

void PositionTrust::prove(const TrackPoint& place) {
  forget();
  track_ = believed_ = place;
}

void PositionTrust::lose() {
  forget();
  state_ = State::AfterGap;
}

void PositionTrust::restart(const TrackPoint& now) {
  track_ = now;
  steady_since_ = now.stamp;
}

void PositionTrust::take(const TrackPoint& now, std::optional<double> speed, Report::Evidence evidence) {
  if (evidence == Report::Evidence::Passage) {
    state_ = State::Trusted;
    restart(now);
  } else if (!track_) {
    restart(now);
  } else {
    weigh(now, speed);
  }
  if (trusted()) believed_ = track_;
}

void PositionTrust::weigh(const TrackPoint& now, std::optional<double> speed) {
  const double dt = seconds(now.stamp - track_->stamp);
  const bool gap = dt > rules_.stale_after;
  const double slack = speed && !gap ? rules_.speed_error * dt : max_speed_ * dt;
  if (speed && !gap) track_->distance += *speed * dt;
  track_->sigma += slack / rules_.jump_sigmas;
  track_->stamp = now.stamp;
  const bool agrees =
      std::abs(now.distance - track_->distance) <= rules_.jump_sigmas * std::hypot(now.sigma, track_->sigma);
  switch (state_) {
    case State::Trusted:
      if (gap) {
        state_ = State::AfterGap;
        restart(now);
      } else if (agrees) {
        fuse(now);
      } else {
        state_ = State::AfterJump;
      }
      break;
    case State::AfterGap:
      if (gap || !agrees) {
        restart(now);
      } else {
        fuse(now);
        if (seconds(now.stamp - steady_since_) >= rules_.steady_for) state_ = State::Trusted;
      }
      break;
    case State::AfterJump:
      if (gap || !agrees || rules_.jump_sigmas * track_->sigma > rules_.jump_slack) break;
      state_ = State::Trusted;
      fuse(now);
      break;
  }
}

void PositionTrust::fuse(const TrackPoint& now) {
  const double P = track_->sigma * track_->sigma;
  const double R = now.sigma * now.sigma;
  if (P + R > 0.0) track_->distance += P / (P + R) * (now.distance - track_->distance);
  track_->sigma = std::min(track_->sigma, now.sigma);
}

}  // namespace pos::interval
