#pragma once
/// Sums and maxima taken in eight lanes side by side: the order is fixed by this code, not by the compiler,
/// so that the result has the same bits whatever the width of the processor's vectors.

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

namespace pos::filters {

/// Sum of a short block (a few hundred values): float within a lane, double across.
inline double laneSum(std::span<const float> values) {
  std::array<float, 8> lane{};
  std::size_t i = 0;
  for (; i + 8 <= values.size(); i += 8) {
    for (std::size_t j = 0; j < 8; ++j) lane[j] += values[i + j];
  }
  double sum = 0.0;
  for (; i < values.size(); ++i) sum += static_cast<double>(values[i]);
  for (const float part : lane) sum += static_cast<double>(part);
  return sum;
}

/// Largest value; -infinity when there is none.
inline float laneMax(std::span<const float> values) {
  std::array<float, 8> lane;
  lane.fill(-std::numeric_limits<float>::infinity());
  std::size_t i = 0;
  for (; i + 8 <= values.size(); i += 8) {
    for (std::size_t j = 0; j < 8; ++j) lane[j] = std::max(lane[j], values[i + j]);
  }
  float top = *std::max_element(lane.begin(), lane.end());
  for (; i < values.size(); ++i) top = std::max(top, values[i]);
  return top;
}

}  // namespace pos::filters
