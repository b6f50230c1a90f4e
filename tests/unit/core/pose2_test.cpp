#include "pos/core/pose2.hpp"

#include <gtest/gtest.h>

#include "pos/core/belief.hpp"
#include "support/manifold_laws.hpp"

namespace pos {

template <>
struct ManifoldSamples<Pose2> {
  static std::vector<Pose2> states() {
    return {{},
            {1.0, -2.0, 0.5},
            {-30.0, 4.0, kPi},
            {5.0, 5.0, -kPi + 1e-9},
            {0.0, 0.1, kPi - 1e-9},
            {100.0, 7.0, -1.6},
            {3.0, 3.0, 1e-9}};
  }
};
INSTANTIATE_TYPED_TEST_SUITE_P(Pose2, ManifoldLaws, ::testing::Types<Pose2>);

namespace {

void expectSame(const Pose2& a, const Pose2& b, double tolerance = 1e-12) {
  EXPECT_LE(minus(a, b).cwiseAbs().maxCoeff(), tolerance);
}

}  // namespace

TEST(Pose2, ChildAxisPointsWhereTheYawSays) {
  const Pose2 T_map_body{10.0, 20.0, 0.5 * kPi};
  const Eigen::Vector2d p_map = T_map_body * Eigen::Vector2d(2.0, 1.0);
  EXPECT_NEAR(p_map.x(), 9.0, 1e-12);
  EXPECT_NEAR(p_map.y(), 22.0, 1e-12);
}

TEST(Pose2, ProductTakesPointsThroughBothFrames) {
  const Pose2 T_a_b{1.0, 2.0, 0.3};
  const Pose2 T_b_c{-4.0, 0.5, 2.9};
  const Eigen::Vector2d p_c(0.7, -1.1);
  EXPECT_LE(((T_a_b * T_b_c) * p_c - T_a_b * (T_b_c * p_c)).norm(), 1e-12);
  EXPECT_NEAR((T_a_b * T_b_c).yaw, 3.2 - 2.0 * kPi, 1e-12);
}

TEST(Pose2, InverseUndoesOnBothSides) {
  for (const Pose2& x : ManifoldSamples<Pose2>::states()) {
    expectSame(x * inverse(x), {});
    expectSame(inverse(x) * x, {});
  }
}

TEST(Pose2, TranslationOfTheTangentIsInParentAxes) {
  const Pose2 moved = plus(Pose2{1.0, 1.0, 0.5 * kPi}, Vector<3>(0.25, 0.0, 0.0));
  EXPECT_DOUBLE_EQ(moved.x, 1.25);
  EXPECT_DOUBLE_EQ(moved.y, 1.0);
}

TEST(Pose2, HeadingDifferenceGoesTheShortWayOverTheSeam) {
  const Vector<3> d = minus(Pose2{0.0, 0.0, -kPi + 0.1}, Pose2{0.0, 0.0, kPi - 0.1});
  EXPECT_NEAR(d[2], 0.2, 1e-12);
  EXPECT_NEAR(plus(Pose2{0.0, 0.0, kPi - 0.1}, d).yaw, -kPi + 0.1, 1e-12);
}

TEST(Pose2, RotationMatrixTurnsCounterClockwise) {
  const Eigen::Vector2d turned = rotation2(radians(30.0)) * Eigen::Vector2d::UnitX();
  EXPECT_NEAR(turned.x(), std::sqrt(3.0) / 2.0, 1e-15);
  EXPECT_NEAR(turned.y(), 0.5, 1e-15);
}

TEST(Belief, StartsWithoutSpread) {
  const Belief<Pose2> belief;
  EXPECT_EQ(belief.covariance, (Matrix<3, 3>::Zero()));
  EXPECT_EQ(belief.mean.yaw, 0.0);
}

}  // namespace pos
