#include "pos/ins/odometer.hpp"

#include <cmath>

#include "pos/core/config_checks.hpp"

namespace pos::ins {

OdometerConfig validated(OdometerConfig config) {
  requireNotNegative(config.wheel_radius, "wheel_radius_m");
  requireNotNegative(config.track, "track_m");
  requireNotNegative(config.ticks_per_turn, "ticks_per_turn");
  if (config.ticks_per_turn > 0.0 && !(config.wheel_radius > 0.0)) {
    refuse("ticks say nothing without the wheel's radius", "wheel_radius_m",
           std::to_string(config.wheel_radius), "> 0");
  }
  if (config.counter_bits < 1 || config.counter_bits > 62) {
    refuse("no counter has this width", "counter_bits", std::to_string(config.counter_bits), "1 to 62");
  }
  requireNotNegative(config.noise_per_sqrt_m, "noise_m_per_sqrt_m");
  return config;
}

std::int64_t unwrapped(std::int64_t now, std::int64_t before, int bits) {
  const std::int64_t span = std::int64_t{1} << bits;
  std::int64_t difference = (now - before) % span;
  if (difference < 0) difference += span;
  return difference > span / 2 ? difference - span : difference;
}

std::optional<WheelWay> TickCounter::way(std::int64_t left, std::int64_t right) {
  std::optional<WheelWay> way;
  if (started_) {
    const double metres = 2.0 * M_PI * config_.wheel_radius / config_.ticks_per_turn;
    way = WheelWay{metres * static_cast<double>(unwrapped(left, left_, config_.counter_bits)),
                   metres * static_cast<double>(unwrapped(right, right_, config_.counter_bits))};
  }
  left_ = left;
  right_ = right;
  started_ = true;
  return way;
}

double sinc(double u) {
  return std::abs(u) < 1e-4 ? 1.0 - u * u / 6.0 : std::sin(u) / u;
}

Pose2 arc(double way, double turn) {
  const double chord = way * sinc(0.5 * turn);
  return {chord * std::cos(0.5 * turn), chord * std::sin(0.5 * turn), turn};
}

double wayVariance(const OdometerConfig& config, double way) {
  const double tick =
      config.ticks_per_turn > 0.0 ? 2.0 * M_PI * config.wheel_radius / config.ticks_per_turn : 0.0;
  return config.noise_per_sqrt_m * config.noise_per_sqrt_m * std::abs(way) + tick * tick / 6.0;
}

}  // namespace pos::ins
