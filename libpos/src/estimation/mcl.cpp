#include "pos/estimation/mcl.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pos/core/error.hpp"
#include "pos/estimation/odometry_sigma.hpp"
#include "pos/estimation/scan_points.hpp"
#include "pos/filters/fast_math.hpp"
#include "pos/filters/propagation.hpp"

namespace pos::estimation {
namespace {

constexpr std::uint64_t kStream = 0x6d636c0000000001U;  // apart from every motion's numbers
constexpr double kAllOutlier = 0.01;                    // a range less probably good than this is gated
constexpr double kHitShare = 0.05;  // a scan in which fewer beams hit an obstacle is gated
constexpr double kLost =
    0.5;  // injection share from which new particles are drawn and nothing is gated any more
constexpr double kMostInjected = 0.5;    // of the particles, in one go
constexpr double kLeastExponent = 0.02;  // of a reading taken where the last one was
constexpr float kFarFromOrigin = 256.0F;

void require(bool holds, const char* key, const char* expected) {
  if (holds) return;
  throw ConfigError(
      Complaint{.what = "the particle filter cannot be set up", .key = key, .expected = expected});
}

const MclConfig& checked(const MclConfig& config, const map::TunnelMap* map) {
  require(map != nullptr, "map", "a map");
  require(config.use_ranges || config.use_scans, "use_ranges", "use_ranges or use_scans (or both)");
  require(!config.use_ranges || !map->anchors.empty(), "use_ranges", "a map with anchors");
  require(!config.use_scans || map->grid.has_value(), "use_scans", "a map with an occupancy grid");
  require(config.range.sigma > 0.0 && config.range.range_max > 0.0, "range", "sigma and range_max above 0 m");
  require(config.range.outlier_probability > 0.0 && config.range.outlier_probability < 1.0,
          "range.outlier_probability", "between 0 and 1, both excluded");
  require(config.range.bias_sigma >= 0.0 && config.range.bias_time > 0.0, "range.bias_sigma",
          "bias_sigma at least 0 m, bias_time above 0 s");
  require(config.scan.beams > 0, "scan.beams", "at least 1");
  require(config.scan.sigma > 0.0 && config.scan.distance_max > 0.0, "scan",
          "sigma and distance_max above 0 m");
  require(config.scan.outlier_probability > 0.0 && config.scan.outlier_probability < 1.0,
          "scan.outlier_probability", "between 0 and 1, both excluded");
  require(config.scan.tempering > 0.0 && config.scan.correlation_length >= 0.0, "scan.tempering",
          "tempering above 0, correlation_length at least 0 m");
  require(config.particles.min >= 2 && config.particles.max >= config.particles.min, "particles",
          "2 <= min <= max");
  require(config.particles.kld_epsilon > 0.0 && config.particles.bin_position > 0.0 &&
              config.particles.bin_yaw > 0.0,
          "particles", "kld_epsilon, bin_position (m) and bin_yaw (rad) above 0");
  require(config.resample_below >= 0.0 && config.resample_below <= 1.0, "resample_below", "0 .. 1");
  return config;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void append(filters::ParticleSet& set, const filters::ParticleSet& more) {
  const auto extend = [](std::vector<float>& to, const std::vector<float>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  extend(set.x, more.x);
  extend(set.y, more.y);
  extend(set.yaw, more.yaw);
  extend(set.log_weight, more.log_weight);
}

}  // namespace

Mcl::Mcl(const MclConfig& config, std::shared_ptr<const map::TunnelMap> map)
    : config_(checked(config, map.get())),
      map_(std::move(map)),
      anchors_(*map_, config_.range),
      free_space_(*map_, config_.range.range_max),
      bins_(config_.particles.bin_position, config_.particles.bin_yaw),
      stream_(config_.seed, kStream),
      range_recovery_(config_.injection_slow, config_.injection_fast),
      scan_recovery_(config_.injection_slow, config_.injection_fast) {
  if (config_.use_scans) scan_weights_.emplace(*map_->grid, config_.scan);
}

RandomStream& Mcl::fresh() {
  stream_ = RandomStream(config_.seed, kStream);
  step_ = 0;
  last_odometry_.reset();
  odometer_ = 0.0;
  scan_odometer_.reset();
  group_.reset();
  evidence_.clear();
  headings_fresh_ = false;
  injected_share_ = 0.0;
  anchors_.reset();
  range_recovery_ = {config_.injection_slow, config_.injection_fast};
  scan_recovery_ = {config_.injection_slow, config_.injection_fast};
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

void Mcl::startOnRing(Stamp stamp, const RangeTerm& term) {
  const double height = term.anchor.z() - term.tag.z();
  const Ring ring{.centre = term.anchor.head<2>(),
                  .radius = std::sqrt(std::max(0.0, term.range * term.range - height * height)),
                  .sigma = term.sigma + term.tag.head<2>().norm(),
                  .scattered = term.outlier_probability};
  set_ = ringParticles(ring, free_space_, static_cast<std::size_t>(config_.particles.max), fresh());
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
  filters::propagate(set_,
                     {odometry.increment, incrementSigma(config_.odometry_noise, odometry.increment, dt)},
                     config_.seed, step_++);
  headings_fresh_ = false;
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
  noteRangeEvidence(stamp, sums.evidence);
  const double variance = term.sigma * term.sigma + sums.predicted_variance;
  IngestReport report{.verdict = Verdict::Applied, .dof = 1};
  report.innovation = term.range - sums.predicted;
  report.innovation_sigma = std::sqrt(variance);
  report.nis = report.innovation * report.innovation / variance;
  if (sums.inlier_share < kAllOutlier && injectionShare() < kLost) {
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
  scan_recovery_.add(hit);
  const double p = config_.scan.outlier_probability;
  if (hit < p + kHitShare * (1.0 - p) && injectionShare() < kLost) {
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

Headings Mcl::headings() {
  if (!headings_fresh_ || cosine_.size() != set_.size()) {
    cosine_.resize(set_.size());
    sine_.resize(set_.size());
    for (std::size_t i = 0; i < set_.size(); ++i) {
      const filters::SineCosine heading = filters::fastSineCosine(set_.yaw[i]);
      cosine_[i] = heading.cosine;
      sine_[i] = heading.sine;
    }
    headings_fresh_ = true;
  }
  return {cosine_, sine_};
}

void Mcl::openGroup(Stamp stamp) {
  if (!group_) group_ = Group{.stamp = stamp, .ranges = {}, .scans = {}, .exponents = {}};
  stamp_ = stamp;
}

void Mcl::closeGroup() {
  foldRangeEvidence();
  if (!group_) return;
  const double log_evidence = filters::normalise(set_.log_weight);
  const double share = injectionShare();
  injected_share_ = share < kLost ? 0.0 : std::min(share, kMostInjected);
  if (injected_share_ > 0.0) {
    inject(injected_share_, log_evidence);
  } else if (filters::EffectiveSizePolicy{config_.resample_below}.wantsResampling(set_.log_weight)) {
    resampler_.resample(set_, wantedCount(), stream_);
  }
  if (std::max(std::abs(set_.x[0]), std::abs(set_.y[0])) > kFarFromOrigin) {
    moveOrigin(set_, set_.pose(0).translation());
  }
  headings_fresh_ = false;
  group_.reset();
}

void Mcl::noteRangeEvidence(Stamp stamp, double evidence) {
  if (stamp != evidence_stamp_) foldRangeEvidence();
  evidence_stamp_ = stamp;
  evidence_.push_back(evidence);
}

void Mcl::foldRangeEvidence() {
  if (evidence_.empty()) return;
  range_recovery_.add(median(evidence_));
  evidence_.clear();
}

double Mcl::injectionShare() const {
  double share = 1.0;  // both kinds of reading must agree that the filter is lost
  if (range_recovery_.started()) share = std::min(share, range_recovery_.injectionShare());
  if (scan_recovery_.started()) share = std::min(share, scan_recovery_.injectionShare());
  return range_recovery_.started() || scan_recovery_.started() ? share : 0.0;
}

std::size_t Mcl::wantedCount() {
  const std::size_t bins = bins_.count(set_, resampler_.ancestors(set_.log_weight, set_.size(), 0.5));
  const double wanted = filters::kldSampleSize(bins, config_.particles.kld_epsilon, config_.particles.kld_z);
  return static_cast<std::size_t>(std::clamp(std::ceil(wanted), static_cast<double>(config_.particles.min),
                                             static_cast<double>(config_.particles.max)));
}

void Mcl::inject(double share, double log_evidence) {
  const std::size_t count = wantedCount();
  const auto drawn = static_cast<std::size_t>(std::ceil(share * static_cast<double>(count)));
  filters::ParticleSet newcomers = free_space_.particles(drawn, stream_);
  moveOrigin(newcomers, set_.origin);
  resampler_.resample(set_, count - drawn, stream_);
  std::swap(set_, newcomers);  // the readings that called for them weigh the newcomers too
  headings_fresh_ = false;
  for (const RangeTerm& term : group_->ranges) {
    range_weights_.evaluate(set_, headings(), term);
    range_weights_.apply(set_);
  }
  for (std::size_t k = 0; k < group_->scans.size(); ++k) {
    scan_weights_->evaluate(set_, headings(), group_->scans[k], group_->exponents[k]);
    scan_weights_->apply(set_);
  }
  std::swap(set_, newcomers);
  // Prior (1 - share) old + share new; the old ones' mean likelihood is the evidence.
  for (float& lw : set_.log_weight) lw += static_cast<float>(std::log1p(-share));
  for (float& lw : newcomers.log_weight) lw += static_cast<float>(std::log(share) - log_evidence);
  append(set_, newcomers);
  filters::normalise(set_.log_weight);
}

std::optional<Estimate> Mcl::estimateAt(Stamp stamp) const {
  if (!started() || stamp < stamp_) return {};
  const filters::Moments cloud = filters::moments(set_);
  return planarEstimate(stamp, cloud.mean, cloud.covariance, config_.body_height);
}

Diagnostics Mcl::diagnostics() const {
  Diagnostics lines{{"particles", static_cast<double>(set_.size())},
                    {"effective_size", started() ? filters::effectiveSize(set_.log_weight) : 0.0},
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
