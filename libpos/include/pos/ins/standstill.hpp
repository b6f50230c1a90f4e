#pragma once
/// Does the vehicle stand still? Judged from the inertial unit alone.
///
/// Statistic (Skog et al. 2010, SHOE): over a window of N samples
///   T = 1/N sum( |f - g mean(f)/|mean(f)||^2 / sigma_f^2 + |w - w0|^2 / sigma_w^2 ),  still where T <
///   threshold.
/// w0 is the gyro bias as known; a slow steady motion at constant speed on rails looks like standstill to any
/// such detector, so wheels that turn may veto (the estimator's business).

#include <cstddef>
#include <optional>
#include <vector>

#include "pos/ins/mechanisation.hpp"

namespace pos::ins {

struct StandstillConfig {
  double window = 0.5;        ///< s
  double force_sigma = 0.05;  ///< m/s^2, of a sample at rest: noise and the engine's shaking
  double rate_sigma = 0.01;   ///< rad/s
  double threshold =
      6.0;  ///< mean of T at rest is about 6 (three axes each); engines shake: choose 2 to 3 times
  double gravity = 9.80665;  ///< m/s^2

  bool operator==(const StandstillConfig&) const = default;
};

/// The same, or ConfigError.
StandstillConfig validated(StandstillConfig config);

class StandstillDetector {
 public:
  explicit StandstillDetector(const StandstillConfig& config) : config_(config) {}

  /// Takes one sample, biases as known taken off. Samples of dt = 0 are ignored.
  void add(const ImuIncrement& sample);
  /// The statistic; nothing until the window is full.
  std::optional<double> statistic() const;
  bool still() const;
  void forget();

 private:
  struct Sample {
    Eigen::Vector3d f;
    Eigen::Vector3d w;
    double dt;
  };
  StandstillConfig config_;
  std::vector<Sample> ring_;
  std::size_t first_ = 0;
  double time_ = 0.0;
};

}  // namespace pos::ins
