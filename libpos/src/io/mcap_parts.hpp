#pragma once
/// What writer and reader of MCAP files share (mcap.dev/spec). Private to io.

#include <cstdint>
#include <string_view>

namespace pos::io {

inline constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);

enum class McapRecord : std::uint8_t {
  Header = 1,
  Footer,
  Schema,
  Channel,
  Message,
  Chunk,
  MessageIndex,
  ChunkIndex,
  Attachment,
  AttachmentIndex,
  Statistics,
  SummaryOffset = 14,
  DataEnd,
};

}  // namespace pos::io
