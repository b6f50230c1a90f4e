#include "pos/estimation/odometry_sigma.hpp"

#include <cmath>

namespace pos::estimation {

Vector<3> incrementSigma(const OdometryNoise& noise, const Pose2& increment, double dt) {
  const auto square = [](double value) { return value * value; };
  const double distance = increment.translation().norm();
  const double turn = std::abs(increment.yaw);
  const double standing = square(noise.position_per_sqrt_s) * dt;
  const double along = square(noise.distance_per_sqrt_m) * distance + standing;
  const double across = square(noise.lateral_per_sqrt_m) * distance + standing;
  const double yaw = square(noise.yaw_per_sqrt_m) * distance + square(noise.yaw_per_sqrt_rad) * turn +
                     square(noise.yaw_per_sqrt_s) * dt;
  return {std::sqrt(along), std::sqrt(across), std::sqrt(yaw)};
}

}  // namespace pos::estimation
