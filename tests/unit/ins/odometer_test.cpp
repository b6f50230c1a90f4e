#include "pos/ins/odometer.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pos::ins {
namespace {

const OdometerConfig kCar{.wheel_radius = 0.05, .track = 0.2, .ticks_per_turn = 4000, .counter_bits = 16};

TEST(Odometer, CountersUnwrapBothWays) {
  EXPECT_EQ(unwrapped(3, 65534, 16), 5);
  EXPECT_EQ(unwrapped(65534, 3, 16), -5);
  EXPECT_EQ(unwrapped(10, 4, 16), 6);
  EXPECT_EQ(unwrapped(0, 0, 16), 0);
  EXPECT_EQ(unwrapped((std::int64_t{1} << 62) - 1, 0, 62), -1);
}

TEST(Odometer, TheFirstReadingSaysNothingAndATurnIsACircumference) {
  TickCounter counter(kCar);
  EXPECT_FALSE(counter.way(65000, 65000).has_value());
  const auto way = counter.way((65000 + 4000) % 65536, 65000 - 2000);
  ASSERT_TRUE(way.has_value());
  EXPECT_NEAR(way->left, 2.0 * M_PI * 0.05, 1e-12);
  EXPECT_NEAR(way->right, -M_PI * 0.05, 1e-12);
}

TEST(Odometer, AFullCircleComesBackToItsStartInAnyNumberOfSteps) {
  const double radius = 3.0;
  for (const int steps : {4, 7, 360}) {
    Pose2 pose;
    for (int i = 0; i < steps; ++i) pose = pose * arc(2.0 * M_PI * radius / steps, 2.0 * M_PI / steps);
    EXPECT_LT(pose.translation().norm(), 1e-12 * 2.0 * M_PI * radius);
  }
}

TEST(Odometer, StraightAndSpinAreLimitsOfTheArc) {
  const Pose2 straight = arc(2.0, 0.0);
  EXPECT_EQ(straight.x, 2.0);
  EXPECT_EQ(straight.y, 0.0);
  const Pose2 spin = arc(0.0, 1.0);
  EXPECT_EQ(spin.translation().norm(), 0.0);
  EXPECT_EQ(spin.yaw, 1.0);
  EXPECT_NEAR(sinc(0.99e-4), std::sin(0.99e-4) / 0.99e-4, 1e-15);
}

TEST(Odometer, TurnIsTheDifferenceOfTheWheelsOverTheTrack) {
  EXPECT_NEAR((WheelWay{1.0, 1.2}).turn(0.2), 1.0, 1e-12);
  EXPECT_LT((WheelWay{1.2, 1.0}).turn(0.2), 0.0);
}

TEST(Odometer, NoiseGrowsWithTheWayAndNeverLosesTheTick) {
  const double tick = 2.0 * M_PI * 0.05 / 4000;
  EXPECT_NEAR(wayVariance(kCar, 0.0), tick * tick / 6.0, 1e-18);
  EXPECT_NEAR(wayVariance(kCar, -4.0) - wayVariance(kCar, 0.0), 4e-4, 1e-12);
}

}  // namespace
}  // namespace pos::ins
