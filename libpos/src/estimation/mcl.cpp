#include "pos/estimation/mcl.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pos/estimation/mcl_checks.hpp"
#include "pos/estimation/odometry_sigma.hpp"
#include "pos/estimation/scan_points.hpp"
#include "pos/filters/propagation.hpp"

namespace pos::estimation {
namespace {

constexpr std::uint64_t kStream = 0x6d636c0000000001U;  // apart from every motion's numbers
constexpr double kAllOutlier = 0.01;                    // a range less probably good than this is gated
constexpr double kHitShare = 0.05;       // a scan in which fewer beams hit an obstacle is gated
constexpr double kMostInjected = 0.5;    // of the particles, in one go
constexpr double kLeastExponent = 0.02;  // of a reading taken where the last one was
constexpr float kFarFromOrigin = 256.0F;

}  // namespace

Mcl::Mcl(const MclConfig& config, std::shared_ptr<const map::TunnelMap> map)
    : config_(checked(config, map.get())),
      map_(std::move(map)),
      anchors_(*map_, config_.range),
      free_space_(*map_, config_.range.range_max),
      bins_(config_.particles.bin_position, config_.particles.bin_yaw,
            filters::kldBins(config_.particles.max, config_.particles.kld_epsilon, config_.particles.kld_z)),
      stream_(config_.seed, kStream),
      lost_(config_.injection_slow, config_.injection_fast) {
  if (config_.use_scans) scan_weights_.emplace(*map_->grid, config_.scan);
}

RandomStream& Mcl::fresh() {
  stream_ = RandomStream(config_.seed, kStream);
  step_ = 0;
  last_odometry_.reset();
  odometer_ = 0.0;
  scan_odometer_.reset();
  group_.reset();
  headings_fresh_ = false;
  injected_share_ = 0.0;
  anchors_.reset();
  lost_ = {config_.injection_slow, config_.injection_fast};
  return stream_;
}

void Mcl::reset(Stamp stamp, const Belief<Pose2>& prior) {
  set_ = gaussianParticles(prior, static_cast<std::size_t>(config_.particles.max), fresh());
  stamp_ = stamp;
}

void Mcl::startAt(Stamp stamp) {
  const StartConfig& start = config_.start;
  if (start.mode == StartMode::Unknown) {
    set_ = free_space_.particles(static_cast<std::size_t>(config_.particles.max), fresh());
    stamp_ = stamp;
    return;
  }
  const Vector<3> sigma(start.position_sigma, start.position_sigma, start.yaw_sigma);
  reset(stamp, {start.pose, sigma.cwiseAbs2().asDiagonal()});
  if (start.mode == StartMode::UnknownHeading) scatterHeadings(set_, stream_);
}

filters::ParticleSet Mcl::particlesOnRing(const RangeTerm& term, std::size_t count) {
  const double height = term.anchor.z() - term.tag.z();
  const Ring ring{.centre = set_.origin + term.anchor.head<2>(),
                  .radius = std::sqrt(std::max(0.0, term.range * term.range - height * height)),
                  .sigma = term.sigma + term.tag.head<2>().norm(),
                  .scattered = term.outlier_probability};
  return ringParticles(ring, free_space_, count, stream_);
}

void Mcl::startOnRing(Stamp stamp, const RangeTerm& term) {
  fresh();
  set_.origin.setZero();
  set_ = particlesOnRing(term, static_cast<std::size_t>(config_.particles.max));
  stamp_ = stamp;
}

template <class R>
bool Mcl::uses() const {
  if constexpr (std::is_same_v<R, BeaconRange>) return config_.use_ranges;
  if constexpr (std::is_same_v<R, Scan2D>) return config_.use_scans;
  return std::is_same_v<R, OdometryIncrement>;
}

IngestReport Mcl::ingest(const Measurement& measurement) {
  return std::visit(
      [&]<class R>(const R& reading) -> IngestReport {
        if (!uses<R>()) return {.verdict = Verdict::Unsupported, .reason = "kind not used"};
        if (defect(measurement)) return {.verdict = Verdict::Degenerate, .reason = "defective reading"};
        if (started() && measurement.stamp < stamp_) return {.verdict = Verdict::TooOld, .reason = "too old"};
        return take(reading, measurement.stamp);
      },
      measurement.reading);
}

IngestReport Mcl::take(const OdometryIncrement& odometry, Stamp stamp) {
  if (!started()) {
    // Where the place must come from a range, odometry has nothing to move yet.
    if (config_.start.mode == StartMode::Unknown && config_.use_ranges && !map_->grid) {
      return {.verdict = Verdict::NotInitialised, .reason = "no range yet"};
    }
    startAt(stamp);
  }
  closeGroup();
  const Duration interval =
      odometry.interval.value_or(last_odometry_ ? stamp - *last_odometry_ : Duration{0});
  const double dt = std::max(0.0, seconds(interval));
  filters::propagate(set_, headings_,
                     {odometry.increment, incrementSigma(config_.odometry_noise, odometry.increment, dt)},
                     config_.seed, step_++);
  headings_fresh_ = true;
  last_odometry_ = stamp;
  odometer_ += odometry.increment.translation().norm();
  stamp_ = stamp;
  return {.verdict = Verdict::Applied};
}

Eigen::Vector3d Mcl::tagPosition(const BeaconRange& range) const {
  for (const TagMount& mount : config_.tags) {
    if (mount.id == range.tag) return mount.p_body;
  }
  return range.tag_body.value_or(Eigen::Vector3d::Zero());
}

RangeTerm Mcl::rangeTerm(const BeaconRange& range, const AnchorTable::Entry& entry,
                         const RangeBias& bias) const {
  const map::Anchor& anchor = entry.anchor;
  const Eigen::Vector2d origin = started() ? set_.origin : Eigen::Vector2d::Zero();
  const double variance =
      config_.range.sigma * config_.range.sigma + anchor.survey_sigma * anchor.survey_sigma + bias.variance;
  return {.anchor = {anchor.p_map.x() - origin.x(), anchor.p_map.y() - origin.y(), anchor.p_map.z()},
          .tag = tagPosition(range) + Eigen::Vector3d(0.0, 0.0, config_.body_height),
          .range = range.range - anchor.range_bias - bias.mean,
          .sigma = std::sqrt(variance),
          .outlier_probability = config_.range.outlier_probability,
          .range_max = config_.range.range_max,
          .exponent = exponent(entry.odometer, config_.range.correlation_length)};
}

IngestReport Mcl::take(const BeaconRange& range, Stamp stamp) {
  const AnchorTable::Entry* entry = anchors_.find(range.anchor);
  if (entry == nullptr) return {.verdict = Verdict::Degenerate, .reason = "the map has no such anchor"};
  if (!started()) {
    if (config_.start.mode == StartMode::Unknown && !map_->grid) {
      startOnRing(stamp, rangeTerm(range, *entry, entry->bias));
      return {.verdict = Verdict::Applied};
    }
    startAt(stamp);
  }
  const RangeBias bias = anchors_.biasAt(*entry, stamp);
  RangeTerm term = rangeTerm(range, *entry, bias);
  RangeSums sums = range_weights_.evaluate(set_, headings(), term);
  lost_.noteRange(stamp, sums.evidence);
  const double variance = term.sigma * term.sigma + sums.predicted_variance;
  IngestReport report{.verdict = Verdict::Applied, .dof = 1};
  report.innovation = term.range - sums.predicted;
  report.innovation_sigma = std::sqrt(variance);
  report.nis = report.innovation * report.innovation / variance;
  if (sums.inlier_share < kAllOutlier && !lost_.lost()) {
    report.verdict = Verdict::Gated;
    report.reason = "an outlier to every particle";
    return report;
  }
  if (group_ && group_->stamp != stamp) {  // settle the earlier stamp first, then look again
    closeGroup();
    term = rangeTerm(range, *entry, bias);
    sums = range_weights_.evaluate(set_, headings(), term);
  }
  openGroup(stamp);
  range_weights_.apply(set_);
  group_->ranges.push_back(term);
  anchors_.note(range.anchor, stamp, odometer_, corrected(bias, term, sums));
  return report;
}

double Mcl::exponent(const std::optional<double>& last_odometer, double correlation_length) const {
  if (correlation_length <= 0.0 || !last_odometer) return 1.0;
  return std::clamp((odometer_ - *last_odometer) / correlation_length, kLeastExponent, 1.0);
}

IngestReport Mcl::take(const Scan2D& scan, Stamp stamp) {
  const lidar::BeamPoints points = beamPoints(scan, config_.scan);
  if (points.size() == 0) return {.verdict = Verdict::Degenerate, .reason = "no beam came back"};
  if (!started()) startAt(stamp);
  const double power = exponent(scan_odometer_, config_.scan.correlation_length);
  const double hit = scan_weights_->evaluate(set_, headings(), points, power);
  lost_.noteScan(hit);
  const double p = config_.scan.outlier_probability;
  if (hit < p + kHitShare * (1.0 - p) && !lost_.lost()) {
    return {.verdict = Verdict::Gated, .reason = "the scan fits the map nowhere near the particles"};
  }
  if (group_ && group_->stamp != stamp) {
    closeGroup();
    scan_weights_->evaluate(set_, headings(), points, power);
  }
  openGroup(stamp);
  scan_weights_->apply(set_);
  group_->scans.push_back(points);
  group_->exponents.push_back(power);
  scan_odometer_ = odometer_;
  return {.verdict = Verdict::Applied};
}

const filters::HeadingTable& Mcl::headings() {
  if (!headings_fresh_) fillHeadings(headings_, set_);
  headings_fresh_ = true;
  return headings_;
}

void Mcl::openGroup(Stamp stamp) {
  if (!group_) group_ = Group{.stamp = stamp, .ranges = {}, .scans = {}, .exponents = {}};
  stamp_ = stamp;
}

void Mcl::closeGroup() {
  lost_.settle();
  if (!group_) return;
  const filters::WeightSums sums = filters::weightSums(set_);
  const auto size = static_cast<double>(set_.size());
  injected_share_ = std::min(lost_.share(), kMostInjected);
  if (injected_share_ > 0.0) {
    inject(injected_share_, filters::logEvidence(set_));
  } else if (sums.effectiveSize() < config_.resample_below * size) {
    resampler_.resample(set_, wantedCount(), stream_);
    headings_fresh_ = false;
  } else {
    filters::normalise(set_);
  }
  if (std::max(std::abs(set_.x[0]), std::abs(set_.y[0])) > kFarFromOrigin) {
    moveOrigin(set_, set_.pose(0).translation());
  }
  group_.reset();
}

std::size_t Mcl::wantedCount() {
  if (config_.particles.min == config_.particles.max) return static_cast<std::size_t>(config_.particles.max);
  const std::size_t bins = bins_.survivors(set_);
  const double wanted = filters::kldSampleSize(bins, config_.particles.kld_epsilon, config_.particles.kld_z);
  return static_cast<std::size_t>(std::clamp(std::ceil(wanted), static_cast<double>(config_.particles.min),
                                             static_cast<double>(config_.particles.max)));
}

std::optional<Estimate> Mcl::estimateAt(Stamp stamp) const {
  if (!started() || stamp < stamp_) return {};
  const filters::Moments cloud = filters::moments(set_);
  return planarEstimate(stamp, cloud.mean, cloud.covariance, config_.body_height);
}

Diagnostics Mcl::diagnostics() const {
  Diagnostics lines{{"particles", static_cast<double>(set_.size())},
                    {"effective_size", started() ? filters::effectiveSize(set_) : 0.0},
                    {"injected_share", injected_share_}};
  if (config_.range.bias_sigma > 0.0) {
    for (const auto& [id, entry] : anchors_.entries()) {
      lines.push_back(
          {"range_offset_m[" + std::to_string(id) + "]", entry.bias.mean, std::sqrt(entry.bias.variance)});
    }
  }
  return lines;
}

}  // namespace pos::estimation
