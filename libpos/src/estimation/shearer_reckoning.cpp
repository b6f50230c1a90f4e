#include "pos/estimation/shearer_reckoning.hpp"

#include <algorithm>
#include <cmath>

#include "parts.hpp"
#include "pos/filters/ekf.hpp"

namespace pos::estimation {
namespace {

constexpr double kNothingKnown = 1e8;  // m^2

}  // namespace

ShearerReckoning::ShearerReckoning(const ShearerConfig& config,
                                   const std::shared_ptr<const map::TunnelMap>& map)
    : config_(config),
      earth_(shearerEarth(config, *map)),
      along_(std::cos(config.face.heading), std::sin(config.face.heading), 0.0),
      right_(along_.y(), -along_.x(), 0.0),
      wheels_(ins::OdometerConfig{}),
      progress_(config.face, config.selection.zone_lag) {}

void ShearerReckoning::reset(Stamp stamp, const Belief<Pose2>& prior) {
  given_ = prior;
  running_ = false;
  last_stamp_ = stamp;
  imu_.forget();
  wheels_.forget();
}

void ShearerReckoning::start() {
  nav_ = shearerStart(config_, given_);
  start_covariance_ = shearerStartCovariance(config_, given_).block<3, 3>(ins::kPosition, ins::kPosition);
  path_ = {.p_n = nav_.coordinates - nav_.q_n_b * config_.imu_place};
  nav_.v_n.setZero();
  last_ = {};
  const ShearerOdometer& o = config_.odometer;
  xi_.setZero();
  xi_covariance_ = Vector<kXi>(square(o.yaw_sigma), square(o.pitch_sigma), square(o.drift_sigma),
                               square(o.drift_sigma), square(o.scale_sigma))
                       .asDiagonal();
  station_ = along_.dot(path_.p_n - Eigen::Vector3d(config_.face.x, config_.face.y, 0.0));
  progress_.start(station_);
  visits_ = {};
  visits_[progress_.end() == 2 ? 0 : 1] = Visit{path_, 0};
  closures_ = 0;
  started_ = last_stamp_;
  running_ = true;
}

IngestReport ShearerReckoning::ingest(const Measurement& measurement) {
  if (const auto refused = refusedUnseen(measurement, last_stamp_)) return *refused;
  const IngestReport report =
      std::visit([&](const auto& reading) { return take(measurement.stamp, reading); }, measurement.reading);
  if (movesTimeOn(report)) last_stamp_ = measurement.stamp;
  return report;
}

/// Attitude only: on a level Earth it does not depend on how the unit moves.
IngestReport ShearerReckoning::take(Stamp stamp, const ImuSample& sample) {
  const ImuIntake::Told told = imu_.take(stamp, sample);
  if (!told.refusal.empty()) return refusal(Verdict::Degenerate, told.refusal);
  if (!running_) {
    start();
    started_ = stamp;
  }
  if (told.raw.dt == 0.0) return {.verdict = Verdict::Applied};
  const Eigen::Vector3d place = nav_.coordinates;
  nav_ = ins::stepped(earth_, nav_, ins::compensated(told.raw, last_));
  nav_.coordinates = place;
  nav_.v_n.setZero();
  last_ = told.raw;
  return {.verdict = Verdict::Applied};
}

IngestReport ShearerReckoning::take(Stamp stamp, const OdometryIncrement& odometry) {
  return roll(stamp, wheels_.take(stamp, odometry));
}

IngestReport ShearerReckoning::take(Stamp stamp, const WheelSpeeds& speeds) {
  return roll(stamp, wheels_.take(stamp, speeds));
}

IngestReport ShearerReckoning::roll(Stamp stamp, const WheelIntake::Told& told) {
  if (told.verdict != Verdict::Applied) return refusal(told.verdict, told.reason);
  if (!running_) return refusal(Verdict::NotInitialised, "nothing heard of the inertial unit yet");
  const double way = told.reading.way.middle();
  const double dt = told.reading.dt;
  const Eigen::Vector3d forward =
      nav_.q_n_b * (quaternionFromRotationVector(config_.odometer.body_mount) * Eigen::Vector3d::UnitX());
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(forward);
  const Eigen::Vector3d up = forward.cross(left);
  const double t = seconds(stamp - *started_);
  path_.p_n += way * forward;
  path_.by_xi.col(0) += way * left;
  path_.by_xi.col(1) += way * up;
  path_.by_xi.col(2) += t * way * left;
  path_.by_xi.col(3) += t * way * up;
  path_.by_xi.col(4) -= way * forward;
  station_ += way;
  if (dt <= 0.0) return {.verdict = Verdict::Applied};
  IngestReport report{.verdict = Verdict::Applied};
  switch (progress_.step(station_, way / dt, dt)) {
    case FaceProgress::Event::Arrived:
      visit(progress_.end(), progress_.arrivals() - 1);
      report.event = "at the end of a pass";
      break;
    case FaceProgress::Event::Returned:
      visit(progress_.end() == 2 ? 1 : 2, progress_.arrivals());
      report.event = "the next pass begins";
      break;
    case FaceProgress::Event::Departed:
    case FaceProgress::Event::None:
      break;
  }
  return report;
}

void ShearerReckoning::visit(int end, int line) {
  std::optional<Visit>& before = visits_[static_cast<std::size_t>(end - 1)];
  const Visit now{path_, line};
  if (before && config_.variant == ShearerConfig::Variant::DrClosedPath) close(*before, now);
  before = now;
}

/// What the way from one visit of an end to the next says of xi: it is `advances` to the right, what the
/// conveyor crept along, and nothing up. Weighted least squares with the prior, recursively.
void ShearerReckoning::close(const Visit& before, const Visit& now) {
  const int advances = now.line - before.line;
  double creep = 0.0;
  bool creep_known = true;
  for (int line = before.line; line < now.line; ++line) {
    creep_known = creep_known && static_cast<std::size_t>(line) < config_.face.creep.size();
    if (creep_known) creep += config_.face.creep[static_cast<std::size_t>(line)];
  }
  const Eigen::Vector3d truly = advances * config_.face.advance * right_ + creep * along_;
  const XiRows H = now.path.by_xi - before.path.by_xi;
  const Eigen::Vector3d nu = truly - (now.path.p_n - before.path.p_n) - H * xi_;
  const double lines = std::max(1, advances);
  const double along_variance = creep_known ? lines * square(config_.face.creep_sigma) : kNothingKnown;
  Matrix<3, 3> R = lines * square(config_.odometer.stroke_sigma) * right_ * right_.transpose() +
                   along_variance * along_ * along_.transpose();
  R(2, 2) += square(config_.odometer.height_sigma);
  const Eigen::Matrix<double, kXi, 3> G = xi_covariance_ * H.transpose();
  const Matrix<3, 3> S = H * G + R;
  const Eigen::LLT<Matrix<3, 3>> factor(S);
  const Eigen::Matrix<double, kXi, 3> K = factor.solve(G.transpose()).transpose();
  xi_ += K * nu;
  xi_covariance_ -= K * G.transpose();
  filters::symmetrise(xi_covariance_);
  ++closures_;
}

std::optional<Estimate> ShearerReckoning::estimateAt(Stamp stamp) const {
  if (!last_stamp_ || stamp < *last_stamp_) return std::nullopt;
  if (!running_) {
    if (!given_) return std::nullopt;
    return planarEstimate(stamp, given_->mean, given_->covariance, config_.alignment.height);
  }
  Estimate estimate;
  estimate.stamp = stamp;
  const double t = seconds(stamp - *started_);
  const double yaw = xi_[0] + t * xi_[2];
  estimate.T_map_body.rotation =
      (quaternionFromRotationVector(Eigen::Vector3d(0.0, 0.0, yaw)) * nav_.q_n_b).normalized();
  estimate.T_map_body.translation = path_.p_n + path_.by_xi * xi_;
  estimate.covariance.topLeftCorner<3, 3>() =
      start_covariance_ + path_.by_xi * xi_covariance_ * path_.by_xi.transpose();
  const Matrix<kXi, kXi>& X = xi_covariance_;
  const double yaw_variance = X(0, 0) + t * (2.0 * X(0, 2) + t * X(2, 2));
  const double pitch_variance = X(1, 1) + t * (2.0 * X(1, 3) + t * X(3, 3));
  estimate.covariance.diagonal().tail<3>() << square(config_.alignment.tilt_sigma) + pitch_variance,
      square(config_.alignment.tilt_sigma) + pitch_variance, yaw_variance;
  filters::symmetrise(estimate.covariance);
  return estimate;
}

Diagnostics ShearerReckoning::diagnostics() const {
  if (!running_) return {};
  const auto sigma = [&](int i) { return std::sqrt(std::max(0.0, xi_covariance_(i, i))); };
  return {{"closures", static_cast<double>(closures_)},
          {"cycles", static_cast<double>(progress_.arrivals())},
          {"yaw_rad", xi_[0], sigma(0)},
          {"pitch_rad", xi_[1], sigma(1)},
          {"yaw_drift_rad_per_s", xi_[2], sigma(2)},
          {"pitch_drift_rad_per_s", xi_[3], sigma(3)},
          {"odometer_scale", xi_[4], sigma(4)}};
}

}  // namespace pos::estimation
