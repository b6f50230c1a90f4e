#include "pos/estimation/seamless.hpp"

#include <algorithm>
#include <cmath>

#include "parts.hpp"

namespace pos::estimation {
namespace {

constexpr std::string_view kStanding = "standing still to find the level and the gyro bias";

ins::ImuIncrement part(const ins::ImuIncrement& sample, double dt) {
  if (sample.dt <= 0.0) return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), dt};
  const double share = dt / sample.dt;
  return {share * sample.angle, share * sample.velocity, dt};
}

ins::ImuIncrement sum(const ins::ImuIncrement& a, const ins::ImuIncrement& b) {
  return {a.angle + b.angle, a.velocity + b.velocity, a.dt + b.dt};
}

}  // namespace

Seamless::Seamless(const SeamlessConfig& config, const std::shared_ptr<const map::TunnelMap>& map)
    : config_(config),
      zones_(map),
      core_(config),
      standstill_(config.standstill),
      rest_(config.alignment, config.standstill) {
  if (map == nullptr) return;
  for (const map::Anchor& anchor : map->anchors) anchors_.emplace(anchor.id, anchor);
  if (map->origin) frame_.emplace(*map->origin);
}

void Seamless::reset(Stamp stamp, const Belief<Pose2>& prior) {
  given_ = prior;
  last_stamp_ = stamp;
  running_ = false;
  core_ = SeamlessCore(config_);
  imu_.forget();
  standstill_.forget();
  rest_.forget();
  ahead_ = last_sample_ = {};
  aided_.reset();
}

Belief<Pose2> Seamless::prior() const {
  return given_ ? *given_ : knownStart(config_.start);
}

IngestReport Seamless::ingest(const Measurement& measurement) {
  if (const auto refused = refusedUnseen(measurement, last_stamp_)) return *refused;
  const IngestReport report =
      std::visit([&](const auto& reading) { return take(measurement.stamp, reading); }, measurement.reading);
  if (movesTimeOn(report)) last_stamp_ = measurement.stamp;
  return report;
}

// ---------------------------------------------------------------- inertial unit

IngestReport Seamless::take(Stamp stamp, const ImuSample& sample) {
  const ImuIntake::Told told = imu_.take(stamp, sample);
  if (!told.refusal.empty()) return refusal(Verdict::Degenerate, told.refusal);
  const ins::ImuIncrement& raw = told.raw;
  if (raw.dt == 0.0) return {.verdict = Verdict::Applied};
  if (!running_) return align(stamp, raw);
  // What was taken in advance is part of this sample: only the rest of it is left.
  const double left = raw.dt - ahead_.dt;
  IngestReport report{.verdict = Verdict::Applied};
  if (left > 0.0)
    report.event = core_.propagate({raw.angle - ahead_.angle, raw.velocity - ahead_.velocity, left}, stamp);
  ahead_ = {};
  last_sample_ = raw;
  aid(stamp);
  return report;
}

std::string_view Seamless::advance(Stamp stamp) {
  const double dt = seconds(stamp - core_.stamp());
  if (dt <= 0.0) return {};
  const ins::ImuIncrement step = part(last_sample_, dt);
  ahead_ = sum(ahead_, step);
  return core_.propagate(step, stamp);
}

IngestReport Seamless::align(Stamp stamp, const ins::ImuIncrement& raw) {
  standstill_.add(raw);
  const RestAlignment::Stage stage = rest_.add(raw, standstill_, false);
  if (stage == RestAlignment::Stage::Standing) return refusal(Verdict::NotInitialised, kStanding);
  start(stamp);
  last_sample_ = raw;
  return {.verdict = Verdict::Applied,
          .event = stage == RestAlignment::Stage::MovedOff
                       ? "moved off before the alignment was over: level and gyro bias are less sure"
                       : "aligned at rest"};
}

