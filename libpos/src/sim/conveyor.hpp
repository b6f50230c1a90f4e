#pragma once
/// The conveyor's lines: where each lies, with its bend and the waves of the floor.

#include <array>
#include <vector>

#include "pos/sim/shearer.hpp"

namespace pos::sim {

/// A value and three derivatives by station.
struct Waves {
  double value = 0.0;
  double d1 = 0.0;
  double d2 = 0.0;
  double d3 = 0.0;
};

/// Sum of cos and sin of n pi S / length, n = 0..13, inside [0, length]; zero outside.
class Harmonics {
 public:
  static constexpr std::size_t kCount = 14;
  explicit Harmonics(double length) : length_(length) {}

  /// Three sines of wavelengths 2 length / j (j = 2..11: 350 to 64 m of a 350 m face) with random
  /// amplitudes and phases, under a window sin^2(pi S / length), so that value and slope are 0 at both ends.
  static Harmonics random(double length, std::uint64_t seed, std::uint64_t stream);

  Waves at(double station) const;
  /// The same with the peak of |value| (looked for every 0.25 m) at `peak`.
  Harmonics withPeak(double peak) const;
  Harmonics plus(const Harmonics& other, double share) const;

 private:
  void addWindowedSine(int j, double amplitude, double phase);
  void add(int n, double amplitude, double phase);

  double length_;
  std::array<double, kCount> cosines_{};
  std::array<double, kCount> sines_{};
};

/// A point of a line and its derivatives by station.
struct LinePoint {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector3d d1 = Eigen::Vector3d::UnitY();
  Eigen::Vector3d d2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d d3 = Eigen::Vector3d::Zero();
};

class Conveyor {
 public:
  explicit Conveyor(const ShearerConfig& config);

  /// Lines 0 .. passes.
  LinePoint on(int line, double station) const;
  /// On the S-bend from `line` to the next, seen from the end at `end_station`.
  LinePoint between(int line, double station, double end_station) const;

 private:
  struct Line {
    double x = 0.0;
    double creep = 0.0;
    Harmonics bend;
    Harmonics floor;
  };
  ShearerConfig config_;
  std::vector<Line> lines_;
};

}  // namespace pos::sim
