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
  const double off = std::abs(now.distance - track_->distance) / rules_.jump_sigmas;
  const bool possible = !gap && off <= std::hypot(now.sigma, track_->sigma);
  // What the dead reckoning no longer excludes may still be more than two good reports differ by.
  const bool steady = possible && off <= std::sqrt(2.0) * now.sigma;
  switch (state_) {
    case State::Trusted:
      if (steady) {
        adopt(now);
      } else if (gap || possible) {
        state_ = State::AfterGap;
        restart(now);
      } else {
        state_ = State::AfterJump;
      }
      break;
    case State::AfterGap:
      if (steady) {
        adopt(now);
        if (seconds(now.stamp - steady_since_) >= rules_.steady_for) state_ = State::Trusted;
      } else {
        restart(now);
      }
      break;
    case State::AfterJump:
      if (!steady || rules_.jump_sigmas * track_->sigma > rules_.jump_slack) break;
      state_ = State::Trusted;
      adopt(now);
      break;
  }
}

/// The better of dead reckoning and report; they are not averaged, because reports err alike for a while and
/// would pull the track after them.
void PositionTrust::adopt(const TrackPoint& now) {
  if (now.sigma <= track_->sigma) track_ = now;
}

}  // namespace pos::interval
