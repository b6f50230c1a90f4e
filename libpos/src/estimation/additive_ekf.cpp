#include <cmath>

#include "pos/core/square.hpp"
#include "pos/core/wide.hpp"
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

// The products of sixteen by sixteen are bare loops: as expressions of Eigen they took half a minute to
// compile.

constexpr int n = 16;

/// out = A B, or A B' where a step from B's row to row is one column.
POS_WIDE void multiply(double* __restrict__ out, const double* __restrict__ A, const double* __restrict__ B,
                       int by_row, int by_column) {
  for (int j = 0; j < n; ++j) {
    Four column[4] = {};
    for (int k = 0; k < n; ++k) {
      const double x = B[by_row * k + by_column * j];
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i) column[i] += x * four(A + n * k + 4 * i);
    }
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) four(out + n * j + 4 * i) = column[i];
  }
}

/// F P F'.
Matrix<16, 16> carried(const Matrix<16, 16>& F, const Matrix<16, 16>& P) {
  Matrix<16, 16> FP;
  Matrix<16, 16> FPF;
  multiply(FP.data(), F.data(), P.data(), 1, n);
  multiply(FPF.data(), FP.data(), F.data(), n, 1);
  return FPF;
}

/// Adds variances of the fifteen errors: a turn's are those of Q dtheta.
void add(Matrix<16, 16>& P, const Vector<15>& variance, const Eigen::Quaterniond& q) {
  const Matrix<4, 3> Q = quaternionByTurn(q);
  P.diagonal().head<6>() += variance.head<6>();
  for (int k = 0; k < 3; ++k) {
    const Vector<4> column = Q.col(k);
    P.block<4, 4>(kQ, kQ) += variance[EskfState::kAttitude + k] * column * column.transpose();
  }
  P.diagonal().tail<6>() += variance.tail<6>();
}

/// Rows by sixteen numbers from rows by fifteen errors: the turn is 4 Q' dq.
template <int M>
Eigen::Matrix<double, M, 16> byNumbers(const Eigen::Matrix<double, M, 15>& H, const Eigen::Quaterniond& q) {
  const Matrix<4, 3> Q = 4.0 * quaternionByTurn(q);
  Eigen::Matrix<double, M, 16> wide;
  wide.template leftCols<6>() = H.template leftCols<6>();
  wide.template middleCols<4>(kQ) = H.template middleCols<3>(EskfState::kAttitude).lazyProduct(Q.transpose());
  wide.template rightCols<6>() = H.template rightCols<6>();
  return wide;
}

/// T X for T = diag(I, B, I) with `B` at the attitude.
template <int To, int From>
Eigen::Matrix<double, To, Eigen::Dynamic> turned(const Eigen::Matrix<double, To - 12, From - 12>& B,
                                                 const Eigen::Matrix<double, From, Eigen::Dynamic>& X) {
  Eigen::Matrix<double, To, Eigen::Dynamic> Y(To, X.cols());
  Y.template topRows<6>() = X.template topRows<6>();
  for (Eigen::Index j = 0; j < X.cols(); ++j)
    Y.col(j).template segment<To - 12>(6) = B.lazyProduct(X.col(j).template segment<From - 12>(6));
  Y.template bottomRows<6>() = X.template bottomRows<6>();
  return Y;
}

/// T P T', symmetric to the last bit.
template <int To, int From>
Matrix<To, To> turnedBoth(const Eigen::Matrix<double, To - 12, From - 12>& B, const Matrix<From, From>& P) {
  const Eigen::Matrix<double, From, Eigen::Dynamic> half = turned<To, From>(B, P).transpose();
  Matrix<To, To> both = turned<To, From>(B, half);
  filters::symmetrise(both);
  return both;
}

void project(Matrix<16, 16>& P, const Eigen::Quaterniond& q) {
  const Eigen::Vector4d unit(q.w(), q.x(), q.y(), q.z());
  const Matrix<4, 4> across = Matrix<4, 4>::Identity() - unit * unit.transpose();
  for (int j = 0; j < 16; ++j) P.block<4, 1>(kQ, j) = (across * P.block<4, 1>(kQ, j)).eval();
  for (int i = 0; i < 16; ++i) P.block<1, 4>(i, kQ) = (P.block<1, 4>(i, kQ) * across).eval();
  filters::symmetrise(P);
}

}  // namespace

AdditiveEkf::AdditiveEkf(const Belief<EskfState>& start, const ins::EskfProcess& process, double /*spread*/)
    : x_(start.mean), process_(process) {
  P_ = turnedBoth<16, 15>(quaternionByTurn(x_.q_map_body), start.covariance);
}

Belief<EskfState> AdditiveEkf::belief() const {
  return {x_, turnedBoth<15, 16>(4.0 * quaternionByTurn(x_.q_map_body).transpose(), P_)};
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
  const Vector<15> half = 0.5 * ins::processNoise(process_, dt);
  add(P_, half, x_.q_map_body);
  P_ = carried(F, P_);
  add(P_, half, x_.q_map_body);
  x_ = ins::steppedMean(x_, raw, process_.gravity);
  project(P_, x_.q_map_body);
}

void AdditiveEkf::coast(double dt) {
  Matrix<16, 16> F = Matrix<16, 16>::Identity();
  F.block<3, 3>(kP, kV) = dt * Eigen::Matrix3d::Identity();
  const Vector<15> half = 0.5 * coastingNoise(dt);
  add(P_, half, x_.q_map_body);
  P_ = carried(F, P_);
  add(P_, half, x_.q_map_body);
  x_.p_map += dt * x_.v_map;
  filters::symmetrise(P_);
}

void AdditiveEkf::inflate(const Vector<15>& variance) {
  add(P_, variance, x_.q_map_body);
}

SequentialCorrection::Expected AdditiveEkf::expected(const RangeLink& link) const {
  const RangeSeen seen = seenRange(x_, link.lever, link.anchor_map, link.range);
  const Matrix<1, 16> H = byNumbers<1>(seen.row.dense(), x_.q_map_body);
  const Vector<16> G = P_.lazyProduct(H.transpose());
  return {seen.row.nu, H.dot(G)};
}

template <int M>
filters::Correction<M> AdditiveEkf::correctWith(const filters::Innovation<EskfState, M>& innovation,
                                                const Matrix<M, M>& R, filters::Gate gate) {
  // u' D(q, l) of the specification is H_theta 4 Q' and a part along q, which P does not have.
  const Eigen::Matrix<double, M, 16> H = byNumbers<M>(innovation.H, x_.q_map_body);
  const Eigen::Matrix<double, 16, M> G = P_.lazyProduct(H.transpose());
  auto told = judged<M>(innovation.nu, H.lazyProduct(G) + R, gate);
  if (told.verdict != Verdict::Applied) return told;
  const Eigen::LLT<Matrix<M, M>> S(told.S);
  Eigen::Matrix<double, 16, M> K;
  for (int i = 0; i < 16; ++i) K.row(i) = S.solve(Vector<M>(G.row(i).transpose())).transpose();
  const Vector<16> d = K.lazyProduct(told.nu);
  x_.p_map += d.segment<3>(kP);
  x_.v_map += d.segment<3>(kV);
  x_.q_map_body = Eigen::Quaterniond(x_.q_map_body.w() + d[kQ], x_.q_map_body.x() + d[kQ + 1],
                                     x_.q_map_body.y() + d[kQ + 2], x_.q_map_body.z() + d[kQ + 3])
                      .normalized();
  x_.accelerometer_bias += d.segment<3>(kA);
  x_.gyro_bias += d.segment<3>(kW);
  P_ -= K.lazyProduct(G.transpose());
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
