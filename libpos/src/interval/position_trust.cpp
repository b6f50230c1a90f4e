#include "pos/interval/position_trust.hpp"

#include <cmath>

namespace pos::interval {

void PositionTrust::forget() {
  trusted_ = true;
  last_.reset();
  anchor_.reset();
  believed_.reset();
}

void PositionTrust::prove(const TrackPoint& place) {
  forget();
  last_ = believed_ = place;
}

void PositionTrust::lose() {
  forget();
  trusted_ = false;
}

void PositionTrust::take(const TrackPoint& now, std::optional<double> speed, Report::Evidence evidence) {
  if (evidence == Report::Evidence::Passage) {
    trusted_ = true;
    anchor_.reset();
  } else if (last_) {
    const double dt = seconds(now.stamp - last_->stamp);
    const Step step = possible(dt, speed);
    const Gap gap = dt > rules_.stale_after ? Gap::Yes : Gap::No;
    if (trusted_) {
      doubt(now, step, gap);
    } else {
      weigh(now, step, gap);
    }
  } else {
    steady_since_ = now.stamp;
  }
  if (trusted_) believed_ = now;
  last_ = now;
}

PositionTrust::Step PositionTrust::possible(double dt, std::optional<double> speed) const {
  return speed ? Step{*speed * dt, rules_.speed_error * dt} : Step{0.0, max_speed_ * dt};
}

bool PositionTrust::plausible(const TrackPoint& now, const Step& step) const {
  return std::abs(now.distance - last_->distance - step.expected) <=
         step.slack + rules_.jump_sigmas * std::hypot(now.sigma, last_->sigma);
}

/// While trusted: does this report give cause for doubt?
void PositionTrust::doubt(const TrackPoint& now, const Step& step, Gap gap) {
  if (gap == Gap::No && plausible(now, step)) return;
  trusted_ = false;
  anchor_ = gap == Gap::Yes ? std::nullopt : last_;
  carried_ = step.expected;
  slack_ = step.slack;
  steady_since_ = now.stamp;
}

/// While in doubt: does this report end it?
void PositionTrust::weigh(const TrackPoint& now, const Step& step, Gap gap) {
  if (gap == Gap::No && plausible(now, step)) {
    carried_ += now.distance - last_->distance;
  } else {
    carried_ += step.expected;
    slack_ += step.slack;
    steady_since_ = now.stamp;
  }
  trusted_ = anchor_ ? back(now) : seconds(now.stamp - steady_since_) >= rules_.steady_for;
  if (trusted_) anchor_.reset();
}

/// Whether the report is where the vehicle can have come to from the anchor.
bool PositionTrust::back(const TrackPoint& now) const {
  return slack_ <= rules_.jump_slack &&
         std::abs(now.distance - anchor_->distance - carried_) <=
             slack_ + rules_.jump_sigmas * std::hypot(now.sigma, anchor_->sigma);
}

}  // namespace pos::interval
