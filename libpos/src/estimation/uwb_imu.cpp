#include "pos/estimation/uwb_imu.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "inertial_aids.hpp"
#include "parts.hpp"
#include "pos/core/error.hpp"

namespace pos::estimation {
namespace {

constexpr double kLostSpeedSigma = 1.0;    // m/s added when the filter was lost
constexpr double kLostHeadingSigma = 1.0;  // rad added when it was lost again
constexpr double kAidTime = 1e-6;          // s

template <class Filter>
constexpr bool kHasOffsets = std::is_same_v<Filter, EskfFilter>;

}  // namespace

template <class Filter>
UwbImuCore<Filter>::UwbImuCore(const UwbImuConfig& config, const std::shared_ptr<const map::TunnelMap>& map)
    : config_(config),
      process_(processOf(config.imu, config.standstill.gravity)),
      links_(linksOf(config), *map),
      standstill_(config.standstill),
      rest_(config.alignment, config.standstill),
      wheels_(config.odometer),
      watch_(watchOf(config.recovery)) {
  ensure(config.start.mode != StartMode::AtTruth,
         "start.mode at_truth must be spelt out before an estimator is made");
}

template <class Filter>
void UwbImuCore<Filter>::reset(Stamp stamp, const Belief<Pose2>& prior) {
  given_ = prior;
  filter_.reset();
  state_stamp_.reset();
  aided_.reset();
  last_stamp_ = stamp;
  imu_.forget();
  track_.forget();
  standstill_.forget();
  rest_.forget();
  rate_.forget();
  wheels_.forget();
  watch_.forget();
  doubts_.forget();
}

template <class Filter>
Belief<Pose2> UwbImuCore<Filter>::prior() const {
  return given_ ? *given_ : knownStart(config_.start);
}

template <class Filter>
IngestReport UwbImuCore<Filter>::ingest(const Measurement& measurement) {
  if (const auto refused = refusedUnseen(measurement, last_stamp_)) return *refused;
  const IngestReport report =
      std::visit([&](const auto& reading) { return take(measurement.stamp, reading); }, measurement.reading);
  if (movesTimeOn(report)) last_stamp_ = measurement.stamp;
  return report;
}

// ---------------------------------------------------------------- inertial unit

template <class Filter>
IngestReport UwbImuCore<Filter>::take(Stamp stamp, const ImuSample& sample) {
  const bool first = !imu_.stamp();
  ImuIntake::Told told = imu_.take(stamp, sample);
  if (!told.refusal.empty()) return refusal(Verdict::Degenerate, told.refusal);
  if (!filter_ && config_.first.levelling == InertialStart::Levelling::InMotion) {
    start(stamp, movingStart(config_, prior()));
    return {.verdict = Verdict::Applied, .event = "started in motion"};
  }
  if (!filter_) return align(stamp, told.raw);
  if (first && sample.kind == ImuSample::Kind::Rates) {  // since the start, which a range gave
    const double dt = seconds(stamp - *state_stamp_);
    told.raw = {dt * sample.angular, dt * sample.linear, dt};
    track_.forget();
  }
  if (told.raw.dt == 0.0) return {.verdict = Verdict::Applied};
  const ImuTrack::Share share = track_.arrived(told.raw);
  apply(*filter_, share);
  state_stamp_ = stamp;
  const EskfState& x = filter_->mean();
  standstill_.add({told.raw.angle - told.raw.dt * x.gyro_bias,
                   told.raw.velocity - told.raw.dt * x.accelerometer_bias, told.raw.dt});
  rate_.add(told.raw);
  aid(stamp);
  IngestReport report{.verdict = Verdict::Applied};
  if (share.was_silent) report.event = "the inertial unit was silent: went straight on meanwhile";
  return report;
}

template <class Filter>
void UwbImuCore<Filter>::apply(Filter& filter, const ImuTrack::Share& share) {
  if (share.increment.dt > 0.0) filter.propagate(share.increment);
  if (share.coast > 0.0) filter.coast(share.coast);
}

template <class Filter>
IngestReport UwbImuCore<Filter>::align(Stamp stamp, const ins::ImuIncrement& raw) {
  if (raw.dt == 0.0) return refusal(Verdict::NotInitialised, "standing still to find the level");
  standstill_.add(raw);
  const RestAlignment::Stage stage = rest_.add(raw, standstill_, wheels_.turned().has_value());
  if (stage == RestAlignment::Stage::Standing)
    return refusal(Verdict::NotInitialised, "standing still to find the level and the gyro bias");
  start(stamp, restedStart(config_, prior(), rest_.average(), rest_.rested()));
  return {.verdict = Verdict::Applied,
          .event = stage == RestAlignment::Stage::MovedOff
                       ? "moved off before the alignment was over: level and gyro bias are less sure"
                       : "aligned at rest"};
}

template <class Filter>
IngestReport UwbImuCore<Filter>::notStarted() const {
  return refusal(Verdict::NotInitialised,
                 imu_.stamp() ? "standing still to find the level and the gyro bias"
                              : "no inertial sample has come, and this variant needs an inertial unit");
}

template <class Filter>
void UwbImuCore<Filter>::start(Stamp stamp, const Belief<EskfState>& belief) {
  filter_.emplace(belief, process_, config_.sigma_point_spread);
  state_stamp_ = stamp;
  track_.forget();
  rate_.forget();
}

/// To the moment of a reading that comes between two inertial samples.
template <class Filter>
void UwbImuCore<Filter>::carryTo(Stamp stamp) {
  const double dt = seconds(stamp - *state_stamp_);
  if (dt <= 0.0) return;
  const ImuTrack::Share share = track_.held(dt);
  apply(*filter_, share);
  track_.note(share);
  state_stamp_ = stamp;
}

// ---------------------------------------------------------------- aids

template <class Filter>
void UwbImuCore<Filter>::aid(Stamp stamp) {
  if (!aided_) aided_ = stamp;
  if (seconds(stamp - *aided_) < config_.aids.interval - kAidTime) return;
  aided_ = stamp;
  aidHeight(*filter_, config_);
  aidRolling(*filter_, config_, track_.rate());
  if (standstill_.still()) aidStandstill(*filter_, config_, rate_);
  rate_.forget();
}

template <class Filter>
IngestReport UwbImuCore<Filter>::roll(Stamp stamp, const WheelIntake::Told& told) {
  if (told.verdict != Verdict::Applied) return refusal(told.verdict, told.reason);
  if (!(config_.aids.wheel_speed_sigma > 0.0))
    return refusal(Verdict::Unsupported, "wheels are not used (aids.wheel_speed_sigma_m_per_s is 0)");
  if (!filter_) return notStarted();
  if (told.reading.first || told.reading.dt <= 0.0) return {.verdict = Verdict::Applied};
  carryTo(stamp);
  const double speed = told.reading.way.middle() / told.reading.dt;
  const auto correction = aidWheels(*filter_, config_, speed, track_.rate());
  IngestReport report{.verdict = correction.verdict, .dof = 1, .nis = correction.nis};
  report.innovation = correction.nu[0];
  report.innovation_sigma = std::sqrt(correction.S(0, 0));
  if (correction.verdict == Verdict::Gated) report.reason = "the wheels disagree with the prediction";
  return report;
}

// ---------------------------------------------------------------- answers

template <class Filter>
std::optional<Estimate> UwbImuCore<Filter>::estimateAt(Stamp stamp) const {
  if (!last_stamp_ || stamp < *last_stamp_) return std::nullopt;
  if (!filter_) {
    if (!given_ && !imu_.stamp()) return std::nullopt;
    const Belief<Pose2> at = prior();
    return planarEstimate(stamp, at.mean, at.covariance, config_.height);
  }
  const double dt = seconds(stamp - *state_stamp_);
  if (dt <= 0.0) return bodyEstimate(stamp, filter_->belief(), config_.mounts.imu);
  Filter ahead = *filter_;
  apply(ahead, track_.held(dt));
  return bodyEstimate(stamp, ahead.belief(), config_.mounts.imu);
}

template <class Filter>
Diagnostics UwbImuCore<Filter>::diagnostics() const {
  Diagnostics values{{"recoveries", static_cast<double>(recoveries_)},
                     {"ranges_rejected", static_cast<double>(rejected_)},
                     {"ranges_doubted", static_cast<double>(doubted_)},
                     {"range_nis", last_nis_}};
  const Belief<EskfState> belief = filter_ ? filter_->belief() : Belief<EskfState>{};
  const auto sigma = [&](int row) { return std::sqrt(std::max(0.0, belief.covariance(row, row))); };
  addAxes(values, "gyro_bias", "rad_per_s", belief.mean.gyro_bias, EskfState::kGyroBias, sigma);
  addAxes(values, "accelerometer_bias", "m_per_s2", belief.mean.accelerometer_bias,
          EskfState::kAccelerometerBias, sigma);
  addAxes(values, "velocity", "m_per_s", belief.mean.v_map, EskfState::kVelocity, sigma);
  if constexpr (kHasOffsets<Filter>) {
    if (!filter_) return values;
    for (const auto& offset : filter_->offsets().list()) {
      values.push_back({"range_offset_" + std::to_string(links_.anchorId(offset.anchor)) + "_m", offset.mean,
                        offset.sigma});
    }
  }
  return values;
}

// ---------------------------------------------------------------- ranges and fixes

template <class Filter>
IngestReport UwbImuCore<Filter>::take(Stamp stamp, const BeaconRange& range) {
  const UwbLookUp found = links_.find(range);
  if (found.verdict != Verdict::Applied) return refusal(found.verdict, found.reason);
  if (range.range > config_.range_max)
    return refusal(Verdict::Degenerate, "longer than any radio of this kind reads (range_max_m)");
  if (!filter_) {
    if (config_.first.levelling != InertialStart::Levelling::InMotion) return notStarted();
    start(stamp, movingStart(config_, prior()));
  }
  const RangeLink link{found.reading.range.tag_body - config_.mounts.imu, found.reading.range.anchor_map,
                       found.reading.anchor, found.reading.range.range};
  double sigma = found.reading.range.sigma;
  if (config_.power_gap_db > 0.0 && range.rx_power_dbm && range.first_path_power_dbm &&
      *range.rx_power_dbm - *range.first_path_power_dbm > config_.power_gap_db) {
    sigma *= std::sqrt(config_.power_factor);
  }
  carryTo(stamp);
  return weigh(stamp, link, sigma);
}

/// Section A8.5 of the specification, in its order.
template <class Filter>
IngestReport UwbImuCore<Filter>::weigh(Stamp stamp, const RangeLink& link, double sigma) {
  const auto expected = filter_->expected(link);
  if (link.range - expected.nu < kNearestAnchor)
    return refusal(Verdict::Degenerate, "so near to the anchor that its range has no direction");
  const double S = expected.variance + square(sigma);
  const double s = expected.nu / std::sqrt(S);
  const std::optional<double> factor = filters::varianceFactor(config_.robust, s);
  IngestReport report{.verdict = Verdict::Applied, .dof = 1, .nis = square(s)};
  report.innovation = expected.nu;
  report.innovation_sigma = std::sqrt(S);
  last_nis_ = report.nis;
  if (factor) {
    report.verdict = filter_->take(link, *factor * square(sigma)).verdict;
    doubted_ += *factor > 1.0 ? 1 : 0;
  } else {
    report.verdict = Verdict::Gated;
    report.reason = "the range disagrees with the prediction";
    ++rejected_;
  }
  if constexpr (kHasOffsets<Filter>)
    doubts_.note(config_.anchor_bias, stamp, link.anchor, !factor || *factor > 1.0, filter_->offsets());
  if (watch_.opens(stamp, link.anchor, report.verdict)) {
    recover(expected.nu);
    report.event = "hardly a range was accepted for a while: the filter doubts itself";
  }
  return report;
}

/// Lost: as unsure of the place as the ranges are far off, of the speed, and the second time of the heading.
template <class Filter>
void UwbImuCore<Filter>::recover(double innovation) {
  Vector<15> variance = Vector<15>::Zero();
  variance.segment<3>(EskfState::kPosition).setConstant(square(innovation));
  variance.segment<3>(EskfState::kVelocity).setConstant(square(kLostSpeedSigma));
  if (watch_.openings() > 1) variance[EskfState::kAttitude + 2] = square(kLostHeadingSigma);
  filter_->inflate(variance);
  ++recoveries_;
}

template <class Filter>
IngestReport UwbImuCore<Filter>::take(Stamp stamp, const PassageFix& fix) {
  if (!filter_) return notStarted();
  Eigen::Vector3d lever = fix.p_body - config_.mounts.imu;
  for (const TagMount& tag : config_.tags) {
    if (fix.place == "tag " + std::to_string(tag.id)) lever += tag.p_body;
  }
  carryTo(stamp);
  const auto place = [&](const EskfState& x) { return pointFix(x, fix.p_map, lever); };
  const auto told = filter_->template correct<3>(place, fix.covariance, aidGate(3));
  IngestReport report{.verdict = told.verdict, .dof = 3, .nis = told.nis};
  if (told.verdict == Verdict::Gated) report.reason = "the fix is too far from where the filter is";
  if (told.verdict == Verdict::Degenerate) report.reason = "the fix has no usable covariance";
  return report;
}

template class UwbImuCore<EskfFilter>;
template class UwbImuCore<AdditiveEkf>;
template class UwbImuCore<ManifoldUkf>;

}  // namespace pos::estimation
