#include "blend.hpp"

#include "pos/core/angle.hpp"

namespace pos::sim {
namespace {

/// First half and plateau of the trapezoid; the rest follows by symmetry.
BlendPoint trapezoidStart(double ramp, double u) {
  const double peak = 1.0 / (1.0 - ramp);
  if (u < ramp) {
    return {peak * u * u * u / (6.0 * ramp), peak * u * u / (2.0 * ramp), peak * u / ramp, peak / ramp};
  }
  return {peak * (0.5 * u * u - 0.5 * ramp * u + ramp * ramp / 6.0), peak * (u - 0.5 * ramp), peak, 0.0};
}

BlendPoint trapezoid(double ramp, double u) {
  if (u <= 1.0 - ramp) return trapezoidStart(ramp, u);
  const BlendPoint mirrored = trapezoidStart(ramp, 1.0 - u);
  return {u - 0.5 + mirrored.integral, 1.0 - mirrored.value, mirrored.rate, -mirrored.bend};
}

BlendPoint cosine(double u) {
  const double s = std::sin(kPi * u);
  const double c = std::cos(kPi * u);
  return {0.5 * u - s / (2.0 * kPi), 0.5 * (1.0 - c), 0.5 * kPi * s, 0.5 * kPi * kPi * c};
}

BlendPoint smooth(double u) {
  const double u2 = u * u;
  return {u2 * u2 * (2.5 - 3.0 * u + u2), u2 * u * (10.0 - 15.0 * u + 6.0 * u2),
          30.0 * u2 * (1.0 - 2.0 * u + u2), 60.0 * u * (1.0 - 3.0 * u + 2.0 * u2)};
}

}  // namespace

BlendPoint blendAt(Blend blend, double ramp, double u) {
  switch (blend) {
    case Blend::Trapezoid:
      if (ramp > 0.0) return trapezoid(ramp, u);
      break;
    case Blend::Cosine:
      return cosine(u);
    case Blend::Smooth:
      return smooth(u);
    case Blend::Linear:
      break;
  }
  return {0.5 * u * u, u, 1.0, 0.0};
}

double peakRate(Blend blend, double ramp) {
  switch (blend) {
    case Blend::Trapezoid:
      return 1.0 / (1.0 - ramp);
    case Blend::Cosine:
      return 0.5 * kPi;
    case Blend::Smooth:
      return 15.0 / 8.0;
    case Blend::Linear:
      break;
  }
  return 1.0;
}

}  // namespace pos::sim
