#include "pos/ins/eskf.hpp"

#include "eskf_rows.hpp"
#include "pos/core/square.hpp"

namespace pos::ins {
namespace {

EskfState moved(const EskfState& x, const EskfSample& s, const Eigen::Matrix3d& R, double dt,
                double gravity) {
  EskfState next = x;
  next.v_map.noalias() += R * s.u;
  next.v_map.z() -= dt * gravity;
  next.p_map += 0.5 * dt * (x.v_map + next.v_map);
  const Eigen::Vector3d half = s.turn.sine * s.theta;
  next.q_map_body = x.q_map_body * Eigen::Quaterniond(s.turn.cosine, half.x(), half.y(), half.z());
  next.q_map_body.normalize();
  return next;
}

constexpr int p = EskfState::kPosition;
constexpr int v = EskfState::kVelocity;
constexpr int th = EskfState::kAttitude;
constexpr int a = EskfState::kAccelerometerBias;
constexpr int w = EskfState::kGyroBias;

Eigen::Matrix3d blockOf(const double (*columns)[4]) {
  return Eigen::Map<const Eigen::Matrix3d, 0, Eigen::OuterStride<4>>(columns[0]);
}

}  // namespace

Matrix<15, 15> EskfTransition::dense() const {
  Matrix<15, 15> F = Matrix<15, 15>::Identity();
  F.block<3, 3>(v, th) = v_by_attitude;
  F.block<3, 3>(v, a) = v_by_accelerometer_bias;
  F.block<3, 3>(v, w) = v_by_gyro_bias;
  F.block<3, 3>(th, th) = attitude_by_attitude;
  F.block<3, 3>(th, w) = attitude_by_gyro_bias;
  const Matrix<3, 15> dv = F.middleRows<3>(v);
  F.middleRows<3>(p) += 0.5 * dt * dv;
  F.block<3, 3>(p, v) += 0.5 * dt * Eigen::Matrix3d::Identity();
  return F;
}

Eigen::Matrix<double, 15, Eigen::Dynamic> EskfTransition::carried(
    const Eigen::Matrix<double, 15, Eigen::Dynamic>& X) const {
  Eigen::Matrix<double, 15, Eigen::Dynamic> Y = X;
  Y.middleRows<3>(v) += v_by_attitude * X.middleRows<3>(th) + v_by_accelerometer_bias * X.middleRows<3>(a) +
                        v_by_gyro_bias * X.middleRows<3>(w);
  Y.middleRows<3>(th) =
      attitude_by_attitude * X.middleRows<3>(th) + attitude_by_gyro_bias * X.middleRows<3>(w);
  Y.middleRows<3>(p) += 0.5 * dt * (X.middleRows<3>(v) + Y.middleRows<3>(v));
  return Y;
}

EskfState steppedMean(const EskfState& x, const ImuIncrement& raw, double gravity) {
  if (raw.dt == 0.0) return x;
  return moved(x, EskfSample(x, raw), x.R_map_body(), raw.dt, gravity);
}

EskfStep stepped(const EskfState& x, const ImuIncrement& raw, double gravity) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d O = Eigen::Matrix3d::Zero();
  if (raw.dt == 0.0) return {x, {0.0, O, O, O, I, O}};
  const EskfSample s(x, raw);
  const Eigen::Matrix3d R = x.R_map_body();
  EskfRows F;
  setRows(F, R.data(), s, raw.dt);
  return {moved(x, s, R, raw.dt, gravity),
          {raw.dt, blockOf(F.v), blockOf(F.v + 3), blockOf(F.v + 6), blockOf(F.th), blockOf(F.th + 3)}};
}

Vector<15> processNoise(const EskfProcess& process, double dt) {
  Vector<15> q = Vector<15>::Zero();
  q.segment<3>(v).setConstant(square(process.accelerometer_density) * dt);
  q.segment<3>(th).setConstant(square(process.gyro_density) * dt);
  q.segment<3>(a).setConstant(square(process.accelerometer_bias_walk) * dt);
  q.segment<3>(w).setConstant(square(process.gyro_bias_walk) * dt);
  return q;
}

void carry(Matrix<15, 15>& P, const EskfTransition& F, const Vector<15>& Q) {
  P.diagonal() += 0.5 * Q;
  const EskfRows rows = rowsOf(F);
  carryRows(P.data(), rows, 0.5 * F.dt);
  P.diagonal() += 0.5 * Q;
}

Matrix<15, 15> carriedDense(const Matrix<15, 15>& P, const EskfTransition& transition, const Vector<15>& Q) {
  const Matrix<15, 15> F = transition.dense();
  const Matrix<15, 15> half = (0.5 * Q).asDiagonal();
  return F * (P + half) * F.transpose() + half;
}

void propagate(Belief<EskfState>& belief, const ImuIncrement& raw, const EskfProcess& process) {
  if (raw.dt == 0.0) return;
  const Vector<15> half = 0.5 * processNoise(process, raw.dt);
  belief.covariance.diagonal() += half;  // before the step, whose time these stores take to settle
  const EskfSample s(belief.mean, raw);
  const Eigen::Matrix3d R = belief.mean.R_map_body();
  EskfRows F;
  setRows(F, R.data(), s, raw.dt);
  belief.mean = moved(belief.mean, s, R, raw.dt, process.gravity);
  carryRows(belief.covariance.data(), F, 0.5 * raw.dt);
  belief.covariance.diagonal() += half;
}

}  // namespace pos::ins
