#pragma once
/// Counter-based random numbers: value i of stream s under seed k is a pure function of (k, s, i), so results
/// do not depend on the order or the number of threads that asked.

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace pos {

/// Philox4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011).
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

/// A sequence drawn from one (seed, stream) pair. Copying it copies the position in the sequence.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream) : seed_(seed), stream_(stream) {}

  std::uint32_t bits();
  /// Uniform in the open interval (0, 1).
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal (Box-Muller on two uniforms; the second value is kept for the next call).
  double normal();
  double normal(double mean, double sigma) { return mean + sigma * normal(); }
  bool bernoulli(double probability) { return uniform() < probability; }

  // UniformRandomBitGenerator, for std::shuffle and friends.
  using result_type = std::uint32_t;
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return 0xffffffffU; }
  result_type operator()() { return bits(); }

 private:
  std::uint64_t seed_;
  std::uint64_t stream_;
  std::uint64_t block_ = 0;
  std::array<std::uint32_t, 4> words_{};
  unsigned used_ = 4;
  double spare_normal_ = 0.0;
  bool has_spare_ = false;
};

/// Three independent standard normals, drawn in the order x, y, z whatever the compiler: the order in which
/// the arguments of a call are evaluated is open, so draws never stand side by side in one.
Eigen::Vector3d normals(RandomStream& random);

}  // namespace pos
