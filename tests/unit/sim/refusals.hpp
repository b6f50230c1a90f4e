#pragma once
/// Which key a configuration is refused for.

#include <string>

#include "pos/core/error.hpp"

namespace pos::sim {

/// The complaint's key, or "accepted".
template <class F>
std::string refusedKey(F&& make) {
  try {
    (void)make();
  } catch (const ConfigError& error) {
    return error.complaint().key;
  }
  return "accepted";
}

}  // namespace pos::sim
