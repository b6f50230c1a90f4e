#include "pos/uwb/motion_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "pos/core/random.hpp"

namespace pos::uwb {
namespace {

TEST(MotionCalibration, CentreAndCourseAreFound) {
  // A body mounted 5 degrees askew, 0.3 m ahead of the point that follows a winding course.
  std::vector<TimedPose> poses;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (int k = 0; k < 400; ++k) {
    const double t = 0.05 * k;
    const double course = 0.8 * std::sin(0.4 * t);
    constexpr double kOffset = 0.0873;
    const double yaw = course - kOffset;
    const Eigen::Vector2d p = centre + rotation2(yaw) * Eigen::Vector2d(0.3, 0.0);
    poses.push_back({stampFromSeconds(t), {p.x(), p.y(), wrapAngle(yaw)}});
    for (int i = 0; i < 50; ++i) {  // 1 m/s, in steps of 1 ms
      const double c = 0.8 * std::sin(0.4 * (t + 0.001 * (i + 0.5)));
      centre += 0.001 * Eigen::Vector2d(std::cos(c), std::sin(c));
    }
  }
  const MotionCalibration found = calibratedMotion(poses);
  EXPECT_NEAR(found.course_offset, 0.0873, 0.002);
  EXPECT_NEAR(found.centre_x, 0.3, 0.01);
  EXPECT_LT(found.residual_sigma, 0.01);
}

TEST(MotionCalibration, AVehicleThatStandsTellsNothing) {
  std::vector<TimedPose> poses(100);
  for (int k = 0; k < 100; ++k) poses[static_cast<std::size_t>(k)].stamp = stampFromSeconds(0.1 * k);
  EXPECT_EQ(calibratedMotion(poses).samples, 0);
}

TEST(MotionCalibration, NothingComesOfNothing) {
  EXPECT_EQ(calibratedMotion({}).samples, 0);
}

/// 1000 s of a vehicle whose speed (m/s per sqrt(s)) and yaw rate (rad/s per sqrt(s)) wander.
MotionCalibration wandering(double speed_density, double rate_density) {
  constexpr double kDt = 0.025;
  RandomStream random(5, 1);
  std::vector<TimedPose> poses;
  Pose2 pose;
  double speed = 20.0;  // so that it never stands
  double rate = 0.0;
  for (int k = 0; k < 40000; ++k) {
    poses.push_back({stampFromSeconds(kDt * k), pose});
    const Eigen::Vector2d moved = rotation2(pose.yaw + 0.5 * rate * kDt) * Eigen::Vector2d(speed * kDt, 0.0);
    pose = {pose.x + moved.x(), pose.y + moved.y(), wrapAngle(pose.yaw + rate * kDt)};
    speed += random.normal(0.0, speed_density * std::sqrt(kDt));
    rate += random.normal(0.0, rate_density * std::sqrt(kDt));
  }
  return calibratedMotion(poses);
}

TEST(MotionCalibration, DensitiesAreThoseOfTheWhiteAccelerationThatDroveIt) {
  // a thousand seconds are some 700 independent pairs: four sigmas are 11 %
  EXPECT_NEAR(wandering(0.12, 0.0).acceleration_density, 0.12, 0.013);
  EXPECT_NEAR(wandering(0.0, 0.05).yaw_acceleration_density, 0.05, 0.0055);
  EXPECT_LT(wandering(0.12, 0.0).yaw_acceleration_density, 1e-9);
}

}  // namespace
}  // namespace pos::uwb
