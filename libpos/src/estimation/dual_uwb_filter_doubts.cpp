// When the filter doubts itself: its velocity, or which way it faces.
#include <algorithm>
#include <cmath>

#include "pos/core/square.hpp"
#include "pos/estimation/dual_uwb_filter.hpp"

namespace pos::estimation {
namespace {

constexpr double kBackwards = 1.0;    // s of driving backwards that raise an alarm
constexpr int kFewestRejections = 3;  // in a row, before all anchors can be said to disagree
constexpr double kCrawl = 0.2;        // m/s, slower than this has no direction

}  // namespace

/// As many rejections in a row as anchors are heard: it is not the anchors, the vehicle did what the model
/// does not expect.
bool DualUwbFilter::allDisagree(Stamp stamp, Verdict verdict) {
  if (verdict == Verdict::Applied) {
    applied_stamp_ = stamp;
    rejected_in_row_ = 0;
    return false;
  }
  if (++rejected_in_row_ < std::max(kFewestRejections, watch_.heardLately(stamp).anchors)) return false;
  rejected_in_row_ = 0;
  return true;
}

/// The velocity may be any, and since the last range that passed the pose went along with it.
void DualUwbFilter::doubtVelocity(Stamp stamp) {
  ++doubts_;
  still_until_.reset();
  const double dt = applied_stamp_ ? std::min(seconds(stamp - *applied_stamp_), 1.0) : 1.0;
  const double speed = square(0.5 * config_.max_speed);
  const double rate = square(0.5 * config_.max_yaw_rate);
  for (DualUwbHypothesis& h : bank_.hypotheses()) {
    auto diagonal = h.belief.covariance.diagonal();
    diagonal.head<2>().array() += speed * dt * dt;
    diagonal[2] += rate * dt * dt;
    for (int row = DualUwbLayout::velocityRow(); row < layout_.rateRow(); ++row) diagonal[row] += speed;
    if (!layout_.gyro()) diagonal[layout_.rateRow()] += rate;
  }
}

bool DualUwbFilter::backwards(const DualUwbHypothesis& hypothesis, Stamp stamp) const {
  const PlanarTwist twist = twistOf(hypothesis.belief, layout_, config_, gyroAt(stamp));
  return twist.rates[0] < -kCrawl && twist.rates[0] < -3.0 * std::sqrt(twist.covariance(0, 0));
}

/// Swapped tags and mirror images turn the vehicle round: it seems to drive backwards for good.
std::string_view DualUwbFilter::alarm(Stamp stamp) {
  if (!config_.never_reverses) return {};
  if (!backwards(bank_.best(), stamp)) {
    backwards_since_.reset();
    alarmed_ = false;
    return {};
  }
  if (!backwards_since_) backwards_since_ = stamp;
  if (alarmed_ || stamp - *backwards_since_ < durationFromSeconds(kBackwards)) return {};
  alarmed_ = true;
  ++alarms_;
  return "drives backwards, which it never does: are the tags swapped?";
}

/// Wheels that turn one way while the tags go the other pull the filter apart: it fits half of the anchors at
/// most.
std::string_view DualUwbFilter::wheelsAtOdds(Stamp stamp, double speed) {
  const AnchorWatch::Heard heard = watch_.heardLately(stamp);
  if (heard.anchors < 2 || 2 * heard.disagreeing < heard.anchors || std::abs(speed) < kCrawl) {
    at_odds_since_.reset();
    return {};
  }
  if (!at_odds_since_) at_odds_since_ = stamp;
  if (stamp - *at_odds_since_ < durationFromSeconds(kBackwards)) return {};
  at_odds_since_ = stamp;
  ++alarms_;
  return "wheels and ranges do not go together: are the tags swapped?";
}

}  // namespace pos::estimation
