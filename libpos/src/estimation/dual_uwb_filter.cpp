#include "pos/estimation/dual_uwb_filter.hpp"

#include <algorithm>
#include <cmath>

#include "parts.hpp"
#include "pos/core/chi_square.hpp"
#include "pos/core/error.hpp"

namespace pos::estimation {
namespace {

constexpr double kCoursePeriod = 0.1;  // s between two constraints of a free vehicle

using Told = filters::Correction<1>;

IngestReport reportOf(const Told& told) {
  IngestReport report{.verdict = told.verdict, .dof = Told::kDof};
  report.nis = told.nis;
  report.innovation = told.nu[0];
  report.innovation_sigma = std::sqrt(told.S(0, 0));
  if (told.verdict == Verdict::Gated) report.reason = "reading disagrees with the prediction";
  if (told.verdict == Verdict::Degenerate) report.reason = "innovation covariance is not positive";
  return report;
}

double logLikelihood(const Told& told) {
  if (told.verdict == Verdict::Degenerate) return likelihood::logOfOutlier();  // S is no variance
  return logSum(likelihood::logOfGood(told.nis, told.S(0, 0)), likelihood::logOfOutlier());
}

Belief<Pose2> poseOf(const Belief<DualUwbState>& state) {
  return {state.mean.pose(), state.covariance.topLeftCorner<3, 3>()};
}

}  // namespace

DualUwbFilter::DualUwbFilter(const DualUwbConfig& config, std::shared_ptr<const map::TunnelMap> map)
    : config_(config),
      roadway_(config, map),
      links_(config, *map),
      layout_(config, links_.anchors()),
      gate_{chiSquareQuantile(config.gate.confidence, 1.0)},
      residual_test_(config.fit_significance),
      watch_(config.gate, links_.anchors()) {}

void DualUwbFilter::reset(Stamp stamp, const Belief<Pose2>& prior) {
  forget();
  gyro_stamp_.reset();
  bank_ = DualUwbBank({{startBelief(prior), 0.0}});
  state_stamp_ = last_stamp_ = stamp;
  still_until_ = stamp + durationFromSeconds(config_.still_at_start);
}

IngestReport DualUwbFilter::ingest(const Measurement& measurement) {
  if (const auto refused = refusedUnseen(measurement, last_stamp_)) return *refused;
  return std::visit([&](const auto& reading) { return take(measurement.stamp, reading); },
                    measurement.reading);
}

IngestReport DualUwbFilter::take(Stamp stamp, const BeaconRange& range) {
  const UwbLookUp looked_up = links_.find(range);
  if (looked_up.verdict != Verdict::Applied) return refusal(looked_up.verdict, looked_up.reason);
  begin(stamp);
  if (bank_.empty()) return gather(stamp, looked_up.reading);
  carryTo(stamp);
  return correctRange(stamp, looked_up.reading);
}

IngestReport DualUwbFilter::take(Stamp stamp, const ImuSample& imu) {
  if (!layout_.gyro()) return refusal(Verdict::Unsupported, "variant filter has no use for a gyro");
  double rate = imu.angular.z();
  if (imu.kind == ImuSample::Kind::Increments) {
    const double interval = imu.interval ? seconds(*imu.interval) : 0.0;
    if (!(interval > 0.0)) return refusal(Verdict::Degenerate, "a turn without the time it took");
    rate /= interval;
  }
  begin(stamp);
  if (gyro_stamp_ && !bank_.empty()) {
    // rates are samples of a moment: over the interval their mean; increments hold for all of it
    const bool increment = imu.kind == ImuSample::Kind::Increments;
    gyro_rate_ = increment ? rate : 0.5 * (gyro_rate_ + rate);
    gyro_stamp_ = stamp;
    carryTo(stamp);
  }
  gyro_rate_ = rate;
  gyro_stamp_ = stamp;
  if (bank_.empty()) return refusal(Verdict::NotInitialised, "waiting for ranges that fix the first pose");
  return {.verdict = Verdict::Applied};
}

IngestReport DualUwbFilter::take(Stamp stamp, const WheelSpeeds& wheels) {
  if (config_.wheel_speed_sigma <= 0.0)
    return refusal(Verdict::Unsupported, "wheel speeds are switched off (wheel_speed_sigma 0)");
  begin(stamp);
  const double speed = 0.5 * (wheels.left + wheels.right);
  if (bank_.empty()) return refusal(Verdict::NotInitialised, "waiting for ranges that fix the first pose");
  carryTo(stamp);
  const Matrix<1, 1> R(square(config_.wheel_speed_sigma));
  Told told;
  for (std::size_t i = 0; i < bank_.size(); ++i) {
    DualUwbHypothesis& h = bank_.hypotheses()[i];
    const auto row = wheelInnovation(h.belief.mean, layout_, config_, speed, gyroAt(stamp));
    const Told c = filters::correct(h.belief, row, R, gate_);
    h.log_weight += logLikelihood(c);
    if (i == bank_.bestIndex()) told = c;
  }
  settle(stamp);
  IngestReport report = reportOf(told);
  report.event = wheelsAtOdds(stamp, speed);
  return report;
}

/// The last rate with its age. Without one, or with one so old that the true rate may be any, the age at
/// which the largest yaw rate is within one sigma.
GyroInput DualUwbFilter::gyroAt(Stamp stamp) const {
  const double any = square(config_.max_yaw_rate / config_.yaw_acceleration_density);
  if (!gyro_stamp_) return {0.0, layout_.gyro() ? any : 0.0};
  return {gyro_rate_, std::clamp(seconds(stamp - *gyro_stamp_), 0.0, any)};
}

DualUwbStep DualUwbFilter::stepTo(const DualUwbState& x, Stamp stamp) const {
  const DualUwbMotion motion{&layout_, &config_};
  const double dt = seconds(stamp - *state_stamp_);
  const bool standing = still_until_ && stamp <= *still_until_;
  return standing ? motion.standing(x, dt) : motion.step(x, gyroAt(*state_stamp_), dt);
}

Belief<DualUwbState> DualUwbFilter::carried(Belief<DualUwbState> belief, Stamp stamp) const {
  if (stamp > *state_stamp_) predict(belief, stepTo(belief.mean, stamp));
  return belief;
}

void DualUwbFilter::carryTo(Stamp stamp) {
  if (stamp <= *state_stamp_) return;
  for (DualUwbHypothesis& h : bank_.hypotheses()) predict(h.belief, stepTo(h.belief.mean, stamp));
  state_stamp_ = stamp;
  holdCourse(stamp);
}

/// Free motion: the wheels keep the vehicle from sliding, softly.
void DualUwbFilter::holdCourse(Stamp stamp) {
  if (layout_.vehicle() || config_.lateral_sigma <= 0.0) return;
  if (course_held_ && stamp - *course_held_ < durationFromSeconds(kCoursePeriod)) return;
  course_held_ = stamp;
  for (DualUwbHypothesis& h : bank_.hypotheses()) {
    const auto row = lateralInnovation(h.belief.mean, layout_, config_, gyroAt(stamp));
    (void)filters::correct(h.belief, row, Matrix<1, 1>(square(config_.lateral_sigma)));
  }
}

/// Every hypothesis corrected by the range; what is told is the best one's.
Told DualUwbFilter::corrected(const UwbReading& reading) {
  const Matrix<1, 1> R(square(reading.range.sigma));
  Told told;
  for (std::size_t i = 0; i < bank_.size(); ++i) {
    DualUwbHypothesis& h = bank_.hypotheses()[i];
    const auto row = rangeInnovation(h.belief.mean, layout_, reading.range, config_.body_height, reading.tag,
                                     reading.anchor);
    const Told c = filters::correct(h.belief, row, R, gate_);
    if (bank_.size() > 1) h.log_weight += logLikelihood(c);
    if (i == bank_.bestIndex()) told = c;
  }
  return told;
}

IngestReport DualUwbFilter::correctRange(Stamp stamp, const UwbReading& reading) {
  const int anchor = reading.anchor;
  if (watch_.blocked(anchor, stamp)) {
    const auto finding = watch_.note(anchor, stamp, std::nullopt);
    IngestReport report = refusal(Verdict::Gated, "its anchor is taken to be hidden for now");
    if (finding == AnchorWatch::Finding::Lost) {
      restart();
      report.event = "most anchors disagree: starting over from the ranges";
    }
    return report;
  }
  Told told = corrected(reading);
  IngestReport report = reportOf(told);
  report.event = alarm(stamp);
  if (allDisagree(stamp, told.verdict)) {
    doubtVelocity(stamp);
    told = corrected(reading);
    report = reportOf(told);
    report.event = "all anchors disagree at once: the velocity is made unsure";
  }
  switch (watch_.note(anchor, stamp, told.verdict)) {
    case AnchorWatch::Finding::None:
      break;
    case AnchorWatch::Finding::Blocked:
      ++blockings_;
      report.event = "an anchor is rejected time and again: taken to be hidden";
      break;
    case AnchorWatch::Finding::Lost:
      restart();
      report.event = "most anchors disagree: starting over from the ranges";
      return report;
  }
  settle(stamp);
  return report;
}

/// Drops hypotheses off the roadway while others are on it, and those that drive backwards where that cannot
/// be.
void DualUwbFilter::settle(Stamp stamp) {
  if (bank_.size() > 1) {
    bank_.keep(
        [&](const DualUwbHypothesis& h) { return roadway_.inside(h.belief.mean.pose().translation()); });
    if (config_.never_reverses) bank_.keep([&](const DualUwbHypothesis& h) { return !backwards(h, stamp); });
  }
  bank_.settle();
}

std::optional<Estimate> DualUwbFilter::estimateAt(Stamp stamp) const {
  if (bank_.empty() || stamp < *state_stamp_) return std::nullopt;
  const Belief<DualUwbState> state = carried(bank_.best().belief, stamp);
  Matrix<3, 3> covariance = poseOf(state).covariance;
  if (bank_.size() > 1) {  // the best one's pose with the spread of all of them about it
    covariance.setZero();
    const std::vector<double> weights = bank_.weights();
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const Belief<DualUwbState> other = carried(bank_.hypotheses()[i].belief, stamp);
      covariance += spreadAbout(state.mean.pose(), poseOf(other), weights[i]);
    }
  }
  Estimate estimate = planarEstimate(stamp, state.mean.pose(), covariance, config_.body_height);
  estimate.twist = twistOf(state, layout_, config_, gyroAt(stamp));
  return estimate;
}

