#pragma once
/// Texts that are nearly right: a sample with a few bytes changed, removed, repeated or put in.

#include <string>
#include <vector>

#include "pos/core/random.hpp"

namespace pos::test {

inline std::size_t below(RandomStream& random, std::size_t limit) {
  return static_cast<std::size_t>(random.uniform() * static_cast<double>(limit));
}

/// `pieces` are what this kind of text is made of; they are put in as often as single bytes.
inline std::string mutated(std::string text, const std::vector<std::string>& pieces, RandomStream& random) {
  const std::size_t changes = 1 + below(random, 4);
  for (std::size_t i = 0; i < changes; ++i) {
    const std::size_t at = below(random, text.size() + 1);
    const std::size_t kind = below(random, 5);
    if (kind == 0 && at < text.size()) text[at] = static_cast<char>(random.bits());
    if (kind == 1) text.insert(at, 1, static_cast<char>(random.bits()));
    if (kind == 2) text.erase(at, 1 + below(random, 8));
    if (kind == 3) text.insert(at, pieces[below(random, pieces.size())]);
    if (kind == 4) text.insert(at, text.substr(at, below(random, 12)));
  }
  return text;
}

}  // namespace pos::test
