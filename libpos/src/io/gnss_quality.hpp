#pragma once
/// What a satellite fix is worth whose receiver does not say. Private to io.

#include <array>

#include "pos/core/measurement.hpp"

namespace pos::io {

/// m^2, east north up. Horizontal 1-sigma of one unit of dilution: autonomous 3 m, differential 0.7 m, float
/// 0.3 m, fixed 0.015 m, none 100 m; vertical 1.5 times that. Usual receiver figures (u-blox and Septentrio
/// data sheets).
inline Matrix<3, 3> defaultCovariance(GnssFix::Quality quality, double dilution) {
  constexpr std::array<double, 5> kSigma{100.0, 3.0, 0.7, 0.3, 0.015};  // m, in the enum's order
  const double sigma = kSigma[static_cast<std::size_t>(quality)] * dilution;
  return Vector<3>{sigma * sigma, sigma * sigma, 2.25 * sigma * sigma}.asDiagonal();
}

}  // namespace pos::io
