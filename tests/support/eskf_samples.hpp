#pragma once
/// States, samples and covariances of an error-state filter for tests, from explicit seeds.

#include "pos/core/pose3.hpp"
#include "pos/core/random.hpp"
#include "pos/ins/eskf.hpp"

namespace pos::testing {

inline Eigen::Vector3d triple(RandomStream& random, double size) {
  const double x = random.uniform(-size, size);
  const double y = random.uniform(-size, size);
  const double z = random.uniform(-size, size);
  return {x, y, z};
}

inline ins::EskfState someState(RandomStream& random) {
  ins::EskfState x;
  x.p_map = triple(random, 1.0);
  x.v_map = triple(random, 3.0);
  x.q_map_body = quaternionFromRotationVector(triple(random, 1.8));
  x.accelerometer_bias = triple(random, 0.05);
  x.gyro_bias = triple(random, 0.01);
  return x;
}

inline ins::ImuIncrement someSample(RandomStream& random, double dt) {
  const Eigen::Vector3d rate = triple(random, 2.0);
  const Eigen::Vector3d force = triple(random, 5.0) + Eigen::Vector3d(0.0, 0.0, 9.80665);
  return {dt * rate, dt * force, dt};
}

/// Positive definite, with correlations everywhere and the sizes that a filter has.
inline Matrix<15, 15> someCovariance(RandomStream& random) {
  Matrix<15, 15> A;
  for (int i = 0; i < 225; ++i) A(i / 15, i % 15) = random.uniform(-1.0, 1.0);
  Vector<15> scale;
  scale << 0.4, 0.4, 0.4, 0.1, 0.1, 0.1, 0.02, 0.02, 0.03, 0.02, 0.02, 0.02, 5e-4, 5e-4, 5e-4;
  const Matrix<15, 15> P = scale.asDiagonal() * (A * A.transpose()) * scale.asDiagonal();
  return 0.5 * (P + P.transpose());
}

/// Entries over the sigmas of their rows and columns.
inline Matrix<15, 15> overSigmas(const Matrix<15, 15>& P, const Matrix<15, 15>& reference) {
  const Vector<15> scale = reference.diagonal().cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * P * scale.asDiagonal();
}

}  // namespace pos::testing
