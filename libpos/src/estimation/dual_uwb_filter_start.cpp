// How the filter finds its first pose, and finds itself again.
#include <cmath>

#include "pos/core/square.hpp"
#include "pos/estimation/dual_uwb_filter.hpp"

namespace pos::estimation {
namespace {

constexpr double kGatherTime = 1.0;  // s, ranges older than this do not help to find the first pose
constexpr int kAttempts = 10;        // cycles of ranges that disagree before they are taken all the same
constexpr double kStillSpeed = 0.1;  // m/s, how still a vehicle stands that is known to stand
constexpr double kStillRate = 0.05;  // rad/s

}  // namespace

Belief<DualUwbState> DualUwbFilter::startBelief(const Belief<Pose2>& pose) const {
  const int n = layout_.size();
  Belief<DualUwbState> belief;
  belief.mean.values = DualUwbState::Values::Zero(n);
  belief.mean.values.head<3>() << pose.mean.x, pose.mean.y, pose.mean.yaw;
  belief.covariance = TangentMatrix<DualUwbState>::Zero(n, n);
  belief.covariance.topLeftCorner<3, 3>() = pose.covariance;
  const bool still = config_.still_at_start > 0.0;
  const double speed_sigma = still ? kStillSpeed : 0.5 * config_.max_speed;
  const double rate_sigma = still ? kStillRate : 0.5 * config_.max_yaw_rate;
  const int rate = layout_.rateRow();
  for (int row = DualUwbLayout::velocityRow(); row < rate; ++row)
    belief.covariance(row, row) = square(speed_sigma);
  belief.covariance(rate, rate) = square(layout_.gyro() ? config_.gyro_bias.sigma : rate_sigma);
  if (layout_.gyro()) belief.mean.values[rate] = config_.gyro_bias.value;
  belief.mean.values.tail(layout_.links()).setConstant(config_.link_bias.value);
  belief.covariance.diagonal().tail(layout_.links()).setConstant(square(config_.link_bias.sigma));
  return belief;
}

/// All that hangs on the pose: back to where no pose is known.
void DualUwbFilter::forget() {
  bank_ = {};
  early_.clear();
  attempts_ = 0;
  watch_.forget();
  still_until_.reset();
  course_held_.reset();
  backwards_since_.reset();
  alarmed_ = false;
  at_odds_since_.reset();
  applied_stamp_.reset();
  rejected_in_row_ = 0;
}

void DualUwbFilter::restart() {
  forget();
  ++restarts_;
}

/// The first measurement that counts: where the start is known, the filter begins there.
void DualUwbFilter::begin(Stamp stamp) {
  last_stamp_ = stamp;
  if (state_stamp_) return;
  state_stamp_ = stamp;
  if (config_.start.mode != StartMode::Known) return;
  bank_ = DualUwbBank({{startBelief(knownStart(config_.start)), 0.0}});
  still_until_ = stamp + durationFromSeconds(config_.still_at_start);
}

IngestReport DualUwbFilter::gather(Stamp stamp, const UwbReading& reading) {
  early_.dropBefore(stamp - durationFromSeconds(kGatherTime));
  const bool cycle_complete = early_.holds(reading);
  IngestReport report{.verdict = Verdict::NotInitialised, .reason = "gathering ranges for the first pose"};
  if (cycle_complete) {
    const auto aged = early_.agedRanges(stamp, 0.5 * config_.max_speed);
    const uwb::RigidFixes fixes =
        uwb::rigidFixes({aged.data(), early_.ranges().size()}, config_.body_height, residual_test_);
    if (fixes.count > 0 && (fixes.fixes[0].consistent || ++attempts_ > kAttempts)) {
      start(stamp, fixes);
      report = correctRange(stamp, reading);
      report.event = "first pose found from the ranges";
      return report;
    }
  }
  early_.add(stamp, reading);
  return report;
}

void DualUwbFilter::start(Stamp stamp, const uwb::RigidFixes& fixes) {
  std::vector<DualUwbHypothesis> hypotheses;
  for (const uwb::RigidFix& fix : fixes.all()) {
    hypotheses.push_back({startBelief(fix.pose), -0.5 * fix.chi_square});
  }
  if (config_.start.mode == StartMode::UnknownHeading && restarts_ == 0) {
    for (DualUwbHypothesis& h : hypotheses) {
      const Eigen::Vector2d apart = h.belief.mean.values.head<2>() - config_.start.pose.translation();
      h.log_weight -= 0.5 * apart.squaredNorm() / square(3.0 * config_.start.position_sigma);
    }
  }
  bank_ = DualUwbBank(std::move(hypotheses));
  early_.clear();
  attempts_ = 0;
  state_stamp_ = stamp;
  if (!still_until_ && restarts_ == 0) still_until_ = stamp + durationFromSeconds(config_.still_at_start);
  settle(stamp);
}

}  // namespace pos::estimation