Diagnostics DualUwbFilter::diagnostics() const {
  Diagnostics values{{"hypotheses", static_cast<double>(bank_.size())},
                     {"restarts", static_cast<double>(restarts_)},
                     {"anchors_blocked", static_cast<double>(blockings_)},
                     {"velocity_doubts", static_cast<double>(doubts_)},
                     {"direction_alarms", static_cast<double>(alarms_)}};
  if (bank_.empty()) return values;
  int number = 0;
  for (std::size_t i = 0; i < bank_.size(); ++i) {
    if (i == bank_.bestIndex()) continue;
    for (const auto& value : alternative(++number, poseOf(bank_.hypotheses()[i].belief)))
      values.push_back(value);
  }
  const Belief<DualUwbState>& belief = bank_.best().belief;
  const auto add = [&](const std::string& name, int row) {
    values.push_back({name, belief.mean.values[row], std::sqrt(belief.covariance(row, row))});
  };
  if (layout_.gyro()) add("gyro_bias_rad_per_s", layout_.rateRow());
  if (layout_.links() == 0) return values;
  for (int tag = 0; tag < links_.tags(); ++tag) {
    for (int anchor = 0; anchor < links_.anchors(); ++anchor) {
      add("tag_" + std::to_string(links_.tag(tag).id) + "_anchor_" + std::to_string(links_.anchorId(anchor)) +
              "_bias_m",
          *layout_.linkRow(tag, anchor));
    }
  }
  return values;
}

}  // namespace pos::estimation
