#pragma once
/// How many particles a cloud needs: Fox, "Adapting the sample size in particle filters through
/// KLD-sampling", IJRR 22(12), 2003.

#include <cstdint>
#include <vector>

#include "pos/filters/particle_set.hpp"

namespace pos::filters {

/// Number of samples so that, with the confidence whose standard normal quantile is `z`, the Kullback-Leibler
/// distance between the sampled and the true distribution over `bins` occupied bins stays below `epsilon`
/// (Fox 2003, eq. 7, Wilson-Hilferty approximation). 1 for fewer than two bins.
double kldSampleSize(std::size_t bins, double epsilon, double z);

/// The smallest number of bins that needs at least `samples`: more bins need not be told apart by a filter
/// that can have no more samples.
std::size_t kldBins(double samples, double epsilon, double z);

/// Counts the bins of a regular [x, y, yaw] grid that particles occupy. Owns its hash table, 16 to 32 bytes
/// for each bin of the limit.
class BinCounter {
 public:
  /// Counts to `limit` and no further.
  BinCounter(double bin_position, double bin_yaw, std::size_t limit);
  /// Occupied bins, at most the limit, among the particles that would have a child if as many children were
  /// drawn systematically (filters/comb.hpp) with offset 1/2.
  std::size_t survivors(const ParticleSet& set);

 private:
  float bins_per_metre_;
  float bins_per_radian_;
  std::size_t limit_;
  std::vector<std::uint64_t> table_;  // open addressing, 0 = free
};

}  // namespace pos::filters
