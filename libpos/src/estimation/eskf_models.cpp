#include "pos/estimation/eskf_models.hpp"

#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/core/square.hpp"
#include "pos/core/wide.hpp"

namespace pos::estimation {
namespace {

using ins::skew;

constexpr int n = 15;
constexpr int p = EskfState::kPosition;
constexpr int v = EskfState::kVelocity;
constexpr int th = EskfState::kAttitude;
constexpr int w = EskfState::kGyroBias;

template <int M>
filters::Innovation<EskfState, M> empty() {
  filters::Innovation<EskfState, M> innovation;
  innovation.nu.setZero();
  innovation.H.setZero();
  return innovation;
}

/// Velocity of a point of the body, in body axes, with its derivatives.
struct BodyVelocity {
  Eigen::Vector3d value;
  Eigen::Matrix3d by_v;
  Eigen::Matrix3d by_attitude;
  Eigen::Matrix3d by_gyro_bias;
};

BodyVelocity bodyVelocity(const EskfState& x, const Eigen::Vector3d& lever, const Eigen::Vector3d& gyro) {
  const Eigen::Matrix3d R_body_map = x.R_map_body().transpose();
  const Eigen::Vector3d unit = R_body_map * x.v_map;
  return {unit + (gyro - x.gyro_bias).cross(lever), R_body_map, skew(unit), skew(lever)};
}

/// G = P H', and H G. Fifteen rows are four lots of four of which the last two share one.
POS_WIDE double seenThrough(double* __restrict__ G, const double* __restrict__ P,
                            const double* __restrict__ by_p, const double* __restrict__ by_attitude) {
#pragma GCC unroll 4
  for (const int i : {0, 4, 8, 11}) {
    const double* P_p = P + n * p + i;
    const double* P_th = P + n * th + i;
    const Four by_place = by_p[0] * four(P_p) + by_p[1] * four(P_p + n) + by_p[2] * four(P_p + 2 * n);
    four(G + i) = by_place + by_attitude[0] * four(P_th) + by_attitude[1] * four(P_th + n) +
                  by_attitude[2] * four(P_th + 2 * n);
  }
  return (by_p[0] * G[p] + by_p[1] * G[p + 1] + by_p[2] * G[p + 2]) +
         (by_attitude[0] * G[th] + by_attitude[1] * G[th + 1] + by_attitude[2] * G[th + 2]);
}

/// P <- P - W W'; symmetric to the last bit.
POS_WIDE void takeOff(double* __restrict__ P, const double* __restrict__ W) {
  const Four w0 = four(W);
  const Four w4 = four(W + 4);
  const Four w8 = four(W + 8);
  const Four w11 = four(W + 11);
  for (int j = 0; j < n; ++j) {
    double* column = P + n * j;
    const double x = W[j];
    const Four last = four(column + 11) - x * w11;  // before row 11 is written
    four(column) -= x * w0;
    four(column + 4) -= x * w4;
    four(column + 8) -= x * w8;
    four(column + 11) = last;
  }
}

}  // namespace

TangentRows<EskfState, 1> PoseRow::dense() const {
  TangentRows<EskfState, 1> H = TangentRows<EskfState, 1>::Zero();
  H.segment<3>(p) = by_position.transpose();
  H.segment<3>(th) = by_attitude.transpose();
  return H;
}

RangeSeen seenRange(const EskfState& x, const Eigen::Vector3d& lever, const Eigen::Vector3d& anchor_map,
                    double range) {
  const Eigen::Matrix3d R = x.R_map_body();
  const Eigen::Vector3d to_tag = x.p_map + R * lever - anchor_map;
  RangeSeen seen;
  seen.distance = to_tag.norm();
  seen.row.nu = range - seen.distance;
  seen.row.by_position = to_tag / seen.distance;
  seen.row.by_attitude = lever.cross(R.transpose() * seen.row.by_position);  // (-u' R [l x])'
  return seen;
}

filters::Innovation<EskfState, 3> pointFix(const EskfState& x, const Eigen::Vector3d& p_map,
                                           const Eigen::Vector3d& lever) {
  auto innovation = empty<3>();
  const Eigen::Matrix3d R = x.R_map_body();
  innovation.nu = p_map - (x.p_map + R * lever);
  innovation.H.block<3, 3>(0, p).setIdentity();
  innovation.H.block<3, 3>(0, th) = -R * skew(lever);
  return innovation;
}

filters::Innovation<EskfState, 3> pointVelocity(const EskfState& x, const Eigen::Vector3d& v_map,
                                                const Eigen::Vector3d& lever, const Eigen::Vector3d& gyro) {
  auto innovation = empty<3>();
  const Eigen::Matrix3d R = x.R_map_body();
  const Eigen::Vector3d swing = (gyro - x.gyro_bias).cross(lever);
  innovation.nu = v_map - (x.v_map + R * swing);
  innovation.H.block<3, 3>(0, v).setIdentity();
  innovation.H.block<3, 3>(0, th) = -R * skew(swing);
  innovation.H.block<3, 3>(0, w) = R * skew(lever);
  return innovation;
}

filters::Innovation<EskfState, 1> pointHeight(const EskfState& x, double z, const Eigen::Vector3d& lever) {
  const auto fix = pointFix(x, {0.0, 0.0, z}, lever);
  return {fix.nu.tail<1>(), fix.H.bottomRows<1>()};
}

filters::Innovation<EskfState, 3> atRest(const EskfState& x) {
  auto innovation = empty<3>();
  innovation.nu = -x.v_map;
  innovation.H.block<3, 3>(0, v).setIdentity();
  return innovation;
}

filters::Innovation<EskfState, 3> notTurning(const EskfState& x, const Eigen::Vector3d& mean_gyro) {
  auto innovation = empty<3>();
  innovation.nu = mean_gyro - x.gyro_bias;
  innovation.H.block<3, 3>(0, w).setIdentity();
  return innovation;
}

filters::Innovation<EskfState, 2> noSideSlip(const EskfState& x, const Eigen::Vector3d& lever,
                                             const Eigen::Vector3d& gyro) {
  auto innovation = empty<2>();
  const BodyVelocity at = bodyVelocity(x, lever, gyro);
  innovation.nu = -at.value.tail<2>();
  innovation.H.block<2, 3>(0, v) = at.by_v.bottomRows<2>();
  innovation.H.block<2, 3>(0, th) = at.by_attitude.bottomRows<2>();
  innovation.H.block<2, 3>(0, w) = at.by_gyro_bias.bottomRows<2>();
  return innovation;
}

filters::Innovation<EskfState, 1> wheelSpeed(const EskfState& x, double speed, const Eigen::Vector3d& lever,
                                             const Eigen::Vector3d& gyro) {
  auto innovation = empty<1>();
  const BodyVelocity at = bodyVelocity(x, lever, gyro);
  innovation.nu[0] = speed - at.value.x();
  innovation.H.block<1, 3>(0, v) = at.by_v.topRows<1>();
  innovation.H.block<1, 3>(0, th) = at.by_attitude.topRows<1>();
  innovation.H.block<1, 3>(0, w) = at.by_gyro_bias.topRows<1>();
  return innovation;
}

filters::Innovation<EskfState, 1> heading(const EskfState& x, double yaw) {
  auto innovation = empty<1>();
  const Eigen::Matrix3d R = x.R_map_body();
  const double level = square(R(0, 0)) + square(R(1, 0));
  innovation.nu[0] = wrapAngle(yaw - std::atan2(R(1, 0), R(0, 0)));
  // x axis moves by R [dtheta]x e_x = R (0, dtheta_z, -dtheta_y)
  innovation.H(0, th + 1) = -(R(0, 0) * R(1, 2) - R(1, 0) * R(0, 2)) / level;
  innovation.H(0, th + 2) = (R(0, 0) * R(1, 1) - R(1, 0) * R(0, 1)) / level;
  return innovation;
}

double varianceSeen(const Matrix<15, 15>& P, const PoseRow& row) {
  double G[n];
  return seenThrough(G, P.data(), row.by_position.data(), row.by_attitude.data());
}

double SequentialCorrection::innovation(const PoseRow& row) const {
  return row.nu - row.by_position.dot(d_.segment<3>(p)) - row.by_attitude.dot(d_.segment<3>(th));
}

SequentialCorrection::Expected SequentialCorrection::expected(const PoseRow& row) const {
  return {innovation(row), varianceSeen(at_.covariance, row)};
}

filters::Correction<1> SequentialCorrection::take(const PoseRow& row, double R, filters::Gate gate) {
  double G[n];
  const double S = seenThrough(G, at_.covariance.data(), row.by_position.data(), row.by_attitude.data()) + R;
  const double nu = innovation(row);
  filters::Correction<1> told;
  told.nu[0] = nu;
  told.S(0, 0) = S;
  if (!(S > 0.0) || !std::isfinite(S) || !std::isfinite(nu)) {
    told.verdict = Verdict::Degenerate;
    return told;
  }
  const double inverse = 1.0 / S;  // one division and one root: they cost as much as the rest
  told.nis = nu * nu * inverse;
  if (told.nis > gate.threshold) {
    told.verdict = Verdict::Gated;
    return told;
  }
  // K = G / S, and P - K S K' = P - W W' with W = G / sqrt(S)
  const double root = std::sqrt(inverse);
  const double step = nu * inverse;
  double W[n];
  for (int i = 0; i < n; ++i) {
    d_[i] += step * G[i];
    W[i] = root * G[i];
  }
  takeOff(at_.covariance.data(), W);
  return told;
}

Belief<EskfState> SequentialCorrection::injected() const {
  Belief<EskfState> belief{plus(at_.mean, d_), at_.covariance};
  ins::turnAttitude(belief.covariance, ins::rightJacobian(d_.segment<3>(th)));
  return belief;
}

}  // namespace pos::estimation
