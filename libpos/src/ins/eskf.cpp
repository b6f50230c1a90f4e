#include "pos/ins/eskf.hpp"

#include <cmath>

#include "pos/core/square.hpp"
#include "pos/core/wide.hpp"

namespace pos::ins {
namespace {

/// Functions of a turn's angle n that attitude, velocity and Jacobians share.
struct Turn {
  double cosine;  // cos(n/2)
  double sine;    // sin(n/2) / n
  double first;   // (1 - cos n) / n^2
  double second;  // (n - sin n) / n^3
};

/// Series up to 0.1 rad, exact to the last bit but one: a sample turns less, and sines cost more than all
/// the rest (bench/eskf).
Turn turnOf(double n2) {
  if (n2 > 1e-2) {
    const double n = std::sqrt(n2);
    const double half = std::sin(0.5 * n) / n;
    return {std::cos(0.5 * n), half, 2.0 * half * half, (n - std::sin(n)) / (n2 * n)};
  }
  const double h2 = 0.25 * n2;
  return {1.0 - h2 * (0.5 - h2 * (1.0 / 24.0 - h2 * (1.0 / 720.0 - h2 / 40320.0))),
          0.5 - h2 * (1.0 / 12.0 - h2 * (1.0 / 240.0 - h2 / 10080.0)),
          0.5 - n2 * (1.0 / 24.0 - n2 * (1.0 / 720.0 - n2 / 40320.0)),
          1.0 / 6.0 - n2 * (1.0 / 120.0 - n2 * (1.0 / 5040.0 - n2 / 362880.0))};
}

/// One sample with the biases taken off, and what it does in body axes.
struct Sample {
  Eigen::Vector3d theta;  // rad, turned
  Eigen::Vector3d dv;     // m/s, felt
  Eigen::Vector3d c;      // theta x dv
  Turn turn;
  Eigen::Vector3d u;  // m/s in the axes of the start: J_l(theta) dv

  Sample(const EskfState& x, const ImuIncrement& raw)
      : theta(raw.angle - raw.dt * x.gyro_bias),
        dv(raw.velocity - raw.dt * x.accelerometer_bias),
        c(theta.cross(dv)),
        turn(turnOf(theta.squaredNorm())),
        u(dv + turn.first * c + turn.second * theta.cross(c)) {}
};

EskfState moved(const EskfState& x, const Sample& s, const Eigen::Matrix3d& R, double dt, double gravity) {
  EskfState next = x;
  next.v_map.noalias() += R * s.u;
  next.v_map.z() -= dt * gravity;
  next.p_map += 0.5 * dt * (x.v_map + next.v_map);
  const Eigen::Vector3d half = s.turn.sine * s.theta;
  next.q_map_body = x.q_map_body * Eigen::Quaterniond(s.turn.cosine, half.x(), half.y(), half.z());
  next.q_map_body.normalize();
  return next;
}

constexpr int n = 15;
constexpr int p = EskfState::kPosition;
constexpr int v = EskfState::kVelocity;
constexpr int th = EskfState::kAttitude;
constexpr int a = EskfState::kAccelerometerBias;
constexpr int w = EskfState::kGyroBias;

/// dp <- dp + h dv on both sides of P.
inline void shiftPosition(double* __restrict__ P, double h) {
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < n; ++i) P[n * (p + k) + i] += h * P[n * (v + k) + i];
  }
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < 3; ++k) P[n * j + p + k] += h * P[n * j + v + k];
  }
  for (int k = 1; k < 3; ++k) {  // equal but for rounding
    for (int l = 0; l < k; ++l) P[n * (p + k) + p + l] = P[n * (p + l) + p + k];
  }
}

/// out (15) = scale-summed columns of P: out += B(row, 0..2) . P.cols(from .. from + 2).
inline void addColumns(double* __restrict__ out, const double* __restrict__ P, const double* __restrict__ B,
                       int row, int from) {
  const double* x = P + n * from;
  const double b0 = B[row];
  const double b1 = B[3 + row];
  const double b2 = B[6 + row];
  for (int i = 0; i < n; ++i) out[i] += b0 * x[i] + b1 * x[n + i] + b2 * x[2 * n + i];
}

inline double rowTimes(const double* __restrict__ B, int row, const double* __restrict__ x) {
  return B[row] * x[0] + B[3 + row] * x[1] + B[6 + row] * x[2];
}

struct Blocks {
  const double* vth;
  const double* va;
  const double* vw;
  const double* thth;
  const double* thw;
};

