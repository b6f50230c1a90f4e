#pragma once
/// How this module refuses a configuration.

#include <cmath>
#include <string>

#include "pos/core/error.hpp"

namespace pos::sim {

[[noreturn]] inline void refuse(const std::string& what, const std::string& key, const std::string& got,
                                const std::string& expected, const std::string& suggestion = {}) {
  throw ConfigError(
      Complaint{.what = what, .key = key, .got = got, .expected = expected, .suggestion = suggestion});
}

inline void requirePositive(double value, const std::string& key) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    refuse("the value has to be positive", key, std::to_string(value), "> 0");
  }
}

inline void requireNotNegative(double value, const std::string& key) {
  if (!(value >= 0.0) || !std::isfinite(value)) {
    refuse("the value may not be negative", key, std::to_string(value), ">= 0");
  }
}

inline void requireFinite(double value, const std::string& key) {
  if (!std::isfinite(value)) refuse("the value is no number", key, std::to_string(value), "a finite number");
}

inline void requireShare(double value, const std::string& key) {
  if (!(value >= 0.0 && value <= 1.0)) {
    refuse("the value is no share", key, std::to_string(value), "0 to 1");
  }
}

}  // namespace pos::sim
