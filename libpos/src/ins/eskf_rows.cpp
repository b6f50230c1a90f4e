#include "eskf_rows.hpp"

#include <cmath>

#include "pos/core/wide.hpp"

namespace pos::ins {
namespace {

constexpr int n = 15;
constexpr int p = EskfState::kPosition;
constexpr int v = EskfState::kVelocity;
constexpr int th = EskfState::kAttitude;
constexpr int a = EskfState::kAccelerometerBias;
constexpr int w = EskfState::kGyroBias;

/// Series up to 0.1 rad, exact to the last bit but one: a sample turns less, and sines cost more than all
/// the rest (bench/eskf).
EskfTurn turnOf(double n2) {
  if (n2 > 1e-2) {
    const double angle = std::sqrt(n2);
    const double half = std::sin(0.5 * angle) / angle;
    return {std::cos(0.5 * angle), half, 2.0 * half * half, (angle - std::sin(angle)) / (n2 * angle)};
  }
  const double h2 = 0.25 * n2;
  return {1.0 - h2 * (0.5 - h2 * (1.0 / 24.0 - h2 * (1.0 / 720.0 - h2 / 40320.0))),
          0.5 - h2 * (1.0 / 12.0 - h2 * (1.0 / 240.0 - h2 / 10080.0)),
          0.5 - n2 * (1.0 / 24.0 - n2 * (1.0 / 720.0 - n2 / 40320.0)),
          1.0 / 6.0 - n2 * (1.0 / 120.0 - n2 * (1.0 / 5040.0 - n2 / 362880.0))};
}

inline void setColumns(double (*__restrict__ columns)[4], const double* __restrict__ block) {
  four(columns[0]) = four(block);
  four(columns[1]) = four(block + 3);
  four(columns[2]) = POS_PICKED(four(block + 5), four(block + 5), 1, 2, 3, 3);
}

/// Columns of scale (x y' + d I + [s x]), the shape of every block in body axes.
inline void setComposed(double (*__restrict__ columns)[4], double scale, const double* x, const double* y,
                        double d, const double* s) {
  columns[0][0] = scale * (x[0] * y[0] + d);
  columns[0][1] = scale * (x[1] * y[0] + s[2]);
  columns[0][2] = scale * (x[2] * y[0] - s[1]);
  columns[1][0] = scale * (x[0] * y[1] - s[2]);
  columns[1][1] = scale * (x[1] * y[1] + d);
  columns[1][2] = scale * (x[2] * y[1] + s[0]);
  columns[2][0] = scale * (x[0] * y[2] + s[1]);
  columns[2][1] = scale * (x[1] * y[2] - s[0]);
  columns[2][2] = scale * (x[2] * y[2] + d);
  for (int j = 0; j < 3; ++j) columns[j][3] = 0.0;
}

/// Four rows of M = P F' from row `i` on; columns p, v, theta.
inline void fourRows(double (*__restrict__ M)[16], const double* __restrict__ P, const EskfRows& F, double h,
                     int i) {
  Four x[3] = {four(P + n * v + i), four(P + n * (v + 1) + i), four(P + n * (v + 2) + i)};
  Four y[3] = {};
#pragma GCC unroll 3
  for (int j = 0; j < 3; ++j) {
    const Four by_th = four(P + n * (th + j) + i);
    const Four by_a = four(P + n * (a + j) + i);
    const Four by_w = four(P + n * (w + j) + i);
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k) {
      x[k] += F.v[j][k] * by_th + F.v[3 + j][k] * by_a + F.v[6 + j][k] * by_w;
      y[k] += F.th[j][k] * by_th + F.th[3 + j][k] * by_w;
    }
  }
  for (int k = 0; k < 3; ++k) {
    four(M[p + k] + i) = four(P + n * (p + k) + i) + h * (four(P + n * (v + k) + i) + x[k]);
    four(M[v + k] + i) = x[k];
    four(M[th + k] + i) = y[k];
  }
}

/// Rows p and v of F M in column m of M, the fourth number after them spoilt.
inline void upperRows(double* m, const EskfRows& F, double h) {
  const Four m_v = four(m + v);
  Four x = m_v;
#pragma GCC unroll 3
  for (int j = 0; j < 3; ++j) {
    x += m[th + j] * four(F.v[j]) + m[a + j] * four(F.v[3 + j]) + m[w + j] * four(F.v[6 + j]);
  }
  four(m + p) += h * (m_v + x);
  four(m + v) = x;
}

/// The upper triangle of F M's rows p, v and theta, in place; rows a and w are those of the identity.
inline void topRows(double (*__restrict__ M)[16], const EskfRows& F, double h) {
  for (int k = th; k < a; ++k) {
    double* m = M[k];
    Four y = {};
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) y += m[th + j] * four(F.th[j]) + m[w + j] * four(F.th[3 + j]);
    upperRows(m, F, h);
    for (int i = 0; i < 3; ++i) m[th + i] = y[i];
  }
  for (int k = v; k < th; ++k) upperRows(M[k], F, h);
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i <= k; ++i) M[k][i] += h * (M[k][v + i] + M[v + i][k]);
  }
}

