#pragma once
/// Errors within stretches of a run: while the vehicle drives from the surface to the underground, say.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "pos/eval/errors.hpp"

namespace pos::eval {

/// Windows of the same name are taken together.
struct TimeWindow {
  std::string name;
  Stamp from;  ///< inclusive
  Stamp to;    ///< inclusive
};

/// Figures of |error|, m.
struct WindowError {
  std::size_t count = 0;  ///< 0: the others mean nothing
  double mean = 0.0;
  double rmse = 0.0;
  double max = 0.0;
};

inline constexpr std::array<std::string_view, 5> kWindowComponents{"x", "y", "z", "xy", "xyz"};

struct WindowErrors {
  std::string name;
  std::array<WindowError, kWindowComponents.size()> errors = {};  ///< in the order of kWindowComponents
};

/// One entry a name, in the order of first mention.
std::vector<WindowErrors> windowErrors(const ErrorSeries& errors, const std::vector<TimeWindow>& windows);

}  // namespace pos::eval
