#include "pos/eval/bootstrap.hpp"

#include <algorithm>

#include "pos/core/error.hpp"
#include "pos/core/random.hpp"
#include "pos/eval/statistics.hpp"

namespace pos::eval {

Interval bootstrapInterval(std::size_t count,
                           const std::function<double(const std::vector<std::size_t>&)>& statistic,
                           const BootstrapOptions& options) {
  ensure(count > 0 && options.resamples > 0, "a bootstrap needs runs and resamples");
  std::vector<std::size_t> drawn(count);
  std::vector<double> outcomes;
  outcomes.reserve(options.resamples);
  for (std::uint64_t r = 0; r < options.resamples; ++r) {
    RandomStream random(options.seed, r);
    std::generate(drawn.begin(), drawn.end(), [&] {
      return std::min(count - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(count)));
    });
    outcomes.push_back(statistic(drawn));
  }
  std::sort(outcomes.begin(), outcomes.end());
  const double tail = 0.5 * (1.0 - options.confidence);
  return {sortedQuantile(outcomes, tail), sortedQuantile(outcomes, 1.0 - tail)};
}

}  // namespace pos::eval
