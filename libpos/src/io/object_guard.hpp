#pragma once
/// Looks at the counts inside the next object before MRPT does. MRPT sizes its arrays with whatever count it
/// reads, so one flipped bit in a count would ask for gigabytes. Private to io.

#include <cstddef>
#include <optional>
#include <string>

#include "byte_source.hpp"

namespace pos::io {

struct ObjectOutline {
  /// Bytes the object takes; nothing when its class or version is not known here (images, 3-D scans).
  std::optional<std::size_t> length;
  /// Why the object cannot be whole.
  std::optional<std::string> damage;
};

/// Walks over the next object, nested ones included, without consuming or building anything.
ObjectOutline outlineNext(ByteSource& source);

}  // namespace pos::io
