#pragma once
/// Systematic resampling, and when to do it.

#include <cstdint>
#include <span>
#include <vector>

#include "pos/core/random.hpp"
#include "pos/filters/particle_set.hpp"

namespace pos::filters {

/// When to resample: once the effective size falls below a share of the particles (Liu and Chen 1998).
/// 0 = never, 1 = whenever the weights differ at all.
struct EffectiveSizePolicy {
  double below = 0.5;
  bool wantsResampling(std::span<const float> log_weight) const {
    return effectiveSize(log_weight) < below * static_cast<double>(log_weight.size());
  }
};

/// Draws the next generation. Owns the buffers, so that a filter in steady state allocates nothing.
class SystematicResampler {
 public:
  /// Index of the parent of each of `count` children. One uniform offset u in (0, 1) places a comb of `count`
  /// equal teeth over the cumulative weights (Kitagawa 1996): parent i gets floor or ceil of count * w_i
  /// children, count * w_i on average. Weights need not be normalised. Valid until the next call.
  std::span<const std::uint32_t> ancestors(std::span<const float> log_weight, std::size_t count,
                                           double offset);

  /// Replace the set by `count` equally weighted children. Deterministic for a given stream position.
  void resample(ParticleSet& set, std::size_t count, RandomStream& stream);

 private:
  std::vector<float> weight_;
  std::vector<std::uint32_t> ancestors_;
  ParticleSet children_;
};

}  // namespace pos::filters
