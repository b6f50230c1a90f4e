#include "pos/estimation/range_odometry.hpp"

#include <algorithm>
#include <cmath>

#include "parts.hpp"
#include "pos/core/chi_square.hpp"
#include "pos/core/error.hpp"

namespace pos::estimation {
namespace {

constexpr double kCoastIntervals =
    2.0;  // odometry older than this many of its intervals says nothing any more
constexpr int kRestartAfterOpenings =
    1;  // no agreement even with the gate open: the vehicle is somewhere else

constexpr std::array kTermNames{"velocity_x_m_per_s",  "velocity_y_m_per_s", "yaw_rate_rad_per_s",
                                "gyro_bias_rad_per_s", "wheel_scale",        "range_scale",
                                "range_offset_m",      "latency_s"};
static_assert(kTermNames.size() == kStateTerms);

std::vector<AnchorId> idsOf(const map::TunnelMap& map) {
  std::vector<AnchorId> ids;
  for (const map::Anchor& anchor : map.anchors) ids.push_back(anchor.id);
  return ids;
}

IngestReport reportOf(const RangeCorrection& correction) {
  IngestReport report{.verdict = correction.verdict, .dof = RangeCorrection::kDof};
  report.nis = correction.nis;
  report.innovation = correction.nu[0];
  report.innovation_sigma = std::sqrt(correction.S(0, 0));
  if (correction.verdict == Verdict::Gated) report.reason = "range disagrees with the prediction";
  if (correction.verdict == Verdict::Degenerate) report.reason = "innovation covariance is not positive";
  return report;
}

/// The pose part of a belief with the rest dropped.
Belief<Pose2> poseOf(const Belief<RangeState>& belief) {
  return {belief.mean.pose(), belief.covariance.topLeftCorner<3, 3>()};
}

}  // namespace

RangeOdometry::RangeOdometry(const RangeOdometryConfig& config, std::shared_ptr<const map::TunnelMap> map)
    : config_(config),
      map_(std::move(map)),
      layout_(config, idsOf(*map_)),
      gate_{chiSquareQuantile(config.gate.confidence, 1.0)},
      watch_(config.gate) {
  if (map_->anchors.empty()) {
    throw ConfigError(Complaint{.what = "range_odometry needs anchors, and the map has none",
                                .key = "map.anchors",
                                .suggestion = "add the surveyed anchors to the map file"});
  }
  for (const map::Anchor& anchor : map_->anchors) anchors_.emplace(anchor.id, anchor);
}

void RangeOdometry::reset(Stamp stamp, const Belief<Pose2>& prior) {
  bank_ = RangeBank({{startBelief(config_, layout_, prior), 0.0}});
  start_.reset();
  watch_.forget();
  state_stamp_ = last_stamp_ = stamp;
  odometry_stamp_.reset();
  odometry_velocity_ = {};
  odometry_interval_ = 0.0;
}

IngestReport RangeOdometry::ingest(const Measurement& measurement) {
  if (const auto refused = refusedUnseen(measurement, last_stamp_)) return *refused;
  return std::visit([&](const auto& reading) { return take(measurement.stamp, reading); },
                    measurement.reading);
}

void RangeOdometry::begin(Stamp stamp) {
  last_stamp_ = stamp;
  if (state_stamp_) return;
  state_stamp_ = stamp;
  const Belief<Pose2> prior = knownStart(config_.start);
  switch (config_.start.mode) {
    case StartMode::Known:
      bank_ = RangeBank({{startBelief(config_, layout_, prior), 0.0}});
      break;
    case StartMode::UnknownHeading:
      bank_ = RangeBank(headingHypotheses(config_, layout_, prior));
      break;
    case StartMode::Unknown:
      start_.emplace(config_, layout_);
      break;
    case StartMode::AtTruth:
      throw ContractError("start.mode at_truth must be spelt out before an estimator is made");
  }
}

void RangeOdometry::restart(Stamp stamp) {
  bank_ = {};
  start_.emplace(config_, layout_);
  watch_.forget();
  state_stamp_ = stamp;
  ++restarts_;
}

IngestReport RangeOdometry::take(Stamp stamp, const OdometryIncrement& odometry) {
  if (!driven()) return refusal(Verdict::Unsupported, "motion is constant_velocity: odometry is not used");
  begin(stamp);
  const double since_state = seconds(stamp - *state_stamp_);
  const double dt = odometry.interval ? std::min(seconds(*odometry.interval), since_state) : since_state;
  // A hole in the odometry: keep going as before, ever less sure.
  if (since_state > dt) carryTo(stamp - durationFromSeconds(dt));
  if (start_) start_->move(odometry.increment);
  const OdometryMotion motion{&layout_, &config_};
  for (RangeHypothesis& h : bank_.hypotheses()) {
    predictPose(h.belief, motion.step(h.belief.mean, odometry.increment, dt));
  }
  if (dt > 0.0) {
    odometry_velocity_ = {odometry.increment.translation() / dt, odometry.increment.yaw / dt};
    odometry_interval_ = dt;
  }
  odometry_stamp_ = state_stamp_ = stamp;
  return bank_.empty() ? refusal(Verdict::NotInitialised, "waiting for ranges that fix the first position")
                       : IngestReport{.verdict = Verdict::Applied};
}

/// Seconds from the state to `stamp`.
double RangeOdometry::ageOf(Stamp stamp) const {
  return state_stamp_ ? seconds(stamp - *state_stamp_) : 0.0;
}

/// The odometry's velocity while it is fresh; standing still once it is older than two of its intervals.
BodyVelocity RangeOdometry::coasting(double age) const {
  return driven() && age <= kCoastIntervals * odometry_interval_ ? odometry_velocity_ : BodyVelocity{};
}

/// The belief `dt` seconds later without any measurement in between.
Belief<RangeState> RangeOdometry::carried(Belief<RangeState> belief, double dt) const {
  if (!driven()) {
    predictPose(belief, ConstantVelocityMotion{&layout_, &config_}.step(belief.mean, {}, dt));
    return belief;
  }
  const double coast = std::min(dt, kCoastIntervals * odometry_interval_);
  const Eigen::Vector2d moved = coast * odometry_velocity_.linear;
  const Pose2 increment{moved.x(), moved.y(), coast * odometry_velocity_.yaw_rate};
  predictPose(belief, OdometryMotion{&layout_, &config_}.step(belief.mean, increment, dt));
  const double cubed = dt * dt * dt / 3.0;  // white acceleration integrated twice
  belief.covariance.diagonal().head<2>().array() += square(config_.acceleration_density) * cubed;
  belief.covariance(2, 2) += square(config_.yaw_acceleration_density) * cubed;
  return belief;
}

/// Moves the state itself to `stamp` without odometry.
void RangeOdometry::carryTo(Stamp stamp) {
  const double dt = ageOf(stamp);
  if (dt <= 0.0) return;
  for (RangeHypothesis& h : bank_.hypotheses()) h.belief = carried(h.belief, dt);
  state_stamp_ = stamp;
}

std::optional<RangeGeometry> RangeOdometry::geometryOf(const BeaconRange& range, double age) const {
  const auto anchor = anchors_.find(range.anchor);
  if (anchor == anchors_.end()) return std::nullopt;
  RangeGeometry geometry;
  geometry.anchor = range.anchor;
  geometry.anchor_map = anchor->second.p_map;
  geometry.range_bias = anchor->second.range_bias;
  geometry.body_height = config_.body_height;
  geometry.age = age;
  geometry.odometry_velocity = coasting(age);
  const auto mount = std::find_if(config_.tags.begin(), config_.tags.end(),
                                  [&](const TagMount& tag) { return tag.id == range.tag; });
  if (mount != config_.tags.end()) {
    geometry.tag_body = mount->p_body;
  } else if (range.tag_body) {
    geometry.tag_body = *range.tag_body;
  }
  return geometry;
}

IngestReport RangeOdometry::take(Stamp stamp, const BeaconRange& range) {
  if (anchors_.count(range.anchor) == 0)
    return refusal(Verdict::Degenerate, "the map has no anchor of this id");
  begin(stamp);
  if (start_) return gather(stamp, range);
  if (!driven()) carryTo(stamp);
  return correct(stamp, range, *geometryOf(range, ageOf(stamp)));
}

IngestReport RangeOdometry::gather(Stamp stamp, const BeaconRange& range) {
  start_->add(stamp, *geometryOf(range, 0.0), range.range, square(config_.range_sigma));
  std::vector<RangeHypothesis> hypotheses = start_->solved();
  if (!hypotheses.empty()) {
    bank_ = RangeBank(std::move(hypotheses));
    start_.reset();
    state_stamp_ = stamp;
    return {.verdict = Verdict::Applied, .event = "first position found from the ranges"};
  }
  return refusal(Verdict::NotInitialised, "gathering ranges for the first position");
}

IngestReport RangeOdometry::correct(Stamp stamp, const BeaconRange& range, const RangeGeometry& geometry) {
  const map::Anchor& anchor = anchors_.at(range.anchor);
  const double variance =
      square(config_.range_sigma) + square(anchor.survey_sigma) + unknownMotion(geometry.age);
  const RangeCorrection told = bank_.correct(layout_, {geometry, range.range, variance}, gate_);
  IngestReport report = reportOf(told);
  if (watch_.opens(stamp, range.anchor, told.verdict)) report.event = openGate(stamp);
  return report;
}

/// Over `age` the odometry's velocity stands in for the motion; the variance (m^2) of what it may have
/// changed by.
double RangeOdometry::unknownMotion(double age) const {
  return driven() ? square(config_.acceleration_density) * std::pow(std::abs(age), 3) / 3.0 : 0.0;
}

IngestReport RangeOdometry::take(Stamp stamp, const PassageFix& fix) {
  if (fix.yaw && !fix.yaw_sigma) return refusal(Verdict::Degenerate, "the fix's heading has no sigma");
  begin(stamp);
  if (start_) return refusal(Verdict::NotInitialised, "waiting for ranges that fix the first position");
  if (!driven()) carryTo(stamp);
  const double age = ageOf(stamp);
  FixReading reading{.seen = {fix.p_map.head<2>(), fix.p_body.head<2>()},
                     .yaw = fix.yaw,
                     .age = age,
                     .odometry_velocity = coasting(age)};
  reading.covariance.topLeftCorner<2, 2>() = fix.covariance.topLeftCorner<2, 2>();
  reading.covariance.diagonal().head<2>().array() += unknownMotion(age);
  if (fix.yaw) reading.covariance(2, 2) = square(*fix.yaw_sigma);
  const FixCorrection told = bank_.correct(layout_, reading, config_.gate.confidence);
  IngestReport report{.verdict = told.verdict, .dof = told.dof, .nis = told.nis};
  if (told.verdict == Verdict::Gated) report.reason = "fix disagrees with the prediction";
  if (told.verdict == Verdict::Degenerate) report.reason = "innovation covariance is not positive";
  return report;
}

/// Most ranges have been rejected for a while: admit that the pose may be wrong, or start over.
std::string_view RangeOdometry::openGate(Stamp stamp) {
  ++gate_openings_;
  if (watch_.openings() > kRestartAfterOpenings) {
    restart(stamp);
    return "no agreement with the gate open: starting over from the ranges";
  }
  for (RangeHypothesis& h : bank_.hypotheses()) {
    h.belief.covariance.topLeftCorner<3, 3>() *= config_.gate.inflation;
    h.belief.covariance.diagonal().head<2>().array() += square(config_.range_sigma);
  }
  return "most ranges rejected for a while: gate opened, pose made less sure";
}

std::optional<Estimate> RangeOdometry::estimateAt(Stamp stamp) const {
  if (bank_.empty() || stamp < *state_stamp_) return std::nullopt;
  const double dt = ageOf(stamp);
  const auto poseAt = [&](const RangeHypothesis& h) {
    return poseOf(dt > 0.0 ? carried(h.belief, dt) : h.belief);
  };
  const Belief<Pose2> best = poseAt(bank_.best());
  if (bank_.size() == 1) return planarEstimate(stamp, best.mean, best.covariance, config_.body_height);
  // While several hypotheses live, the best one's pose with the spread of all of them about it.
  Matrix<3, 3> covariance = Matrix<3, 3>::Zero();
  const std::vector<double> weights = bank_.weights();
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Belief<Pose2> pose = poseAt(bank_.hypotheses()[i]);
    const Vector<3> apart = minus(pose.mean, best.mean);
    covariance += weights[i] * (pose.covariance + apart * apart.transpose());
  }
  return planarEstimate(stamp, best.mean, covariance, config_.body_height);
}

Diagnostics RangeOdometry::diagnostics() const {
  Diagnostics values{{"hypotheses", static_cast<double>(bank_.size())},
                     {"gate_openings", static_cast<double>(gate_openings_)},
                     {"restarts", static_cast<double>(restarts_)}};
  if (bank_.empty()) return values;
  const Belief<RangeState>& belief = bank_.best().belief;
  const auto add = [&](const std::string& name, int row) {
    values.push_back({name, belief.mean.values[row], std::sqrt(belief.covariance(row, row))});
  };
  for (std::size_t i = 0; i < kStateTerms; ++i) {
    if (const auto row = layout_.row(static_cast<StateTerm>(i))) add(kTermNames[i], *row);
  }
  for (const AnchorId anchor : layout_.anchors()) {
    add("anchor_" + std::to_string(anchor) + "_offset_m", *layout_.anchorRow(anchor));
  }
  return values;
}

}  // namespace pos::estimation
