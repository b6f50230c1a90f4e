#include "pos/core/angle.hpp"

#include <gtest/gtest.h>

namespace pos {

TEST(Angle, DegreesAndRadiansAreInverse) {
  EXPECT_DOUBLE_EQ(radians(180.0), kPi);
  EXPECT_DOUBLE_EQ(radians(-90.0), -0.5 * kPi);
  EXPECT_DOUBLE_EQ(degrees(radians(37.5)), 37.5);
}

TEST(WrapAngle, BothEndsGivePlusPiExactly) {
  EXPECT_EQ(wrapAngle(kPi), kPi);
  EXPECT_EQ(wrapAngle(-kPi), kPi);
  EXPECT_EQ(wrapAngle(3.0 * kPi), kPi);
  EXPECT_EQ(wrapAngle(-3.0 * kPi), kPi);
}

TEST(WrapAngle, NextToTheSeamTheSignFlips) {
  const double below = std::nextafter(kPi, 0.0);
  const double above = std::nextafter(kPi, 4.0);
  EXPECT_EQ(wrapAngle(below), below);
  EXPECT_EQ(wrapAngle(-below), -below);
  EXPECT_LT(wrapAngle(above), 0.0);
  EXPECT_NEAR(wrapAngle(above), -kPi, 1e-15);
  EXPECT_GT(wrapAngle(-above), 0.0);
}

TEST(WrapAngle, InsideNothingChanges) {
  for (const double angle : {0.0, 1e-300, -1e-12, 1.0, -3.0, 3.14}) EXPECT_EQ(wrapAngle(angle), angle);
}

TEST(WrapAngle, ManyTurnsLeaveTheDirection) {
  for (int turns = -1000; turns <= 1000; turns += 250) {
    EXPECT_NEAR(wrapAngle(0.7 + 2.0 * kPi * turns), 0.7, 1e-12);
    EXPECT_NEAR(wrapAngle(-2.9 + 2.0 * kPi * turns), -2.9, 1e-12);
  }
}

TEST(WrapAngle, ResultLiesInTheHalfOpenInterval) {
  for (double angle = -20.0; angle < 20.0; angle += 0.0137) {
    const double wrapped = wrapAngle(angle);
    EXPECT_GT(wrapped, -kPi);
    EXPECT_LE(wrapped, kPi);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-14);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-14);
  }
}

}  // namespace pos
