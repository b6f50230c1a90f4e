#pragma once
/// The arithmetic of ins/eskf on bare numbers: one sample in body axes, the blocks of F as columns of four,
/// and P <- F P F' in registers. bench/eskf compares it with full matrices.

#include "pos/ins/eskf.hpp"

namespace pos::ins {

/// Functions of a turn's angle n that attitude, velocity and Jacobians share.
struct EskfTurn {
  double cosine;  // cos(n/2)
  double sine;    // sin(n/2) / n
  double first;   // (1 - cos n) / n^2
  double second;  // (n - sin n) / n^3
};

/// One sample with the biases taken off, and what it does in body axes.
struct EskfSample {
  Eigen::Vector3d theta;  // rad, turned
  Eigen::Vector3d dv;     // m/s, felt
  Eigen::Vector3d c;      // theta x dv
  EskfTurn turn;
  Eigen::Vector3d u;  // m/s in the axes of the start: J_l(theta) dv

  EskfSample(const EskfState& x, const ImuIncrement& raw);
};

/// The rows of F for velocity (by attitude and both biases) and for attitude (by itself and the gyro bias),
/// in columns of which the fourth number means nothing.
struct EskfRows {
  double v[9][4];
  double th[6][4];
};

/// The blocks of F for one sample of dt seconds; R (3 x 3, by columns) turns body into map.
void setRows(EskfRows& F, const double* R, const EskfSample& sample, double dt);
EskfRows rowsOf(const EskfTransition& F);

/// P <- F P F' for symmetric P of 15 x 15, by columns; symmetric to the last bit. h = dt / 2.
void carryRows(double* P, const EskfRows& F, double h);

}  // namespace pos::ins
