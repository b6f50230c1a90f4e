#include "pos/filters/kld.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "pos/filters/comb.hpp"

namespace pos::filters {
namespace {

std::uint64_t bin(float value, float per_unit) {
  const float scaled = value * per_unit;
  const auto whole = static_cast<std::int64_t>(scaled);  // towards zero; one less for negative fractions
  return static_cast<std::uint64_t>(whole - (static_cast<float>(whole) > scaled ? 1 : 0));
}

std::uint64_t scrambled(std::uint64_t key) {  // finaliser of SplitMix64
  key = (key ^ (key >> 30U)) * 0xbf58476d1ce4e5b9U;
  key = (key ^ (key >> 27U)) * 0x94d049bb133111ebU;
  return key ^ (key >> 31U);
}

}  // namespace

double kldSampleSize(std::size_t bins, double epsilon, double z) {
  if (bins < 2) return 1.0;
  const double k = static_cast<double>(bins - 1);
  const double a = 2.0 / (9.0 * k);
  const double root = 1.0 - a + std::sqrt(a) * z;
  return k / (2.0 * epsilon) * root * root * root;
}

std::size_t kldBins(double samples, double epsilon, double z) {
  std::size_t enough = 2;
  while (kldSampleSize(enough, epsilon, z) < samples) enough *= 2;
  std::size_t too_few = 1;
  while (enough - too_few > 1) {
    const std::size_t middle = too_few + (enough - too_few) / 2;
    (kldSampleSize(middle, epsilon, z) < samples ? too_few : enough) = middle;
  }
  return enough;
}

BinCounter::BinCounter(double bin_position, double bin_yaw, std::size_t limit)
    : bins_per_metre_(static_cast<float>(1.0 / bin_position)),
      bins_per_radian_(static_cast<float>(1.0 / bin_yaw)),
      limit_(limit),
      table_(std::bit_ceil(2 * limit + 2)) {}

std::size_t BinCounter::survivors(const ParticleSet& set) {
  const Comb comb(weightSums(set).first, set.size(), 0.5);
  std::fill(table_.begin(), table_.end(), 0);
  const std::size_t last_slot = table_.size() - 1;
  std::size_t occupied = 0;
  std::uint64_t cumulative = 0;
  std::size_t children = 0;
  for (std::size_t i = 0; i < set.size() && occupied < limit_; ++i) {
    cumulative += comb.share(set.weight[i]);
    const std::size_t before = children;
    children = comb.children(cumulative);
    if (children == before) continue;
    // 24 bits each for x and y, 15 for yaw; the top bit keeps the key from being 0 = free.
    const std::uint64_t key = ((bin(set.x[i], bins_per_metre_) & 0xffffffU) << 39U) |
                              ((bin(set.y[i], bins_per_metre_) & 0xffffffU) << 15U) |
                              (bin(set.yaw[i], bins_per_radian_) & 0x7fffU) | (std::uint64_t{1} << 63U);
    std::size_t slot = scrambled(key) & last_slot;
    while (table_[slot] != 0 && table_[slot] != key) slot = (slot + 1) & last_slot;
    if (table_[slot] == 0) {
      table_[slot] = key;
      ++occupied;
    }
  }
  return occupied;
}

}  // namespace pos::filters
