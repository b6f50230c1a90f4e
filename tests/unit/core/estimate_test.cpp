#include "pos/core/estimate.hpp"

#include <gtest/gtest.h>

namespace pos {
namespace {

Matrix<3, 3> someCovariance() {
  return (Matrix<3, 3>() << 0.04, 0.01, 0.002, 0.01, 0.09, -0.003, 0.002, -0.003, 0.01).finished();
}

}  // namespace

TEST(Estimate, PlanarBeliefGoesInAndComesOutAgain) {
  const Stamp stamp = stampFromSeconds(12.5);
  const Estimate estimate = planarEstimate(stamp, {3.0, 4.0, -1.2}, someCovariance(), 0.7);
  EXPECT_EQ(estimate.stamp, stamp);
  EXPECT_EQ(estimate.T_map_body.translation, Eigen::Vector3d(3.0, 4.0, 0.7));
  EXPECT_NEAR(estimate.T_map_body.yaw(), -1.2, 1e-12);
  EXPECT_EQ(estimate.planarCovariance(), someCovariance());
}

TEST(Estimate, PlanarBeliefSaysNothingOfHeightRollAndPitch) {
  const Estimate estimate = planarEstimate({}, {}, someCovariance());
  for (const int row : {2, 3, 4}) {
    EXPECT_EQ(estimate.covariance.row(row).norm(), 0.0);
    EXPECT_EQ(estimate.covariance.col(row).norm(), 0.0);
  }
}

TEST(Estimate, PlanarPartTakesXYAndTheLastRotation) {
  Estimate estimate;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) estimate.covariance(row, column) = 10 * row + column;
  }
  EXPECT_EQ(estimate.planarCovariance(), (Matrix<3, 3>() << 0, 1, 5, 10, 11, 15, 50, 51, 55).finished());
}

// The yaw row of the planar covariance is the spread of the heading of a level body: checked by turning it.
TEST(Estimate, LastTangentIsTheHeadingOfALevelBody) {
  Vector<6> d = Vector<6>::Zero();
  d[5] = 0.01;
  const Pose3 level = Pose3::fromPlanar({1.0, 2.0, 0.9});
  EXPECT_NEAR(plus(level, d).yaw() - level.yaw(), 0.01, 1e-12);
}

TEST(Truth, HoldsHeightAndHeadingUnlessToldOtherwise) {
  const Truth truth;
  EXPECT_TRUE(truth.poses.empty());
  EXPECT_TRUE(truth.has_z && truth.has_yaw);
}

}  // namespace pos
