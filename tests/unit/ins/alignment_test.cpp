#include "pos/ins/alignment.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "pos/core/pose3.hpp"
#include "pos/core/random.hpp"
#include "pos/ins/error_model.hpp"
#include "pos/ins/standstill.hpp"

namespace pos::ins {
namespace {

const Eigen::Vector3d kMine(1.95, 0.61, -350.0);

RestAverage restAt(const Eigen::Quaterniond& q, const EarthPoint& here, const Eigen::Vector3d& gyro_bias,
                   const Eigen::Vector3d& accelerometer_bias) {
  RestAverage rest;
  const Eigen::Vector3d w = q.conjugate() * here.omega_ie + gyro_bias;
  const Eigen::Vector3d f = q.conjugate() * Eigen::Vector3d(0, 0, here.gravity) + accelerometer_bias;
  for (int i = 0; i < 500; ++i) rest.add({w * 0.01, f * 0.01, 0.01});
  return rest;
}

TEST(Alignment, LevelsAndFindsTheGyroBias) {
  const EarthPoint here = Earth::ellipsoid().at(kMine);
  const Eigen::Quaterniond truth = Pose3::fromXyzYawPitchRoll(0, 0, 0, 0.8, 0.12, -0.2).rotation;
  const Eigen::Vector3d bias(1e-3, -2e-3, 3e-4);
  const RestAverage rest = restAt(truth, here, bias, Eigen::Vector3d::Zero());
  const Eigen::Quaterniond found = levelled(rest.force(), 0.8);
  EXPECT_LT(found.angularDistance(truth), 1e-9);
  EXPECT_LT((gyroBiasAtRest(rest, here, found) - bias).norm(), 1e-12);
  EXPECT_NEAR(rest.time(), 5.0, 1e-9);
}

TEST(Alignment, GyrocompassFindsTheHeadingWithPerfectGyros) {
  const EarthPoint here = Earth::ellipsoid().at(kMine);
  for (const double yaw : {-3.0, -1.0, 0.0, 0.5, 2.5}) {
    const Eigen::Quaterniond truth = Pose3::fromXyzYawPitchRoll(0, 0, 0, yaw, 0.05, 0.1).rotation;
    const auto found = gyrocompassHeading(restAt(truth, here, {0, 0, 0}, {0, 0, 0}), here);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(*found, yaw, 1e-9);
  }
  EXPECT_FALSE(gyrocompassHeading(RestAverage{}, Earth::flat().at({0, 0, 0})).has_value());
}

TEST(Alignment, CovarianceKnowsWhichTiltAnAccelerometerBiasMakes) {
  const EarthPoint here = Earth::ellipsoid().at(kMine);
  const Eigen::Quaterniond truth = Pose3::fromXyzYawPitchRoll(0, 0, 0, 2.0, 0.0, 0.0).rotation;
  const Eigen::Vector3d nabla(0.02, -0.01, 0.0);
  const RestAverage rest = restAt(truth, here, {0, 0, 0}, nabla);
  const Eigen::Quaterniond found = levelled(rest.force(), 2.0);
  // C^ = (I - [phi x]) C: phi is minus the rotation vector from C to C^ in n.
  const Eigen::Vector3d phi = -rotationVector(found * truth.conjugate());
  const auto P = alignmentCovariance({.accelerometer_bias = 0.02}, truth.toRotationMatrix(), here.gravity);
  const Eigen::Vector3d expected = P.block<3, 3>(kPhi, kAccelerometerBias) * nabla / (0.02 * 0.02);
  EXPECT_NEAR(phi.x(), expected.x(), 1e-6);
  EXPECT_NEAR(phi.y(), expected.y(), 1e-6);
  EXPECT_GT(std::abs(phi.x()) + std::abs(phi.y()), 1e-3);
}

TEST(Alignment, CovarianceIsPositiveSemiDefinite) {
  const auto P = alignmentCovariance({}, Eigen::Matrix3d::Identity(), 9.8);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 15, 15>> eigen(P);
  EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-18);
}

TEST(Standstill, SeesRestThroughNoiseAndMotionAtOnce) {
  StandstillDetector detector({.force_sigma = 0.05, .rate_sigma = 0.01, .threshold = 12.0});
  RandomStream random(1, 2);
  const auto sample = [&](double shake, double turn) {
    ImuIncrement s{{0, 0, turn * 0.01}, {0, 0, 9.80665 * 0.01}, 0.01};
    for (int i = 0; i < 3; ++i) {
      s.velocity[i] += 0.01 * random.normal(0.0, 0.05 + shake);
      s.angle[i] += 0.01 * random.normal(0.0, 0.01);
    }
    return s;
  };
  for (int i = 0; i < 49; ++i) detector.add(sample(0.0, 0.0));
  EXPECT_FALSE(detector.still()) << "the window is not full";
  int still = 0;
  for (int i = 0; i < 1000; ++i) {
    detector.add(sample(0.0, 0.0));
    still += detector.still() ? 1 : 0;
  }
  EXPECT_EQ(still, 1000);
  for (int i = 0; i < 50; ++i) detector.add(sample(0.0, 0.2));
  EXPECT_FALSE(detector.still()) << "turning";
  detector.forget();
  for (int i = 0; i < 60; ++i) detector.add(sample(0.5, 0.0));
  EXPECT_FALSE(detector.still()) << "shaken";
}

// At rest every axis adds a squared standard normal, six in all; the force's magnitude bias adds a little.
TEST(Standstill, StatisticAtRestIsItsExpectation) {
  StandstillDetector detector({.window = 20.0, .force_sigma = 0.05, .rate_sigma = 0.01});
  RandomStream random(4, 0);
  for (int i = 0; i < 2001; ++i) {
    ImuIncrement s{{0, 0, 0}, {0, 0, 0.0980665}, 0.01};
    for (int k = 0; k < 3; ++k) {
      s.velocity[k] += 0.01 * random.normal(0.0, 0.05);
      s.angle[k] += 0.01 * random.normal(0.0, 0.01);
    }
    detector.add(s);
  }
  ASSERT_TRUE(detector.statistic().has_value());
  EXPECT_NEAR(*detector.statistic(), 6.0, 3.0 * std::sqrt(12.0 / 2000.0));
}

}  // namespace
}  // namespace pos::ins
