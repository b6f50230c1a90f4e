#pragma once
/// Angles in radians, counter-clockwise positive.

#include <cmath>
#include <numbers>

namespace pos {

inline constexpr double kPi = std::numbers::pi;

constexpr double radians(double degrees) {
  return degrees * (kPi / 180.0);
}
constexpr double degrees(double radians) {
  return radians * (180.0 / kPi);
}

/// The same direction in (-pi, pi]. Every heading difference passes through here.
inline double wrapAngle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

}  // namespace pos
