#pragma once
/// Systematic resampling, and when to do it.

#include <cstdint>
#include <vector>

#include "pos/core/random.hpp"
#include "pos/filters/particle_set.hpp"

namespace pos::filters {

/// When to resample: once the effective size falls below a share of the particles (Liu and Chen 1998).
/// 0 = never, 1 = whenever the weights differ at all.
struct EffectiveSizePolicy {
  double below = 0.5;
  bool wantsResampling(const ParticleSet& set) const {
    return effectiveSize(set) < below * static_cast<double>(set.size());
  }
};

/// Draws the next generation. Owns the buffer, 16 bytes a particle, so that a filter in steady state
/// allocates nothing.
class SystematicResampler {
 public:
  /// Replace the set by `count` level children. One uniform offset u in (0, 1) places a comb of `count` equal
  /// teeth over the cumulative weights (Kitagawa 1996): parent i gets floor or ceil of count * w_i children,
  /// count * w_i on average. Weights need not be normalised. Children of one parent stand side by side.
  void resample(ParticleSet& set, std::size_t count, double offset);
  /// The same with the stream's next number. Deterministic for a given stream position.
  void resample(ParticleSet& set, std::size_t count, RandomStream& stream) {
    resample(set, count, stream.uniform());
  }

 private:
  ParticleSet children_;
  std::vector<std::uint64_t> block_start_;  // cumulative weight before each block, in parts of a tooth
};

}  // namespace pos::filters
