#include "object_guard.hpp"

namespace pos::io {

std::optional<std::string> implausible(ByteSource&) {
  return std::nullopt;
}

}  // namespace pos::io
