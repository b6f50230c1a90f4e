#include "pos/eval/decimation.hpp"

#include <algorithm>
#include <numeric>

namespace pos::eval {

std::vector<std::size_t> minMaxIndices(const std::vector<double>& values, std::size_t capacity) {
  std::vector<std::size_t> kept;
  if (values.size() <= std::max<std::size_t>(capacity, 4)) {
    kept.resize(values.size());
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  const std::size_t stretches = std::max<std::size_t>((std::max<std::size_t>(capacity, 4) - 2) / 2, 1);
  kept.push_back(0);
  for (std::size_t k = 0; k < stretches; ++k) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(values.size() * k / stretches);
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(values.size() * (k + 1) / stretches);
    const auto [low, high] = std::minmax_element(begin, end);
    kept.push_back(static_cast<std::size_t>(std::min(low, high) - values.begin()));
    kept.push_back(static_cast<std::size_t>(std::max(low, high) - values.begin()));
  }
  kept.push_back(values.size() - 1);
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  return kept;
}

}  // namespace pos::eval
