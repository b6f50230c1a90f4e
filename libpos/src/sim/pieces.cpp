#include "pieces.hpp"

#include <algorithm>

#include "blend.hpp"
#include "pos/core/angle.hpp"

namespace pos::sim {
namespace {

std::vector<double> trapezoidCorners(Blend blend, double ramp, double length) {
  if (blend != Blend::Trapezoid || ramp <= 0.0) return {};
  return {ramp, length - ramp};
}

}  // namespace

bool AnglePiece::steady() const {
  const bool linear =
      change.blend == Blend::Linear || (change.blend == Blend::Trapezoid && change.ramp == 0.0);
  return change.wave_amplitude == 0.0 && (change.by == 0.0 || linear);
}

Jet AnglePiece::at(double x) const {
  Jet jet{.value = start};
  if (change.by != 0.0) {
    const BlendPoint blend = blendAt(change.blend, change.ramp / length, x / length);
    jet.value += change.by * blend.value;
    jet.rate += change.by * blend.rate / length;
    jet.bend += change.by * blend.bend / (length * length);
  }
  if (change.wave_amplitude != 0.0) {
    const double w = 2.0 * kPi / change.wave_period;
    const double s = std::sin(w * x);
    const double c = std::cos(w * x);
    jet.value += change.wave_amplitude / w * (1.0 - c);
    jet.rate += change.wave_amplitude * s;
    jet.bend += change.wave_amplitude * w * c;
  }
  return jet;
}

std::vector<double> AnglePiece::corners() const {
  if (change.by == 0.0) return {};
  return trapezoidCorners(change.blend, change.ramp, length);
}

SpeedPiece::Value SpeedPiece::at(double x) const {
  if (steady()) return {from * x, from, 0.0};
  const BlendPoint point = blendAt(blend, ramp / length, x / length);
  const double gain = to - from;
  return {from * x + gain * length * point.integral, from + gain * point.value, gain * point.rate / length};
}

std::vector<double> SpeedPiece::corners() const {
  return steady() ? std::vector<double>{} : trapezoidCorners(blend, ramp, length);
}

std::size_t pieceIndex(const std::vector<double>& starts, double q) {
  const auto after = std::upper_bound(starts.begin(), starts.end(), q);
  return after == starts.begin() ? 0 : static_cast<std::size_t>(after - starts.begin()) - 1;
}

std::vector<double> tidied(std::vector<double> values, double from, double to) {
  constexpr double kSame = 1e-9;
  std::sort(values.begin(), values.end());
  std::vector<double> kept;
  for (const double value : values) {
    if (value <= from + kSame || value >= to - kSame) continue;
    if (kept.empty() || value - kept.back() > kSame) kept.push_back(value);
  }
  return kept;
}

}  // namespace pos::sim
