#include "pos/filters/resampling.hpp"

#include <cstring>

#include "pos/core/error.hpp"
#include "pos/filters/comb.hpp"
#include "pos/filters/parallel.hpp"

namespace pos::filters {
namespace {

/// The same number four times, in one store.
void putFour(float* to, float value) {
  const float four[4] = {value, value, value, value};
  std::memcpy(to, four, sizeof(four));
}

/// Parents and children as bare arrays: x, y, yaw.
struct Arrays {
  const float* from[3];
  float* to[3];

  /// Every parent writes four children, wanted or not, and the next one overwrites what was too many: no
  /// branch to guess wrong unless it has more than four, or the end of its block's children, `end`, is near.
  void copy(std::size_t parent, std::size_t first, std::size_t next, std::size_t end) const {
    if (first + 4 <= end) [[likely]] {
      for (int a = 0; a < 3; ++a) putFour(to[a] + first, from[a][parent]);
      first += 4;
    }
    for (; first < next; ++first) {
      for (int a = 0; a < 3; ++a) to[a][first] = from[a][parent];
    }
  }
};

std::uint64_t sumOfShares(const Comb& comb, const float* weight, std::size_t count) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += comb.share(weight[i]);
  return sum;
}

void copyBlock(const Comb& comb, const Arrays& arrays, const float* weight, const Block& block,
               std::uint64_t cumulative, std::uint64_t cumulative_end) {
  const std::size_t end = comb.children(cumulative_end);
  std::size_t child = comb.children(cumulative);
  for (std::size_t i = block.first; i < block.first + block.count; ++i) {
    cumulative += comb.share(weight[i]);
    const std::size_t next = comb.children(cumulative);
    arrays.copy(i, child, next, end);
    child = next;
  }
}

}  // namespace

void SystematicResampler::resample(ParticleSet& set, std::size_t count, double offset) {
  const std::size_t n = set.size();
  ensure(n > 0 && count > 0, "resampling needs particles");
  const Comb comb(weightSums(set).first, count, offset);
  children_.resize(count);
  children_.origin = set.origin;
  const Arrays arrays{{set.x.data(), set.y.data(), set.yaw.data()},
                      {children_.x.data(), children_.y.data(), children_.yaw.data()}};
  const float* weight = set.weight.data();
  block_start_.assign(blockCount(n) + 1, 0);
  forBlocks(n, Cost::Low, [&](const Block& block) {
    block_start_[block.index + 1] = sumOfShares(comb, weight + block.first, block.count);
  });
  for (std::size_t b = 1; b < block_start_.size(); ++b) block_start_[b] += block_start_[b - 1];
  forBlocks(n, Cost::Low, [&](const Block& block) {
    copyBlock(comb, arrays, weight, block, block_start_[block.index], block_start_[block.index + 1]);
  });
  // Rounding may leave the last tooth just beyond the end.
  for (std::size_t k = comb.children(block_start_.back()); k < count; ++k) {
    for (int a = 0; a < 3; ++a) arrays.to[a][k] = k > 0 ? arrays.to[a][k - 1] : arrays.from[a][n - 1];
  }
  levelWeights(children_);
  std::swap(set, children_);
}

}  // namespace pos::filters
