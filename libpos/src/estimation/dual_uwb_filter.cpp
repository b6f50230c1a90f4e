#include "pos/estimation/dual_uwb_filter.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/chi_square.hpp"
#include "pos/core/error.hpp"

namespace pos::estimation {
namespace {

constexpr double kGatherTime = 1.0;  // s, ranges older than this do not help to find the first pose
constexpr int kAttempts = 10;        // cycles of ranges that disagree before they are taken all the same
constexpr double kStillSpeed = 0.1;  // m/s, how still a vehicle stands that is known to stand
constexpr double kStillRate = 0.05;  // rad/s
constexpr double kOutlierShare = 0.05;
constexpr double kOutlierDensity = 1.0 / 50.0;  // 1/m, a bad range may be anywhere over tens of metres
constexpr double kLost = -14.0;                 // log weight, relative to the best, of a lost hypothesis
constexpr double kCoursePeriod = 0.1;           // s between two constraints of a free vehicle
constexpr double kBackwards = 1.0;              // s of driving backwards that raise an alarm
constexpr double kCrawl = 0.2;                  // m/s, slower than this has no direction

double square(double value) {
  return value * value;
}

IngestReport refusal(Verdict verdict, std::string_view reason) {
  return {.verdict = verdict, .reason = reason};
}

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
  const double S = told.S(0, 0);
  const double good = (1.0 - kOutlierShare) * std::exp(-0.5 * told.nis) / std::sqrt(2.0 * kPi * S);
  return std::log(good + kOutlierShare * kOutlierDensity);
}

}  // namespace

DualUwbFilter::DualUwbFilter(const DualUwbConfig& config, std::shared_ptr<const map::TunnelMap> map)
    : config_(config),
      roadway_(config, map),
      links_(config, *map),
      layout_(config, links_.anchors()),
      motion_{&layout_, &config_},
      gate_{chiSquareQuantile(config.gate.confidence, 1.0)},
      residual_test_(config.fit_significance),
      watch_(config.gate, links_.anchors()) {}

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

void DualUwbFilter::reset(Stamp stamp, const Belief<Pose2>& prior) {
  hypotheses_ = {{startBelief(prior), 0.0}};
  best_ = 0;
  early_.clear();
  watch_.forget();
  state_stamp_ = last_stamp_ = stamp;
  still_until_ = stamp + durationFromSeconds(config_.still_at_start);
  gyro_stamp_.reset();
  course_held_.reset();
  backwards_since_.reset();
}

void DualUwbFilter::restart() {
  hypotheses_.clear();
  best_ = 0;
  early_.clear();
  attempts_ = 0;
  watch_.forget();
  still_until_.reset();
  backwards_since_.reset();
  ++restarts_;
}

IngestReport DualUwbFilter::ingest(const Measurement& measurement) {
  if (defect(measurement)) return refusal(Verdict::Degenerate, "the reading itself is not valid");
  if (last_stamp_ && measurement.stamp < *last_stamp_)
    return refusal(Verdict::TooOld, "older than the state");
  return std::visit([&](const auto& reading) { return take(measurement.stamp, reading); },
                    measurement.reading);
}

/// The first measurement that counts: where the start is known, the filter begins there.
void DualUwbFilter::begin(Stamp stamp) {
  last_stamp_ = stamp;
  if (state_stamp_) return;
  state_stamp_ = stamp;
  if (config_.start.mode != StartMode::Known) return;
  Belief<Pose2> prior{config_.start.pose, Matrix<3, 3>::Zero()};
  prior.covariance.diagonal() << square(config_.start.position_sigma), square(config_.start.position_sigma),
      square(config_.start.yaw_sigma);
  hypotheses_ = {{startBelief(prior), 0.0}};
  still_until_ = stamp + durationFromSeconds(config_.still_at_start);
}

IngestReport DualUwbFilter::take(Stamp stamp, const BeaconRange& range) {
  const UwbLookUp looked_up = links_.find(range);
  if (looked_up.verdict != Verdict::Applied) return refusal(looked_up.verdict, looked_up.reason);
  begin(stamp);
  if (hypotheses_.empty()) return gather(stamp, looked_up.reading);
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
  if (gyro_stamp_ && !hypotheses_.empty()) {
    // rates are samples of a moment: over the interval their mean; increments hold for all of it
    const bool increment = imu.kind == ImuSample::Kind::Increments;
    gyro_rate_ = increment ? rate : 0.5 * (gyro_rate_ + rate);
    gyro_stamp_ = stamp;
    carryTo(stamp);
  }
  gyro_rate_ = rate;
  gyro_stamp_ = stamp;
  if (hypotheses_.empty())
    return refusal(Verdict::NotInitialised, "waiting for ranges that fix the first pose");
  return {.verdict = Verdict::Applied};
}

