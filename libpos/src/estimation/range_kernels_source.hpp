#pragma once
/// The loop of range_kernels.hpp, for the instruction set of the file that includes this.

#include "pos/core/lanes_math.hpp"
#include "range_kernels.hpp"

namespace pos::estimation::kernel {
namespace {

using namespace pos::lanes;

constexpr float kLeastWeight = 1e-30F;  // filters/particle_set.hpp

struct Accumulated {
  Sum weight, likelihood, distance, distance2;
};

enum class Exponent { One, Given };

/// Distances are worked out for this many particles before any is used. One loop through everything would be
/// one chain of operations so long that the processor cannot look ahead far enough to overlap the particles;
/// cut in two, it takes half the time (bench/mcl.cpp).
constexpr std::size_t kSlice = 256;

POS_LANE_FUNCTION void distances(float* distance, const RangeBlock& b, std::size_t first, std::size_t count) {
  for (std::size_t k = 0; k < count; k += kWidth) {
    const std::size_t i = first + k;
    const Floats c = load(b.cosine + i);
    const Floats s = load(b.sine + i);
    const Floats dx = (b.anchor_x - load(b.x + i)) - (c * b.tag_x - s * b.tag_y);
    const Floats dy = (b.anchor_y - load(b.y + i)) - (s * b.tag_x + c * b.tag_y);
    store(distance + k, root((dx * dx + dy * dy) + b.height2));
  }
}

POS_LANE_FUNCTION void likelihoods(float* likelihood, const float* distance, const RangeBlock& b,
                                   std::size_t count) {
  for (std::size_t k = 0; k < count; k += kWidth) {
    const Floats nu = b.range - load(distance + k);
    store(likelihood + k, b.inlier * power2(nu * nu * b.slope) + b.outlier);
  }
}

POS_LANE_FUNCTION void addSums(Accumulated& sums, const float* distance, const float* likelihood,
                               const RangeBlock& b, std::size_t first, std::size_t count) {
  for (std::size_t k = 0; k < count; k += kGroup) {
    for (std::size_t p = 0; p < kParts; ++p) {
      const std::size_t at = k + kWidth * p;
      const Floats off = load(distance + at) - b.centre;
      const Floats w = load(b.weight + first + at);
      const Floats product = w * load(likelihood + at);
      const Floats moment = w * off;
      sums.weight.add(p, w);
      sums.likelihood.add(p, product);
      sums.distance.add(p, moment);
      sums.distance2.add(p, moment * off);
      store(b.posterior + first + at, larger(product, all(kLeastWeight)));
    }
  }
}

/// The weights with a power of the likelihood, in place of those with the likelihood itself.
POS_LANE_FUNCTION void raise(float* likelihood, const RangeBlock& b, std::size_t first, std::size_t count) {
  for (std::size_t k = 0; k < count; k += kWidth) {
    store(likelihood + k, b.power * logarithm2(load(likelihood + k)));
  }
  for (std::size_t k = 0; k < count; k += kWidth) {
    const Floats product = load(b.weight + first + k) * power2(load(likelihood + k));
    store(b.posterior + first + k, larger(product, all(kLeastWeight)));
  }
}

/// Particles first .. first + count, a multiple of sixteen and at most kSlice.
template <Exponent kExponent>
POS_LANE_FUNCTION void addSlice(Accumulated& sums, const RangeBlock& b, std::size_t first,
                                std::size_t count) {
  alignas(64) float distance[kSlice];
  alignas(64) float likelihood[kSlice];
  distances(distance, b, first, count);
  likelihoods(likelihood, distance, b, count);
  addSums(sums, distance, likelihood, b, first, count);
  if constexpr (kExponent == Exponent::Given) raise(likelihood, b, first, count);
}

template <Exponent kExponent>
void addLast(Accumulated& sums, const RangeBlock& block, std::size_t first) {
  float spare[6][kGroup] = {};  // weights 0: those that do not exist add nothing
  const std::size_t bytes = (block.count - first) * sizeof(float);
  const float* const arrays[5] = {block.x, block.y, block.cosine, block.sine, block.weight};
  for (int k = 0; k < 5; ++k) __builtin_memcpy(spare[k], arrays[k] + first, bytes);
  RangeBlock last = block;
  last.x = spare[0];
  last.y = spare[1];
  last.cosine = spare[2];
  last.sine = spare[3];
  last.weight = spare[4];
  last.posterior = spare[5];
  addSlice<kExponent>(sums, last, 0, kGroup);
  __builtin_memcpy(block.posterior + first, spare[5], bytes);
}

template <Exponent kExponent>
RangeBlockSums evaluated(const RangeBlock& given) {
  const RangeBlock block = given;  // a copy that the stores below cannot change
  Accumulated sums;
  const std::size_t whole = block.count / kGroup * kGroup;
  for (std::size_t i = 0; i < whole; i += kSlice) {
    addSlice<kExponent>(sums, block, i, whole - i < kSlice ? whole - i : kSlice);
  }
  if (whole < block.count) addLast<kExponent>(sums, block, whole);
  return {sums.weight.total(), sums.likelihood.total(), sums.distance.total(), sums.distance2.total()};
}

}  // namespace
}  // namespace pos::estimation::kernel