void Seamless::start(Stamp stamp) {
  const Belief<Pose2> at = prior();
  const bool rested = rest_.rested();
  const ins::RestAverage& average = rest_.average();
  const bool felt = average.time() > 0.0;
  EskfState x;
  x.q_map_body = felt ? ins::levelled(average.force(), at.mean.yaw)
                      : Eigen::Quaterniond(Eigen::AngleAxisd(at.mean.yaw, Eigen::Vector3d::UnitZ()));
  x.p_map = Eigen::Vector3d(at.mean.x, at.mean.y, config_.height) + x.q_map_body * config_.mounts.imu;
  if (rested) x.gyro_bias = average.rate();
  const double level = rested ? config_.alignment.level_sigma : config_.alignment.moving_level_sigma;
  const double gyro =
      rested ? config_.imu.gyro_density / std::sqrt(average.time()) : config_.imu.gyro_bias_sigma;
  Matrix<15, 15> P = Matrix<15, 15>::Zero();
  P.topLeftCorner<2, 2>() = at.covariance.topLeftCorner<2, 2>();
  P(2, 2) = square(config_.height_sigma);
  P.block<3, 3>(EskfState::kVelocity, EskfState::kVelocity) = diagonal3(config_.velocity_sigma);
  P.block<3, 3>(EskfState::kAttitude, EskfState::kAttitude) =
      Vector<3>(square(level), square(level), at.covariance(2, 2)).asDiagonal();
  P.block<3, 3>(EskfState::kAccelerometerBias, EskfState::kAccelerometerBias) =
      diagonal3(config_.imu.accelerometer_bias_sigma);
  P.block<3, 3>(EskfState::kGyroBias, EskfState::kGyroBias) = diagonal3(gyro);
  core_.start(stamp, {x, P});
  ahead_ = {};
  aided_ = stamp;
  running_ = true;
}

void Seamless::aid(Stamp stamp) {
  const SeamlessAids& aids = config_.aids;
  if (aids.side_slip_sigma <= 0.0 && aids.floor_sigma <= 0.0) return;
  if (seconds(stamp - *aided_) < aids.interval - 1e-9) return;
  aided_ = stamp;
  const Eigen::Vector3d to_axle = config_.mounts.axle - config_.mounts.imu;
  if (aids.side_slip_sigma > 0.0 && last_sample_.dt > 0.0) {
    const Eigen::Vector3d gyro = last_sample_.angle / last_sample_.dt;
    const Matrix<2, 2> R = square(aids.side_slip_sigma) * Matrix<2, 2>::Identity();
    core_.aid<2>([&](const EskfState& x) { return noSideSlip(x, to_axle, gyro); }, R);
  }
  if (aids.floor_sigma > 0.0) {
    const auto floor = zones_.floorAt(bodyPlace(core_.combined().mean));
    if (!floor) return;
    const Matrix<1, 1> R(square(aids.floor_sigma));
    core_.aid<1>([&](const EskfState& x) { return pointHeight(x, *floor, -config_.mounts.imu); }, R);
  }
}

// ---------------------------------------------------------------- satellites and radio

std::string_view Seamless::masked(const GnssFix& fix) const {
  const GnssUse& use = config_.gnss;
  if (use.mask == GnssUse::Mask::Always) return "satellites are masked by the operator";
  const double claimed = std::sqrt(0.5 * fix.covariance_enu.topLeftCorner<2, 2>().trace());
  if (claimed > use.sigma_max) return "the fix claims to be too poor to be of use";
  if (use.mask == GnssUse::Mask::Off) return {};
  const Belief<EskfState> best = core_.combined();
  const Zone zone = zones_.at(bodyPlace(best.mean), alongSigma(best), use.mask_margin);
  return zone == Zone::Underground ? "under ground by the map: satellites are masked" : std::string_view{};
}

IngestReport Seamless::take(Stamp stamp, const GnssFix& fix) {
  if (!frame_) return refusal(Verdict::Unsupported, "the map has no tie to the Earth");
  if (!running_) return refusal(Verdict::NotInitialised, kStanding);
  const std::string_view event = advance(stamp);
  const std::string_view why = masked(fix);
  if (!why.empty()) return {.verdict = Verdict::Gated, .reason = why, .event = event};
  const Eigen::Vector3d antenna = frame_->fromGeodetic(fix.latitude, fix.longitude, fix.altitude);
  IngestReport report = core_.take(antenna, fix.covariance_enu, config_.mounts.gnss - config_.mounts.imu);
  if (report.event.empty()) report.event = event;
  return report;
}

