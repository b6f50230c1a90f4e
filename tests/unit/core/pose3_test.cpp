#include "pos/core/pose3.hpp"

#include <gtest/gtest.h>

#include "support/manifold_laws.hpp"

namespace pos {

template <>
struct ManifoldSamples<Pose3> {
  static std::vector<Pose3> states() {
    return {{},
            Pose3::fromXyzYawPitchRoll(1.0, 2.0, 3.0, 0.4, -0.2, 0.1),
            Pose3::fromXyzYawPitchRoll(-5.0, 0.0, 1.0, kPi - 1e-9, 0.0, 0.0),
            Pose3::fromXyzYawPitchRoll(0.0, 9.0, 0.0, -kPi + 1e-9, 0.05, -0.05),
            Pose3::fromXyzYawPitchRoll(0.0, 0.0, -2.0, -1.0, 0.5 * kPi, 0.0),
            Pose3::fromXyzYawPitchRoll(0.0, 0.0, 0.0, 1e-9, -1e-9, 1e-9)};
  }
};
INSTANTIATE_TYPED_TEST_SUITE_P(Pose3, ManifoldLaws, ::testing::Types<Pose3>);

namespace {

double distance(const Pose3& a, const Pose3& b) {
  return minus(a, b).cwiseAbs().maxCoeff();
}

}  // namespace

TEST(Pose3, YawPitchRollTurnsAboutZThenYThenX) {
  // Half a turn of roll after a quarter of yaw: the body's z axis looks down, its x axis along the map's y.
  const Pose3 T = Pose3::fromXyzYawPitchRoll(0.0, 0.0, 0.0, 0.5 * kPi, 0.0, kPi);
  EXPECT_LE((T.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LE((T.rotation * Eigen::Vector3d::UnitZ() + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  // Positive pitch lowers the nose of a body whose y axis points left.
  const Pose3 nose = Pose3::fromXyzYawPitchRoll(0.0, 0.0, 0.0, 0.0, 0.1, 0.0);
  EXPECT_NEAR((nose.rotation * Eigen::Vector3d::UnitX()).z(), -std::sin(0.1), 1e-12);
}

TEST(Pose3, ProductAndInverseFollowThePoints) {
  const std::vector<Pose3> states = ManifoldSamples<Pose3>::states();
  const Eigen::Vector3d p(0.3, -2.0, 1.5);
  for (const Pose3& a : states) {
    EXPECT_LE(distance(a * inverse(a), {}), 1e-12);
    EXPECT_LE(distance(inverse(a) * a, {}), 1e-12);
    for (const Pose3& b : states) EXPECT_LE(((a * b) * p - a * (b * p)).norm(), 1e-12);
  }
}

TEST(Pose3, TranslationOfTheTangentIsInParentAxesAndRotationInChildAxes) {
  const Pose3 start = Pose3::fromXyzYawPitchRoll(1.0, 0.0, 0.0, 0.5 * kPi, 0.0, 0.0);
  Vector<6> d = Vector<6>::Zero();
  d[0] = 0.5;
  d[3] = 0.2;  // about the body's x axis, which is the map's y axis
  const Pose3 moved = plus(start, d);
  EXPECT_NEAR(moved.translation.x(), 1.5, 1e-12);
  const Eigen::Matrix3d expected =
      Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()).toRotationMatrix() * start.rotation.toRotationMatrix();
  EXPECT_LE((moved.rotation.toRotationMatrix() - expected).norm(), 1e-12);
}

TEST(Pose3, PlanarPoseRoundTrips) {
  for (const double yaw : {0.0, 1.0, -3.0, kPi, 3.1415}) {
    const Pose2 planar{4.0, -5.0, yaw};
    const Pose3 raised = Pose3::fromPlanar(planar, 7.0);
    EXPECT_EQ(raised.translation.z(), 7.0);
    EXPECT_LE(minus(raised.planar(), planar).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Pose3, YawIsTheHeadingSeenFromAboveWhateverPitchAndRoll) {
  const Pose3 tilted = Pose3::fromXyzYawPitchRoll(0.0, 0.0, 0.0, 2.5, 0.3, -0.4);
  EXPECT_NEAR(tilted.yaw(), 2.5, 1e-12);
}

TEST(RotationVector, AgreesWithAngleAxisFromTinyToAlmostHalfATurn) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  for (const double angle : {0.0, 1e-14, 1e-9, 1.9e-4, 2.1e-4, 1e-3, 0.5, 3.0, kPi - 1e-7}) {
    const Eigen::Quaterniond q = quaternionFromRotationVector(angle * axis);
    const Eigen::Quaterniond expected(Eigen::AngleAxisd(angle, axis));
    EXPECT_LE((q.coeffs() - expected.coeffs()).norm(), 1e-15) << angle;
    EXPECT_LE((rotationVector(q) - angle * axis).norm(), 1e-14 + 1e-15 * angle) << angle;
  }
}

TEST(RotationVector, BothSignsOfAQuaternionGiveTheShortWay) {
  const Eigen::Vector3d w(0.1, 0.2, -0.3);
  const Eigen::Quaterniond q = quaternionFromRotationVector(w);
  const Eigen::Quaterniond negative(-q.w(), -q.x(), -q.y(), -q.z());
  EXPECT_LE((rotationVector(negative) - w).norm(), 1e-14);
}

TEST(RotationVector, DerivativeAtZeroIsTheIdentity) {
  constexpr double kStep = 1e-7;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d w = kStep * Eigen::Vector3d::Unit(i);
    const Eigen::Quaterniond q = quaternionFromRotationVector(w);
    EXPECT_LE((2.0 * q.vec() / kStep - Eigen::Vector3d::Unit(i)).norm(), 1e-12);
  }
}

}  // namespace pos