/// P <- F P F' for symmetric P; Eigen's order of entries (columns), blocks likewise.
POS_WIDE void carryBlocks(double* __restrict__ P, Blocks B, double h) {
  shiftPosition(P, h);
  double M[6][n];  // columns v and theta of P F'
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < n; ++i) M[k][i] = P[n * (v + k) + i];
    addColumns(M[k], P, B.vth, k, th);
    addColumns(M[k], P, B.va, k, a);
    addColumns(M[k], P, B.vw, k, w);
    for (int i = 0; i < n; ++i) M[3 + k][i] = 0.0;
    addColumns(M[3 + k], P, B.thth, k, th);
    addColumns(M[3 + k], P, B.thw, k, w);
  }
  // Rows of F that are those of the identity: final, and by symmetry the other half.
  for (int k = 0; k < 6; ++k) {
    for (int i = 0; i < n; ++i) P[n * (v + k) + i] = M[k][i];
    for (int i = 0; i < 3; ++i) P[n * (p + i) + v + k] = M[k][p + i];
    for (int i = a; i < n; ++i) P[n * i + v + k] = M[k][i];
  }
  for (int k = 0; k < 6; ++k) {
    for (int r = 0; r <= k && r < 3; ++r) {
      const double x = M[k][v + r] + rowTimes(B.vth, r, M[k] + th) + rowTimes(B.va, r, M[k] + a) +
                       rowTimes(B.vw, r, M[k] + w);
      P[n * (v + k) + v + r] = x;
      P[n * (v + r) + v + k] = x;
    }
    for (int r = 0; r <= k - 3; ++r) {
      const double x = rowTimes(B.thth, r, M[k] + th) + rowTimes(B.thw, r, M[k] + w);
      P[n * (v + k) + th + r] = x;
      P[n * (th + r) + v + k] = x;
    }
  }
  shiftPosition(P, h);
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
  return moved(x, Sample(x, raw), x.R_map_body(), raw.dt, gravity);
}

EskfStep stepped(const EskfState& x, const ImuIncrement& raw, double gravity) {
  const double dt = raw.dt;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d O = Eigen::Matrix3d::Zero();
  if (dt == 0.0) return {x, {0.0, O, O, O, I, O}};
  const Sample s(x, raw);
  const Eigen::Matrix3d R = x.R_map_body();
  const Eigen::Matrix3d T = skew(s.theta);
  const Eigen::Matrix3d T2 = s.theta * s.theta.transpose() - s.theta.squaredNorm() * I;
  const Eigen::Matrix3d odd = s.turn.first * T;
  const Eigen::Matrix3d even = I + s.turn.second * T2;
  const double sinc = 1.0 - s.theta.squaredNorm() * s.turn.second;  // sin n / n
  // d u / d theta; of the coefficients' own change what matters at any turn a sample makes
  const Eigen::Matrix3d dV = skew(s.dv);
  const Eigen::Matrix3d u_by_theta = -s.turn.first * dV - s.turn.second * (skew(s.c) + T.lazyProduct(dV)) -
                                     s.c * (s.theta / 12.0).transpose();
  EskfStep step;
  step.next = moved(x, s, R, dt, gravity);
  step.F.dt = dt;
  step.F.v_by_attitude = R.lazyProduct(skew(-s.u));
  step.F.v_by_accelerometer_bias = R.lazyProduct(Eigen::Matrix3d(-dt * (even + odd)));
  step.F.v_by_gyro_bias = R.lazyProduct(Eigen::Matrix3d(-dt * u_by_theta));
  step.F.attitude_by_attitude = I - sinc * T + s.turn.first * T2;  // Exp(theta)'
  step.F.attitude_by_gyro_bias = -dt * (even - odd);               // -J_r(theta) dt
  return step;
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
  carryBlocks(P.data(),
              {F.v_by_attitude.data(), F.v_by_accelerometer_bias.data(), F.v_by_gyro_bias.data(),
               F.attitude_by_attitude.data(), F.attitude_by_gyro_bias.data()},
              0.5 * F.dt);
  P.diagonal() += 0.5 * Q;
}

Matrix<15, 15> carriedDense(const Matrix<15, 15>& P, const EskfTransition& transition, const Vector<15>& Q) {
  const Matrix<15, 15> F = transition.dense();
  const Matrix<15, 15> half = (0.5 * Q).asDiagonal();
  return F * (P + half) * F.transpose() + half;
}

void propagate(Belief<EskfState>& belief, const ImuIncrement& raw, const EskfProcess& process) {
  if (raw.dt == 0.0) return;
  const EskfStep step = stepped(belief.mean, raw, process.gravity);
  belief.mean = step.next;
  carry(belief.covariance, step.F, processNoise(process, raw.dt));
}

}  // namespace pos::ins