IngestReport DualUwbFilter::take(Stamp stamp, const WheelSpeeds& wheels) {
  if (config_.wheel_speed_sigma <= 0.0)
    return refusal(Verdict::Unsupported, "wheel speeds are switched off (wheel_speed_sigma 0)");
  begin(stamp);
  if (hypotheses_.empty())
    return refusal(Verdict::NotInitialised, "waiting for ranges that fix the first pose");
  carryTo(stamp);
  const double speed = 0.5 * (wheels.left + wheels.right);
  const Matrix<1, 1> R(square(config_.wheel_speed_sigma));
  Told told;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    DualUwbHypothesis& h = hypotheses_[i];
    const auto row = wheelInnovation(h.belief.mean, layout_, config_, speed, gyroAt(stamp));
    const Told c = filters::correct(h.belief, row, R, gate_);
    h.log_weight += logLikelihood(c);
    if (i == best_) told = c;
  }
  settle();
  IngestReport report = reportOf(told);
  if (told.verdict == Verdict::Gated && std::abs(speed) > kCrawl && !alarmed_ &&
      std::abs(told.nu[0] - 2.0 * speed) < std::abs(speed)) {
    alarmed_ = true;  // the wheels turn the other way: the vehicle faces where it comes from
    ++alarms_;
    report.event = "wheels and ranges disagree about forward: are the tags swapped?";
  }
  return report;
}

IngestReport DualUwbFilter::gather(Stamp stamp, const UwbReading& reading) {
  early_.dropBefore(stamp - durationFromSeconds(kGatherTime));
  const bool cycle_complete = early_.holds(reading);
  IngestReport report = refusal(Verdict::NotInitialised, "gathering ranges for the first pose");
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
  hypotheses_.clear();
  best_ = 0;
  for (const uwb::RigidFix& fix : fixes.all()) {
    hypotheses_.push_back({startBelief(fix.pose), -0.5 * fix.chi_square});
  }
  if (config_.start.mode == StartMode::UnknownHeading && restarts_ == 0) {
    for (DualUwbHypothesis& h : hypotheses_) {
      const Eigen::Vector2d apart = h.belief.mean.values.head<2>() - config_.start.pose.translation();
      h.log_weight -= 0.5 * apart.squaredNorm() / square(3.0 * config_.start.position_sigma);
    }
  }
  early_.clear();
  attempts_ = 0;
  watch_.forget();
  state_stamp_ = stamp;
  course_held_.reset();
  if (!still_until_ && restarts_ == 0) still_until_ = stamp + durationFromSeconds(config_.still_at_start);
  settle();
}

GyroInput DualUwbFilter::gyroAt(Stamp stamp) const {
  return {gyro_rate_, gyro_stamp_ ? std::max(0.0, seconds(stamp - *gyro_stamp_)) : 0.0};
}

Belief<DualUwbState> DualUwbFilter::carried(Belief<DualUwbState> belief, Stamp stamp) const {
  const double dt = seconds(stamp - *state_stamp_);
  if (dt <= 0.0) return belief;
  const bool standing = still_until_ && stamp <= *still_until_;
  const double walk = square(config_.link_bias.walk_per_sqrt_s) * dt;
  predict(belief,
          standing ? motion_.standing(belief.mean) : motion_.step(belief.mean, gyroAt(*state_stamp_), dt),
          walk);
  return belief;
}

void DualUwbFilter::carryTo(Stamp stamp) {
  const double dt = seconds(stamp - *state_stamp_);
  if (dt <= 0.0) return;
  const bool standing = still_until_ && stamp <= *still_until_;
  const double walk = square(config_.link_bias.walk_per_sqrt_s) * dt;
  const GyroInput gyro = gyroAt(*state_stamp_);
  for (DualUwbHypothesis& h : hypotheses_) {
    const DualUwbStep step =
        standing ? motion_.standing(h.belief.mean) : motion_.step(h.belief.mean, gyro, dt);
    predict(h.belief, step, walk);
  }
  state_stamp_ = stamp;
  holdCourse(stamp);
}

/// Free motion: the wheels keep the vehicle from sliding, softly.
void DualUwbFilter::holdCourse(Stamp stamp) {
  if (layout_.vehicle() || config_.lateral_sigma <= 0.0) return;
  if (course_held_ && stamp - *course_held_ < durationFromSeconds(kCoursePeriod)) return;
  course_held_ = stamp;
  for (DualUwbHypothesis& h : hypotheses_) {
    const auto row = lateralInnovation(h.belief.mean, layout_, config_, gyroAt(stamp));
    (void)filters::correct(h.belief, row, Matrix<1, 1>(square(config_.lateral_sigma)));
  }
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
  const Matrix<1, 1> R(square(reading.range.sigma));
  Told told;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    DualUwbHypothesis& h = hypotheses_[i];
    const auto row =
        rangeInnovation(h.belief.mean, layout_, reading.range, config_.body_height, reading.tag, anchor);
    const Told c = filters::correct(h.belief, row, R, gate_);
    if (hypotheses_.size() > 1) h.log_weight += logLikelihood(c);
    if (i == best_) told = c;
  }
  IngestReport report = reportOf(told);
  report.event = alarm(stamp);
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
  settle();
  return report;
}

