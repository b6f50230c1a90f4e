#pragma once
/// Wheels as an odometer: counters, exact arcs, noise (Jiang et al. 2024, eq. 1 and section 1.1 as
/// corrected).

#include <cstdint>
#include <optional>

#include "pos/core/pose2.hpp"

namespace pos::ins {

struct OdometerConfig {
  double wheel_radius = 0.0;       ///< m
  double track = 0.0;              ///< m between the wheels of the non-steered axle
  double ticks_per_turn = 0.0;     ///< counts per turn of a wheel
  int counter_bits = 32;           ///< width of the counters, 1..62
  double noise_per_sqrt_m = 0.01;  ///< m per sqrt(m) rolled, each wheel (k_d)

  bool operator==(const OdometerConfig&) const = default;
};

/// The same, or ConfigError.
OdometerConfig validated(OdometerConfig config);

/// Distances the two wheels rolled, m.
struct WheelWay {
  double left = 0.0;
  double right = 0.0;

  /// Way of the middle of the axle, m.
  double middle() const { return 0.5 * (left + right); }
  /// Turn, rad counter-clockwise; spins as readily as it drives.
  double turn(double track) const { return (right - left) / track; }
};

/// Difference of two counters that wrap at 2^bits: the smaller way round, so a wheel may also turn back.
std::int64_t unwrapped(std::int64_t now, std::int64_t before, int bits);

/// Counters to ways; nothing for the first reading.
class TickCounter {
 public:
  explicit TickCounter(const OdometerConfig& config) : config_(config) {}
  std::optional<WheelWay> way(std::int64_t left, std::int64_t right);
  void forget() { started_ = false; }

 private:
  OdometerConfig config_;
  std::int64_t left_ = 0;
  std::int64_t right_ = 0;
  bool started_ = false;
};

/// Pose after driving `way` and turning `turn` at constant curvature: the chord of the arc, along its middle
/// heading. Exact for every arc, straight lines and turns on the spot among them.
Pose2 arc(double way, double turn);

/// sin(u) / u, by its series near zero.
double sinc(double u);

/// Variance of a wheel's way (m^2): k_d^2 |way| + the rounding of the counter to whole ticks (which
/// telescopes: it is noise of the position, not a random walk).
double wayVariance(const OdometerConfig& config, double way);

}  // namespace pos::ins
