#pragma once
/// A number in names and lines of text. Private to eval.

#include <array>
#include <cstdio>
#include <string>

namespace pos::eval {

/// Six digits at most, no zeros at the end.
inline std::string compact(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

}  // namespace pos::eval
