#include "pos/filters/kld.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace pos::filters {
namespace {

std::uint64_t bin(float value, float per_unit) {
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value * per_unit)));
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

BinCounter::BinCounter(double bin_position, double bin_yaw)
    : bins_per_metre_(static_cast<float>(1.0 / bin_position)),
      bins_per_radian_(static_cast<float>(1.0 / bin_yaw)) {}

std::size_t BinCounter::count(const ParticleSet& set, std::span<const std::uint32_t> indices) {
  const std::size_t slots = std::bit_ceil(2 * indices.size() + 2);
  table_.assign(slots, 0);
  std::size_t occupied = 0;
  std::uint32_t previous = std::numeric_limits<std::uint32_t>::max();
  for (const std::uint32_t i : indices) {
    if (i == previous) continue;  // children of one parent follow each other
    previous = i;
    // 24 bits each for x and y, 15 for yaw; the top bit keeps the key from being 0 = free.
    const std::uint64_t key = ((bin(set.x[i], bins_per_metre_) & 0xffffffU) << 39U) |
                              ((bin(set.y[i], bins_per_metre_) & 0xffffffU) << 15U) |
                              (bin(set.yaw[i], bins_per_radian_) & 0x7fffU) | (std::uint64_t{1} << 63U);
    std::size_t slot = scrambled(key) & (slots - 1);
    while (table_[slot] != 0 && table_[slot] != key) slot = (slot + 1) & (slots - 1);
    if (table_[slot] == 0) {
      table_[slot] = key;
      ++occupied;
    }
  }
  return occupied;
}

}  // namespace pos::filters
