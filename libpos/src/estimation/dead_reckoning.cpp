#include "pos/estimation/dead_reckoning.hpp"

#include "parts.hpp"
#include "pos/core/error.hpp"
#include "pos/estimation/range_models.hpp"

namespace pos::estimation {
namespace {

Belief<Pose2> startOf(const StartConfig& start) {
  ensure(start.mode != StartMode::AtTruth,
         "start.mode at_truth must be spelt out before an estimator is made");
  StartConfig known = start;
  if (start.mode != StartMode::Known) known.yaw_sigma = kPi;
  return knownStart(known);
}

}  // namespace

Belief<Pose2> compounded(const Belief<Pose2>& previous, const Pose2& increment, const Matrix<3, 3>& Q_body) {
  Matrix<3, 3> F = Matrix<3, 3>::Identity();
  F.block<2, 1>(0, 2) = rotation2(previous.mean.yaw + 0.5 * kPi) * increment.translation();
  Matrix<3, 3> G = Matrix<3, 3>::Identity();
  G.topLeftCorner<2, 2>() = rotation2(previous.mean.yaw);
  Belief<Pose2> now{previous.mean * increment,
                    F * previous.covariance * F.transpose() + G * Q_body * G.transpose()};
  filters::symmetrise(now.covariance);
  return now;
}

void DeadReckoning::reset(Stamp stamp, const Belief<Pose2>& prior) {
  belief_ = prior;
  stamp_ = stamp;
  distance_ = 0.0;
}

IngestReport DeadReckoning::ingest(const Measurement& measurement) {
  if (const auto refused = refusedUnseen(measurement, stamp_)) return *refused;
  const auto* odometry = std::get_if<OdometryIncrement>(&measurement.reading);
  if (odometry == nullptr) {
    return refusal(Verdict::Unsupported, "dead_reckoning uses odometry increments only");
  }
  if (!stamp_) reset(measurement.stamp, startOf(config_.start));
  const double dt = seconds(measurement.stamp - *stamp_);
  const Matrix<3, 3> Q =
      odometry->covariance.value_or(odometryCovariance(config_.noise, odometry->increment, dt));
  belief_ = compounded(belief_, odometry->increment, Q);
  stamp_ = measurement.stamp;
  distance_ += odometry->increment.translation().norm();
  return {.verdict = Verdict::Applied};
}

std::optional<Estimate> DeadReckoning::estimateAt(Stamp stamp) const {
  if (!stamp_ || stamp < *stamp_) return std::nullopt;
  return planarEstimate(stamp, belief_.mean, belief_.covariance);
}

Diagnostics DeadReckoning::diagnostics() const {
  return {{"distance_m", distance_}};
}

}  // namespace pos::estimation
