#pragma once
/// The observations that logs hold by the million, read without MRPT's archive: it builds each object anew
/// and asks for its bytes one field at a time, which takes ten times as long. Private to io.

#include <mrpt/serialization/CSerializable.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace pos::io {

/// Reads the object that `bytes` begin with into `object`, which is used again where it is of that class and
/// nobody else holds it. Returns the bytes that it takes; 0 where they hold another class or version than
/// those known here (CObservationIMU 4, CObservationBeaconRanges 3), more ranges than a few, or end early:
/// MRPT has to read it then.
std::size_t readQuickly(std::span<const std::uint8_t> bytes, mrpt::serialization::CSerializable::Ptr& object);

/// `readQuickly` needs to see no more bytes than this.
inline constexpr std::size_t kQuickWindow = 2048;

}  // namespace pos::io
