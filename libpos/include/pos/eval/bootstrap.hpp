#pragma once
/// How sure a figure over runs is: percentile bootstrap (Efron and Tibshirani 1993, section 13.3).

#include <cstdint>
#include <functional>
#include <vector>

#include "pos/core/chi_square.hpp"

namespace pos::eval {

struct BootstrapOptions {
  double confidence = 0.95;
  std::uint64_t resamples = 2000;
  std::uint64_t seed = 20240676;  ///< fixed, so that the same runs always give the same interval
};

/// Two-sided interval of `statistic`, which is given the indices of the runs drawn, 0 .. count - 1 with
/// replacement, as many as there are runs. Resample r draws from stream r of the seed, so that the interval
/// depends on the runs and the options alone. For fewer than 20 runs it is somewhat too narrow: on a normal
/// figure it holds the mean in about 93 of 100 cases at 20 runs and 94 at 50.
Interval bootstrapInterval(std::size_t count,
                           const std::function<double(const std::vector<std::size_t>&)>& statistic,
                           const BootstrapOptions& options = {});

}  // namespace pos::eval
