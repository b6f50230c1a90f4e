#pragma once
/// Looks at the lengths inside the next object before MRPT does. MRPT sizes its arrays with whatever count it
/// reads, so one flipped bit in a count would ask for gigabytes. Private to io.

#include <optional>
#include <string>

#include "byte_source.hpp"

namespace pos::io {

/// Why the next object cannot be whole, or nothing when it may be. Consumes nothing. Classes whose layout is
/// not known here (images, 3-D scans) pass unchecked.
std::optional<std::string> implausible(ByteSource& source);

}  // namespace pos::io