/// Rows from `row` on of columns from `column` on, four of each, are those of M turned over.
inline void turnOver(double* __restrict__ P, const double (*__restrict__ M)[16], int row, int column) {
  const Four r0 = four(M[row] + column);
  const Four r1 = four(M[row + 1] + column);
  const Four r2 = four(M[row + 2] + column);
  const Four r3 = four(M[row + 3] + column);
  const Four even01 = POS_PICKED(r0, r1, 0, 4, 2, 6);
  const Four odd01 = POS_PICKED(r0, r1, 1, 5, 3, 7);
  const Four even23 = POS_PICKED(r2, r3, 0, 4, 2, 6);
  const Four odd23 = POS_PICKED(r2, r3, 1, 5, 3, 7);
  four(P + n * column + row) = POS_PICKED(even01, even23, 0, 1, 4, 5);
  four(P + n * (column + 1) + row) = POS_PICKED(odd01, odd23, 0, 1, 4, 5);
  four(P + n * (column + 2) + row) = POS_PICKED(even01, even23, 2, 3, 6, 7);
  four(P + n * (column + 3) + row) = POS_PICKED(odd01, odd23, 2, 3, 6, 7);
}

}  // namespace

EskfSample::EskfSample(const EskfState& x, const ImuIncrement& raw)
    : theta(raw.angle - raw.dt * x.gyro_bias),
      dv(raw.velocity - raw.dt * x.accelerometer_bias),
      c(theta.cross(dv)),
      turn(turnOf(theta.squaredNorm())),
      u(dv + turn.first * c + turn.second * theta.cross(c)) {}

POS_WIDE void setRows(EskfRows& __restrict__ F, const double* __restrict__ R,
                      const EskfSample& __restrict__ sample, double dt) {
  const double* t = sample.theta.data();
  const double* dv = sample.dv.data();
  const double* c = sample.c.data();
  const double* u = sample.u.data();
  const double f = sample.turn.first;
  const double g = sample.turn.second;
  const double n2 = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
  double along[3], across[3], slip[3], tilt[3], by[3];
  for (int k = 0; k < 3; ++k) {
    along[k] = g * t[k];
    across[k] = f * t[k];
    slip[k] = -g * dv[k] - (1.0 / 12.0) * c[k];
    tilt[k] = -f * dv[k] - g * c[k];
    by[k] = (g * n2 - 1.0) * t[k];
  }
  double J_l[3][4], u_by_theta[3][4];
  setComposed(J_l, -dt, along, t, 1.0 - g * n2, across);
  // d u / d theta; of the coefficients' own change what matters at any turn a sample makes
  setComposed(u_by_theta, -dt, slip, t, g * (t[0] * dv[0] + t[1] * dv[1] + t[2] * dv[2]), tilt);
  setComposed(F.th, 1.0, across, t, 1.0 - f * n2, by);  // Exp(theta)'
  for (int j = 0; j < 3; ++j) {
    F.th[3 + j][3] = 0.0;
    for (int i = 0; i < 3; ++i) F.th[3 + j][i] = J_l[i][j];  // -J_r(theta) dt = -J_l(theta)' dt
  }
  const Four r[3] = {four(R), four(R + 3), POS_PICKED(four(R + 5), four(R + 5), 1, 2, 3, 3)};
  four(F.v[0]) = u[1] * r[2] - u[2] * r[1];  // -R [u x]
  four(F.v[1]) = u[2] * r[0] - u[0] * r[2];
  four(F.v[2]) = u[0] * r[1] - u[1] * r[0];
  for (int j = 0; j < 3; ++j) {
    four(F.v[3 + j]) = J_l[j][0] * r[0] + J_l[j][1] * r[1] + J_l[j][2] * r[2];
    four(F.v[6 + j]) = u_by_theta[j][0] * r[0] + u_by_theta[j][1] * r[1] + u_by_theta[j][2] * r[2];
  }
}

EskfRows rowsOf(const EskfTransition& F) {
  EskfRows rows;
  setColumns(rows.v, F.v_by_attitude.data());
  setColumns(rows.v + 3, F.v_by_accelerometer_bias.data());
  setColumns(rows.v + 6, F.v_by_gyro_bias.data());
  setColumns(rows.th, F.attitude_by_attitude.data());
  setColumns(rows.th + 3, F.attitude_by_gyro_bias.data());
  return rows;
}

POS_WIDE void carryRows(double* __restrict__ P, const EskfRows& F, double h) {
  double M[9][16];
  for (const int i : {0, 4, 8, 11}) fourRows(M, P, F, h, i);
  topRows(M, F, h);
  // M's upper triangle and its rows a and w are new; the rest of P is that turned over.
  for (const int column : {8, 11}) {
    turnOver(P, M, 0, column);
    turnOver(P, M, 4, column);
  }
  for (int k = 0; k < 9; ++k) {
    for (const int i : {0, 4, 8, 11}) four(P + n * k + i) = four(M[k] + i);
  }
  for (int k = 0; k < 8; ++k) P[n * k + 8] = M[8][k];
  for (int i = a; i < n; ++i) P[n * i + 8] = M[8][i];
  for (int k = 0; k < 4; ++k) {
    for (int l = 0; l < 4; ++l) P[n * l + 4 + k] = M[4 + k][l];
  }
  for (int k = 1; k < 4; ++k) {
    for (int l = 0; l < k; ++l) {
      P[n * l + k] = M[k][l];
      P[n * (4 + l) + 4 + k] = M[4 + k][4 + l];
    }
  }
}

}  // namespace pos::ins
