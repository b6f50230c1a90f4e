#include "pos/estimation/sins_dr.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pos::estimation {
namespace {

constexpr double kRest = 8.0;          // s
constexpr double kPush = 0.5;          // m/s^2
constexpr double kPushTime = 10.0;     // s
constexpr double kDriveTime = 60.0;    // s
constexpr double kYawSigma = 0.02;     // rad
constexpr double kImuInterval = 0.01;  // s

/// Way along x, m: at rest, pushed, then at the speed reached.
double wayAt(double t) {
  const double pushed = std::clamp(t - kRest, 0.0, kPushTime);
  const double after = std::max(0.0, t - kRest - kPushTime);
  return 0.5 * kPush * pushed * pushed + kPush * kPushTime * after;
}

Measurement inertial(double t) {
  const bool pushed = t > kRest + 1e-9 && t < kRest + kPushTime + 1e-9;
  const ImuSample sample{.linear = {pushed ? kPush : 0.0, 0.0, 9.80665}};
  return {stampFromSeconds(t), "imu", sample};
}

Measurement wheels(double t, double before) {
  const double speed = (wayAt(t) - wayAt(before)) / (t - before);
  return {stampFromSeconds(t), "wheels", WheelSpeeds{speed, speed}};
}

/// Straight on with perfect sensors, wheels read every `interval` from `phase` on. Nothing tells the heading.
Estimate driven(double interval, double phase) {
  SinsDrConfig config;
  config.start.yaw_sigma = kYawSigma;
  config.alignment.time = kRest - 1.0;
  config.imu.gyro_bias_sigma = config.imu.gyro_bias_walk = 1e-9;
  SinsDr filter(config, nullptr);
  const double end = kRest + kPushTime + kDriveTime;
  double last = phase - interval;
  for (int k = 0; kImuInterval * k < end; ++k) {
    const double t = kImuInterval * k;
    // What an inertial sample and the wheels read at the same moment: the inertial sample comes first.
    for (; last + interval < t - 1e-9; last += interval) (void)filter.ingest(wheels(last + interval, last));
    (void)filter.ingest(inertial(t));
  }
  return filter.estimateAt(stampFromSeconds(end)).value();
}

TEST(SinsDr, WheelsAndInertialUnitAloneDoNotTellTheHeading) {
  for (const double interval : {0.01, 0.02, 0.05, 0.1, 0.25}) {
    for (const double phase : {0.0, 0.003}) {
      const Estimate end = driven(interval, phase);
      const double way = wayAt(kRest + kPushTime + kDriveTime);
      EXPECT_NEAR(end.T_map_body.translation.x(), way, 0.05) << interval << ", " << phase;
      EXPECT_GT(std::sqrt(end.covariance(5, 5)), 0.97 * kYawSigma) << interval << ", " << phase;
      // A heading that is wrong all the way puts the vehicle that much aside.
      EXPECT_GT(std::sqrt(end.covariance(1, 1)), 0.97 * kYawSigma * way) << interval << ", " << phase;
      EXPECT_LT(std::sqrt(end.covariance(1, 1)), 1.10 * kYawSigma * way) << interval << ", " << phase;
    }
  }
}

}  // namespace
}  // namespace pos::estimation