/// Drops hypotheses that are lost, off the roadway while others are on it, or driving backwards where that
/// cannot be; joins twins; finds the best.
void DualUwbFilter::settle() {
  if (hypotheses_.size() < 2) {
    best_ = 0;
    return;
  }
  const auto inside = [&](const DualUwbHypothesis& h) {
    return roadway_.inside(h.belief.mean.pose().translation());
  };
  const auto reversing = [&](const DualUwbHypothesis& h) {
    const double forward = twistOf(h.belief, layout_, config_, {gyro_rate_, 0.0}).rates[0];
    const int v = DualUwbLayout::velocityRow();
    return forward < -kCrawl && forward < -3.0 * std::sqrt(h.belief.covariance(v, v));
  };
  const auto drop = [&](const auto& wrong) {
    if (std::all_of(hypotheses_.begin(), hypotheses_.end(), wrong)) return;
    std::erase_if(hypotheses_, wrong);
  };
  drop([&](const DualUwbHypothesis& h) { return !inside(h); });
  if (config_.never_reverses) drop(reversing);
  const auto heavier = [](const auto& a, const auto& b) { return a.log_weight < b.log_weight; };
  const double top = std::max_element(hypotheses_.begin(), hypotheses_.end(), heavier)->log_weight;
  std::erase_if(hypotheses_, [&](const DualUwbHypothesis& h) { return h.log_weight < top + kLost; });
  for (DualUwbHypothesis& h : hypotheses_) h.log_weight -= top;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    for (std::size_t j = hypotheses_.size() - 1; j > i; --j) {
      const Vector<3> apart = minus(hypotheses_[i].belief.mean.pose(), hypotheses_[j].belief.mean.pose());
      const Matrix<3, 3> P = hypotheses_[i].belief.covariance.topLeftCorner<3, 3>();
      if (apart.dot(P.ldlt().solve(apart)) < 0.01)
        hypotheses_.erase(hypotheses_.begin() + static_cast<long>(j));
    }
  }
  best_ = static_cast<std::size_t>(std::max_element(hypotheses_.begin(), hypotheses_.end(), heavier) -
                                   hypotheses_.begin());
}

/// Swapped tags and mirror images turn the vehicle round: it seems to drive backwards for good.
std::string_view DualUwbFilter::alarm(Stamp stamp) {
  if (!config_.never_reverses) return {};
  const int v = DualUwbLayout::velocityRow();
  const PlanarTwist twist = twistOf(best().belief, layout_, config_, gyroAt(stamp));
  const bool backwards =
      twist.rates[0] < -kCrawl && twist.rates[0] < -3.0 * std::sqrt(best().belief.covariance(v, v));
  if (!backwards) {
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

std::optional<Estimate> DualUwbFilter::estimateAt(Stamp stamp) const {
  if (hypotheses_.empty() || stamp < *state_stamp_) return std::nullopt;
  const Belief<DualUwbState> state = carried(best().belief, stamp);
  Matrix<3, 3> covariance = state.covariance.topLeftCorner<3, 3>();
  if (hypotheses_.size() > 1) {  // the best one's pose with the spread of all of them about it
    double total = 0.0;
    covariance.setZero();
    for (const DualUwbHypothesis& h : hypotheses_) {
      const Belief<DualUwbState> other = carried(h.belief, stamp);
      const Vector<3> apart = minus(other.mean.pose(), state.mean.pose());
      const double weight = std::exp(h.log_weight);
      covariance += weight * (other.covariance.topLeftCorner<3, 3>() + apart * apart.transpose());
      total += weight;
    }
    covariance /= total;
  }
  Estimate estimate = planarEstimate(stamp, state.mean.pose(), covariance, config_.body_height);
  estimate.twist = twistOf(state, layout_, config_, gyroAt(stamp));
  return estimate;
}

Diagnostics DualUwbFilter::diagnostics() const {
  Diagnostics values{{"hypotheses", static_cast<double>(hypotheses_.size())},
                     {"restarts", static_cast<double>(restarts_)},
                     {"anchors_blocked", static_cast<double>(blockings_)},
                     {"direction_alarms", static_cast<double>(alarms_)}};
  if (hypotheses_.empty()) return values;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {  // mirror images are told, not averaged
    if (i == best_) continue;
    const std::string name = "alternative_" + std::to_string(values.size()) + "_";
    const Belief<DualUwbState>& other = hypotheses_[i].belief;
    values.push_back({name + "x_m", other.mean.values[0], std::sqrt(other.covariance(0, 0))});
    values.push_back({name + "y_m", other.mean.values[1], std::sqrt(other.covariance(1, 1))});
  }
  const Belief<DualUwbState>& belief = best().belief;
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
