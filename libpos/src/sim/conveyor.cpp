#include "conveyor.hpp"

#include <algorithm>
#include <cmath>

#include "blend.hpp"
#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"
#include "pos/core/random.hpp"

namespace pos::sim {
namespace {

/// Random streams of the bends start here, away from the sensors' small numbers.
constexpr std::uint64_t kFirstStream = 0x62656e6400000000U;

}  // namespace

void Harmonics::add(int n, double amplitude, double phase) {
  // sin(-n phi + phase) = -sin(n phi - phase)
  if (n < 0) return add(-n, -amplitude, -phase);
  sines_[static_cast<std::size_t>(n)] += amplitude * std::cos(phase);
  cosines_[static_cast<std::size_t>(n)] += amplitude * std::sin(phase);
}

void Harmonics::addWindowedSine(int j, double amplitude, double phase) {
  // sin^2(phi) sin(j phi + a) = sin(j phi + a) / 2 - (sin((j + 2) phi + a) + sin((j - 2) phi + a)) / 4
  add(j, 0.5 * amplitude, phase);
  add(j + 2, -0.25 * amplitude, phase);
  add(j - 2, -0.25 * amplitude, phase);
}

Harmonics Harmonics::random(double length, std::uint64_t seed, std::uint64_t stream) {
  RandomStream draw(seed, stream);
  Harmonics waves(length);
  // One long, one middle and one short wave: j in 2..4, 5..7, 8..11.
  for (const auto& [low, high] : {std::array{2, 4}, std::array{5, 7}, std::array{8, 11}}) {
    const int j = low + static_cast<int>(draw.uniform() * (high - low + 1));
    const double amplitude = draw.uniform(0.3, 1.0);
    waves.addWindowedSine(j, amplitude, draw.uniform(0.0, 2.0 * kPi));
  }
  return waves;
}

Waves Harmonics::at(double station) const {
  if (station <= 0.0 || station >= length_) return {};
  const double w = kPi / length_;
  const double c1 = std::cos(w * station);
  const double s1 = std::sin(w * station);
  double c = 1.0;
  double s = 0.0;
  Waves sum{.value = cosines_[0]};
  for (std::size_t n = 1; n < kCount; ++n) {
    const double next = c * c1 - s * s1;
    s = s * c1 + c * s1;
    c = next;
    const double k = w * static_cast<double>(n);
    const double value = cosines_[n] * c + sines_[n] * s;
    const double slope = k * (sines_[n] * c - cosines_[n] * s);
    sum.value += value;
    sum.d1 += slope;
    sum.d2 -= k * k * value;
    sum.d3 -= k * k * slope;
  }
  return sum;
}

Harmonics Harmonics::plus(const Harmonics& other, double share) const {
  Harmonics sum = *this;
  for (std::size_t n = 0; n < kCount; ++n) {
    sum.cosines_[n] += share * other.cosines_[n];
    sum.sines_[n] += share * other.sines_[n];
  }
  return sum;
}

Harmonics Harmonics::withPeak(double peak) const {
  double highest = 0.0;
  for (double station = 0.0; station < length_; station += 0.25) {
    highest = std::max(highest, std::abs(at(station).value));
  }
  return Harmonics(length_).plus(*this, highest > 0.0 ? peak / highest : 0.0);
}

Conveyor::Conveyor(const ShearerConfig& config) : config_(config) {
  double creep = 0.0;
  for (int i = 0; i <= config.passes; ++i) {
    const auto number = static_cast<std::size_t>(i);
    const auto waves = [&](std::uint64_t kind) {
      return Harmonics::random(config.pass_length, config.seed, kFirstStream + 2 * number + kind);
    };
    if (i > 0 && number <= config.creep.size()) creep += config.creep[number - 1];
    Line line{i * config.advance, creep, waves(0).withPeak(config.bend_peak),
              waves(1).withPeak(config.floor_peak)};
    if (i > 0) {
      line.bend = line.bend.plus(lines_.back().bend, config.inherited).withPeak(config.bend_peak);
      line.floor = line.floor.plus(lines_.back().floor, config.inherited).withPeak(config.floor_peak);
    }
    lines_.push_back(line);
  }
}

LinePoint Conveyor::on(int line, double station) const {
  ensure(line >= 0 && static_cast<std::size_t>(line) < lines_.size(), "a conveyor line that does not exist");
  const Line& here = lines_[static_cast<std::size_t>(line)];
  LinePoint point{.p = {here.x, station + here.creep, 0.0}};
  if (config_.bend_peak > 0.0) {
    const Waves bend = here.bend.at(station);
    point.p.x() += bend.value;
    point.d1.x() = bend.d1;
    point.d2.x() = bend.d2;
    point.d3.x() = bend.d3;
  }
  if (config_.floor_peak > 0.0) {
    const Waves floor = here.floor.at(station);
    point.p.z() = floor.value;
    point.d1.z() = floor.d1;
    point.d2.z() = floor.d2;
    point.d3.z() = floor.d3;
  }
  return point;
}

LinePoint Conveyor::between(int line, double station, double end_station) const {
  const double away = std::abs(station - end_station);
  if (away <= config_.s_bend_from) return on(line, station);
  if (away >= config_.s_bend_to) return on(line + 1, station);
  const double width = config_.s_bend_to - config_.s_bend_from;
  const double sign = (station > end_station ? 1.0 : -1.0) / width;  // du / dS
  const BlendPoint blend = blendAt(Blend::Cosine, 0.0, (away - config_.s_bend_from) / width);
  const double w0 = blend.value;
  const double w1 = blend.rate * sign;
  const double w2 = blend.bend * sign * sign;
  const double w3 = -kPi * kPi * blend.rate * sign * sign * sign;
  const LinePoint from = on(line, station);
  const LinePoint to = on(line + 1, station);
  const Eigen::Vector3d g0 = to.p - from.p;
  const Eigen::Vector3d g1 = to.d1 - from.d1;
  const Eigen::Vector3d g2 = to.d2 - from.d2;
  const Eigen::Vector3d g3 = to.d3 - from.d3;
  return {.p = from.p + w0 * g0,
          .d1 = from.d1 + w1 * g0 + w0 * g1,
          .d2 = from.d2 + w2 * g0 + 2.0 * w1 * g1 + w0 * g2,
          .d3 = from.d3 + w3 * g0 + 3.0 * w2 * g1 + 3.0 * w1 * g2 + w0 * g3};
}

}  // namespace pos::sim
