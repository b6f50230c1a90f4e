#include <cmath>

#include "pos/core/square.hpp"
#include "pos/estimation/inertial_filters.hpp"

namespace pos::estimation {
namespace {

using ins::skew;

constexpr int kP = 0;
constexpr int kV = 3;
constexpr int kQ = 6;
constexpr int kA = 10;
constexpr int kW = 13;

/// d q (x) Exp(theta) / d theta at zero (eq. 15); Q' Q = I / 4.
Matrix<4, 3> quaternionByTurn(const Eigen::Quaterniond& q) {
  Matrix<4, 3> Q;
  Q.row(0) = -0.5 * q.vec().transpose();
  Q.bottomRows<3>() = 0.5 * (q.w() * Eigen::Matrix3d::Identity() + skew(q.vec()));
  return Q;
}

/// d (R(q) a) / d q, the four numbers of q independent.
Matrix<3, 4> rotatedByQuaternion(const Eigen::Quaterniond& q, const Eigen::Vector3d& a) {
  const double w = q.w();
  const Eigen::Vector3d u = q.vec();
  Matrix<3, 4> D;
  D.col(0) = 2.0 * (w * a + u.cross(a));
  D.rightCols<3>() =
      2.0 * (u.dot(a) * Eigen::Matrix3d::Identity() + u * a.transpose() - a * u.transpose() - w * skew(a));
  return D;
}

/// q (x) delta = [delta]_R q.
Matrix<4, 4> rightProduct(const Eigen::Quaterniond& d) {
  Matrix<4, 4> M = d.w() * Matrix<4, 4>::Identity();
  M.block<1, 3>(0, 1) -= d.vec().transpose();
  M.block<3, 1>(1, 0) += d.vec();
  M.block<3, 3>(1, 1) -= skew(d.vec());
  return M;
}

/// Errors of fifteen numbers from those of sixteen: the turn is 4 Q' dq.
Matrix<15, 16> errorsFromNumbers(const Eigen::Quaterniond& q) {
  Matrix<15, 16> T = Matrix<15, 16>::Zero();
  T.topLeftCorner<6, 6>().setIdentity();
  T.block<3, 4>(EskfState::kAttitude, kQ) = 4.0 * quaternionByTurn(q).transpose();
  T.bottomRightCorner<6, 6>().setIdentity();
  return T;
}

Matrix<16, 15> numbersFromErrors(const Eigen::Quaterniond& q) {
  Matrix<16, 15> T = Matrix<16, 15>::Zero();
  T.topLeftCorner<6, 6>().setIdentity();
  T.block<4, 3>(kQ, EskfState::kAttitude) = quaternionByTurn(q);
  T.bottomRightCorner<6, 6>().setIdentity();
  return T;
}

void project(Matrix<16, 16>& P, const Eigen::Quaterniond& q) {
  const Eigen::Vector4d n(q.w(), q.x(), q.y(), q.z());
  const Matrix<4, 4> across = Matrix<4, 4>::Identity() - n * n.transpose();
  P.middleRows<4>(kQ) = (across * P.middleRows<4>(kQ)).eval();
  P.middleCols<4>(kQ) = (P.middleCols<4>(kQ) * across).eval();
  filters::symmetrise(P);
}

}  // namespace

AdditiveEkf::AdditiveEkf(const Belief<EskfState>& start, const ins::EskfProcess& process, double /*spread*/)
    : x_(start.mean), process_(process) {
  const Matrix<16, 15> T = numbersFromErrors(x_.q_map_body);
  P_ = T * start.covariance * T.transpose();
}

Belief<EskfState> AdditiveEkf::belief() const {
  const Matrix<15, 16> T = errorsFromNumbers(x_.q_map_body);
  Matrix<15, 15> P = T * P_ * T.transpose();
  filters::symmetrise(P);
  return {x_, P};
}

void AdditiveEkf::propagate(const ins::ImuIncrement& raw) {
  const double dt = raw.dt;
  if (dt == 0.0) return;
  const Eigen::Matrix3d R = x_.R_map_body();
  const Matrix<3, 4> D = rotatedByQuaternion(x_.q_map_body, raw.velocity / dt - x_.accelerometer_bias);
  const Matrix<4, 3> Q = quaternionByTurn(x_.q_map_body);
  const Eigen::Vector3d turned = raw.angle - dt * x_.gyro_bias;
  Matrix<16, 16> F = Matrix<16, 16>::Identity();
  F.block<3, 3>(kP, kV) = dt * Eigen::Matrix3d::Identity();
  F.block<3, 4>(kP, kQ) = 0.5 * dt * dt * D;
  F.block<3, 3>(kP, kA) = -0.5 * dt * dt * R;
  F.block<3, 4>(kV, kQ) = dt * D;
  F.block<3, 3>(kV, kA) = -dt * R;
  F.block<4, 4>(kQ, kQ) = rightProduct(quaternionFromRotationVector(turned));
  F.block<4, 3>(kQ, kW) = -dt * Q;
  const Vector<15> noise = ins::processNoise(process_, dt);
  const Matrix<16, 15> T = numbersFromErrors(x_.q_map_body);
  const Matrix<16, 16> half = T * (0.5 * noise).asDiagonal() * T.transpose();
  P_ = (F * (P_ + half) * F.transpose() + half).eval();
  x_ = ins::steppedMean(x_, raw, process_.gravity);
  project(P_, x_.q_map_body);
}

void AdditiveEkf::coast(double dt) {
  Matrix<16, 16> F = Matrix<16, 16>::Identity();
  F.block<3, 3>(kP, kV) = dt * Eigen::Matrix3d::Identity();
  const Matrix<16, 15> T = numbersFromErrors(x_.q_map_body);
  const Matrix<16, 16> half = T * (0.5 * coastingNoise(dt)).asDiagonal() * T.transpose();
  P_ = (F * (P_ + half) * F.transpose() + half).eval();
  x_.p_map += dt * x_.v_map;
  filters::symmetrise(P_);
}

void AdditiveEkf::inflate(const Vector<15>& variance) {
  const Matrix<16, 15> T = numbersFromErrors(x_.q_map_body);
  P_ += T * variance.asDiagonal() * T.transpose();
}

SequentialCorrection::Expected AdditiveEkf::expected(const RangeLink& link) const {
  const RangeSeen seen = seenRange(x_, link.lever, link.anchor_map, link.range);
  const Matrix<1, 16> H = seen.row.dense() * errorsFromNumbers(x_.q_map_body);
  return {seen.row.nu, (H * P_ * H.transpose())(0)};
}

template <int M>
filters::Correction<M> AdditiveEkf::correctWith(const filters::Innovation<EskfState, M>& innovation,
                                                const Matrix<M, M>& R, filters::Gate gate) {
  // u' D(q, l) of the specification is H_theta 4 Q' and a part along q, which P does not have.
  const Eigen::Matrix<double, M, 16> H = innovation.H * errorsFromNumbers(x_.q_map_body);
  const Eigen::Matrix<double, 16, M> G = P_ * H.transpose();
  const auto told = detail::judged<M>(innovation.nu, H * G + R, gate);
  if (told.verdict != Verdict::Applied) return told;
  const Eigen::Matrix<double, 16, M> K = told.S.llt().solve(G.transpose()).transpose();
  const Vector<16> d = K * told.nu;
  x_.p_map += d.segment<3>(kP);
  x_.v_map += d.segment<3>(kV);
  x_.q_map_body = Eigen::Quaterniond(x_.q_map_body.w() + d[kQ], x_.q_map_body.x() + d[kQ + 1],
                                     x_.q_map_body.y() + d[kQ + 2], x_.q_map_body.z() + d[kQ + 3])
                      .normalized();
  x_.accelerometer_bias += d.segment<3>(kA);
  x_.gyro_bias += d.segment<3>(kW);
  P_ -= K * G.transpose();
  project(P_, x_.q_map_body);
  return told;
}

filters::Correction<1> AdditiveEkf::take(const RangeLink& link, double R) {
  const RangeSeen seen = seenRange(x_, link.lever, link.anchor_map, link.range);
  return correctWith<1>({Vector<1>(seen.row.nu), seen.row.dense()}, Matrix<1, 1>(R), {});
}

template filters::Correction<1> AdditiveEkf::correctWith<1>(const filters::Innovation<EskfState, 1>&,
                                                            const Matrix<1, 1>&, filters::Gate);
template filters::Correction<2> AdditiveEkf::correctWith<2>(const filters::Innovation<EskfState, 2>&,
                                                            const Matrix<2, 2>&, filters::Gate);
template filters::Correction<3> AdditiveEkf::correctWith<3>(const filters::Innovation<EskfState, 3>&,
                                                            const Matrix<3, 3>&, filters::Gate);

}  // namespace pos::estimation
