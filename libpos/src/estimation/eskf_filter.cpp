#include "pos/core/square.hpp"
#include "pos/estimation/inertial_filters.hpp"

namespace pos::estimation {
namespace {

constexpr double kUnknownAcceleration = 1.0;  // m/s^2 sqrt(s), of a vehicle whose inertial unit is silent
constexpr double kUnknownTurn = 0.1;          // rad / sqrt(s)

}  // namespace

ins::EskfTransition coasting(double dt) {
  const Eigen::Matrix3d O = Eigen::Matrix3d::Zero();
  return {dt, O, O, O, Eigen::Matrix3d::Identity(), O};
}

Vector<15> coastingNoise(double dt) {
  Vector<15> q = Vector<15>::Zero();
  q.segment<3>(EskfState::kVelocity).setConstant(square(kUnknownAcceleration) * dt);
  q.segment<3>(EskfState::kAttitude).setConstant(square(kUnknownTurn) * dt);
  return q;
}

EskfFilter::EskfFilter(const Belief<EskfState>& start, const ins::EskfProcess& process, double /*spread*/)
    : belief_(start), process_(process) {}

void EskfFilter::propagate(const ins::ImuIncrement& raw) {
  offsets_.propagate(belief_, raw, process_);
}

void EskfFilter::coast(double dt) {
  const ins::EskfTransition F = coasting(dt);
  belief_.mean.p_map += dt * belief_.mean.v_map;
  ins::carry(belief_.covariance, F, coastingNoise(dt));
  offsets_.carry(F);
}

SequentialCorrection::Expected EskfFilter::expected(const RangeLink& link) const {
  return offsets_.expected(belief_, seenRange(belief_.mean, link).row, link.anchor);
}

filters::Correction<1> EskfFilter::take(const RangeLink& link, double R) {
  return offsets_.take(belief_, seenRange(belief_.mean, link).row, link.anchor, R);
}

}  // namespace pos::estimation
