#pragma once
/// How many particles a cloud needs: Fox, "Adapting the sample size in particle filters through
/// KLD-sampling", IJRR 22(12), 2003.

#include <cstdint>
#include <span>
#include <vector>

#include "pos/filters/particle_set.hpp"

namespace pos::filters {

/// Number of samples so that, with the confidence whose standard normal quantile is `z`, the Kullback-Leibler
/// distance between the sampled and the true distribution over `bins` occupied bins stays below `epsilon`
/// (Fox 2003, eq. 7, Wilson-Hilferty approximation). 1 for fewer than two bins.
double kldSampleSize(std::size_t bins, double epsilon, double z);

/// Counts the bins of a regular [x, y, yaw] grid that particles occupy. Owns its hash table.
class BinCounter {
 public:
  BinCounter(double bin_position, double bin_yaw);
  /// Occupied bins among the particles with these indices (repeats count once).
  std::size_t count(const ParticleSet& set, std::span<const std::uint32_t> indices);

 private:
  float bins_per_metre_;
  float bins_per_radian_;
  std::vector<std::uint64_t> table_;  // open addressing, 0 = free
};

}  // namespace pos::filters
