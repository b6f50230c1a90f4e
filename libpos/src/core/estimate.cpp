#include "pos/core/estimate.hpp"

namespace pos {

Matrix<3, 3> Estimate::planarCovariance() const {
  constexpr int kIndex[3] = {0, 1, 5};
  Matrix<3, 3> planar;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) planar(row, column) = covariance(kIndex[row], kIndex[column]);
  }
  return planar;
}

Estimate planarEstimate(Stamp stamp, const Pose2& mean, const Matrix<3, 3>& covariance, double z) {
  constexpr int kIndex[3] = {0, 1, 5};
  Estimate estimate{stamp, Pose3::fromPlanar(mean, z), Matrix<6, 6>::Zero()};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      estimate.covariance(kIndex[row], kIndex[column]) = covariance(row, column);
    }
  }
  return estimate;
}

}  // namespace pos
