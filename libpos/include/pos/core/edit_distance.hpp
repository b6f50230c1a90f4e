#pragma once
/// How far two words are apart, for "did you mean".

#include <cstddef>
#include <string_view>

namespace pos {

/// Edits that turn a into b: one letter dropped, added or changed, or two neighbours swapped (Damerau 1964,
/// optimal string alignment). Letters are compared as they are. O(|a| |b|).
std::size_t editDistance(std::string_view a, std::string_view b);

}  // namespace pos
