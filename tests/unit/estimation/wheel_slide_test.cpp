#include "pos/estimation/wheel_slide.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pos::estimation {
namespace {

constexpr double kSigma = 0.02;  // m/s

WheelSlideSample sample(double t, double wheels, double inertial, double fed_back = 0.0) {
  return {stampFromSeconds(t), {wheels, 0.0, 0.0}, {inertial, 0.0, 0.0}, kSigma, {fed_back, 0.0, 0.0}};
}

/// Wheels and accelerometers at 10 Hz: speeding up at 1 m/s^2, the wheels `slip` faster from 1.0 s on.
WheelSlide after(double until, double slip) {
  WheelSlide slide;
  for (double t = 0.0; t < until + 1e-9; t += 0.1)
    slide.add(sample(t, t + (t > 0.999 ? slip : 0.0), t - 3.0));
  return slide;
}

TEST(WheelSlide, SpeedingUpTogetherIsNoJumpAndSteady) {
  const WheelSlide slide = after(2.0, 0.0);
  ASSERT_TRUE(slide.jump());
  EXPECT_NEAR(slide.jump()->difference.norm(), 0.0, 1e-12);
  EXPECT_NEAR(slide.jump()->wheels.x(), 0.8, 1e-9) << "the wheels' own change";
  EXPECT_TRUE(slide.steady());
}

TEST(WheelSlide, AJumpIsThereWholeAfterThreeUpdatesAndGoneASecondLater) {
  EXPECT_NEAR(after(1.0, 0.3).jump()->difference.x(), 0.1, 1e-9);
  EXPECT_NEAR(after(1.2, 0.3).jump()->difference.x(), 0.3, 1e-9);
  EXPECT_NEAR(after(2.1, 0.3).jump()->difference.x(), 0.0, 1e-9);
  EXPECT_NEAR(after(1.2, 0.3).jump()->variance, 2.0 * kSigma * kSigma / 3.0, 1e-12);
}

TEST(WheelSlide, NothingIsSaidBeforeTheSecondIsOver) {
  EXPECT_FALSE(after(0.5, 0.0).jump());
  EXPECT_FALSE(after(0.5, 0.0).steady());
  EXPECT_TRUE(after(0.5, 0.0).steady(5)) << "of the newest half second it can be said";
}

TEST(WheelSlide, ShakingWheelsAreNotSteadyWhereverTheyEnd) {
  WheelSlide slide;
  for (int i = 0; i < 40; ++i) {
    const double t = 0.1 * i;
    slide.add(sample(t, 0.3 + 0.15 * std::sin(2.0 * std::numbers::pi * 1.3 * t), 0.0));
    if (i < 11) continue;
    EXPECT_FALSE(slide.steady()) << t;
    EXPECT_FALSE(slide.steady(5)) << t;
  }
}

TEST(WheelSlide, WhatIsLeftOfASlipCountsFromTheMark) {
  WheelSlide slide = after(1.2, 0.3);
  slide.mark();
  for (double t = 1.3; t < 2.0; t += 0.1) slide.add(sample(t, t + 0.3, t - 3.0));
  EXPECT_NEAR(slide.sinceMark(5).x(), 0.3, 1e-9);
  for (double t = 2.0; t < 2.6; t += 0.1) slide.add(sample(t, t, t - 3.0));
  EXPECT_NEAR(slide.sinceMark(5).x(), 0.0, 1e-9);
}

TEST(WheelSlide, FeedbackIsThatOfTheLastSecond) {
  WheelSlide slide;
  for (int i = 0; i <= 20; ++i) slide.add(sample(0.1 * i, 1.0, 1.0, 0.01 * i));
  EXPECT_NEAR(slide.fedBack().x(), 0.1, 1e-9);
}

}  // namespace
}  // namespace pos::estimation
