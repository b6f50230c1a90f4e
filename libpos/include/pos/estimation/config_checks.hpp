#pragma once
/// The checks that every `validated(config)` is made of. Keys are as in the file, units and all.

#include <cmath>
#include <string>

#include "pos/core/error.hpp"

namespace pos::estimation {

inline std::string prefixed(const std::string& table, const std::string& key) {
  return table.empty() || key.empty() ? table + key : table + "." + key;
}

[[noreturn]] inline void refuse(const std::string& what, const std::string& key, const std::string& got,
                                const std::string& expected) {
  throw ConfigError(Complaint{.what = what, .key = key, .got = got, .expected = expected});
}

inline void requirePositive(double value, const std::string& key) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    refuse("the value has to be positive", key, std::to_string(value), "> 0");
  }
}

inline void requireNotNegative(double value, const std::string& key) {
  if (!(value >= 0.0) || !std::isfinite(value)) {
    refuse("the value must not be negative", key, std::to_string(value), ">= 0");
  }
}

inline void requireShare(double value, const std::string& key) {
  if (!(value >= 0.0 && value <= 1.0)) {
    refuse("the value has to be a share", key, std::to_string(value), "0 to 1");
  }
}

inline void requireFinite(double value, const std::string& key) {
  if (!std::isfinite(value)) refuse("the value is no number", key, std::to_string(value), "a finite number");
}

/// Runs `validated` on a struct inside another one, so that a complaint names the whole key.
template <class Inner>
void requireValid(const Inner& inner, const std::string& table) {
  try {
    (void)validated(inner);
  } catch (const ConfigError& error) {
    Complaint complaint = error.complaint();
    complaint.key = prefixed(table, complaint.key);
    throw ConfigError(complaint);
  }
}

}  // namespace pos::estimation
