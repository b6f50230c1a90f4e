#pragma once
/// Thins a series for drawing without losing its peaks. Statistics are always taken before.

#include <cstddef>
#include <vector>

namespace pos::eval {

/// Indices, upward, of at most max(capacity, 4) values: first, last, and the smallest and largest of every
/// one of equally long stretches. Every index when the series is short enough.
std::vector<std::size_t> minMaxIndices(const std::vector<double>& values, std::size_t capacity);

}  // namespace pos::eval