IngestReport Seamless::take(Stamp stamp, const BeaconRange& range) {
  if (config_.uwb.masked) return refusal(Verdict::Unsupported, "the radio is masked by the operator");
  const auto found = anchors_.find(range.anchor);
  if (found == anchors_.end()) return refusal(Verdict::Degenerate, "the map has no such anchor");
  if (!running_) return refusal(Verdict::NotInitialised, kStanding);
  const auto mount = std::find_if(config_.mounts.tags.begin(), config_.mounts.tags.end(),
                                  [&](const TagMount& tag_mount) { return tag_mount.id == range.tag; });
  const Eigen::Vector3d tag =
      mount != config_.mounts.tags.end() ? mount->p_body : range.tag_body.value_or(Eigen::Vector3d::Zero());
  const std::string_view event = advance(stamp);
  const map::Anchor& anchor = found->second;
  IngestReport report =
      core_.take({tag - config_.mounts.imu, anchor.p_map, anchor.id, range.range - anchor.range_bias},
                 anchor.survey_sigma);
  if (report.event.empty()) report.event = event;
  return report;
}

// ---------------------------------------------------------------- answers

Eigen::Vector3d Seamless::bodyPlace(const EskfState& x) const {
  return x.p_map - x.q_map_body * config_.mounts.imu;
}

double Seamless::alongSigma(const Belief<EskfState>& belief) const {
  return std::sqrt(std::max(belief.covariance(0, 0), belief.covariance(1, 1)));
}

std::optional<Estimate> Seamless::estimateAt(Stamp stamp) const {
  if (!last_stamp_ || stamp < *last_stamp_) return std::nullopt;
  if (!running_) {
    if (!given_ && !imu_.stamp()) return std::nullopt;
    const Belief<Pose2> at = prior();
    return planarEstimate(stamp, at.mean, at.covariance, config_.height);
  }
  SeamlessCore now = core_.closed();
  const double dt = seconds(stamp - now.stamp());
  if (dt > 0.0) (void)now.propagate(part(last_sample_, dt), stamp);
  const Belief<EskfState> best = now.combined();
  Estimate estimate;
  estimate.stamp = stamp;
  estimate.T_map_body = {bodyPlace(best.mean), best.mean.q_map_body};
  Matrix<6, 15> J = Matrix<6, 15>::Zero();
  J.block<3, 3>(0, EskfState::kPosition).setIdentity();
  J.block<3, 3>(0, EskfState::kAttitude) = best.mean.R_map_body() * ins::skew(config_.mounts.imu);
  J.block<3, 3>(3, EskfState::kAttitude).setIdentity();
  estimate.covariance = J * best.covariance * J.transpose();
  filters::symmetrise(estimate.covariance);
  estimate.modes = now.modeStates();
  return estimate;
}

Diagnostics Seamless::diagnostics() const {
  const SeamlessCore now = core_.closed();
  const Belief<EskfState> best = now.combined();
  const auto& P = best.covariance;
  Diagnostics values{{"running", running_ ? 1.0 : 0.0},
                     {"probability_gnss", now.probability(kGnss)},
                     {"probability_uwb", now.probability(kUwb)},
                     {"gnss_variance_scale", now.gnssScale()},
                     {"uwb_variance_scale", now.uwbScale()}};
  const auto sigma = [&](int row) { return running_ ? std::sqrt(std::max(0.0, P(row, row))) : 0.0; };
  addAxes(values, "velocity", "m_per_s", best.mean.v_map, EskfState::kVelocity, sigma);
  addAxes(values, "accelerometer_bias", "m_per_s2", best.mean.accelerometer_bias,
          EskfState::kAccelerometerBias, sigma);
  addAxes(values, "gyro_bias", "rad_per_s", best.mean.gyro_bias, EskfState::kGyroBias, sigma);
  for (const auto& offset : now.offsets().list())
    values.push_back({"range_offset_" + std::to_string(offset.anchor) + "_m", offset.mean, offset.sigma});
  return values;
}

}  // namespace pos::estimation
