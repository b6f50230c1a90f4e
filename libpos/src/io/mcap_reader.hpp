#pragma once
/// Messages of an MCAP file (mcap.dev/spec) in the order they lie in it, chunks unpacked and checked. Private
/// to io.

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "mcap_parts.hpp"
#include "pos/core/stamp.hpp"

namespace pos::io {

struct McapChannel {
  std::string topic;
  std::string encoding;         ///< of the messages: "cdr"
  std::string type;             ///< the schema's name: "sensor_msgs/msg/Imu"
  std::string schema_encoding;  ///< "ros2msg"
  std::map<std::string, std::string> metadata;
};

struct McapMessage {
  std::uint16_t id = 0;                  ///< of the channel
  const McapChannel* channel = nullptr;  ///< stays where it is
  Stamp logged = {};                     ///< when it was recorded
  std::string_view bytes;                ///< until the next message
};

class McapReader {
 public:
  /// Throws DataError for a missing file and one that does not begin as an MCAP file does.
  explicit McapReader(const std::filesystem::path& path);

  /// The next message; nothing at the end of the readable part.
  std::optional<McapMessage> next();
  /// Why reading ended early, empty for a clean end.
  const std::string& damage() const { return damage_; }
  std::uint64_t messages() const { return messages_; }
  /// Bytes of the file read whole.
  std::uint64_t position() const { return position_; }

 private:
  struct Record {
    McapRecord opcode{};
    std::string_view content;
  };

  std::optional<McapMessage> search();
  /// The next record of the chunk at hand, or of the file; nothing at the end of the data.
  std::optional<Record> record();
  std::optional<Record> fileRecord();
  /// The next `size` bytes of the file, which count for its checksum.
  void readBytes(char* target, std::uint64_t size);
  void skipBytes(std::uint64_t size);
  void endOfData(std::uint64_t length);
  void openChunk(std::string_view content);
  /// The records that can still be had from a chunk of which the file holds only the beginning, `size` bytes.
  void openCutChunk(std::uint64_t size);
  void addSchema(std::string_view content);
  void addChannel(std::string_view content);
  McapMessage message(std::string_view content);

  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
  std::string content_;                                                   // of the file's record at hand
  std::string chunk_;                                                     // unpacked
  std::string_view rest_;                                                 // of the chunk
  std::map<std::uint16_t, std::pair<std::string, std::string>> schemas_;  // name, encoding
  std::map<std::uint16_t, McapChannel> channels_;
  std::uint64_t messages_ = 0;
  std::uint32_t crc_ = 0;  // of the bytes before the record at hand
  std::string damage_;
  bool cut_ = false;  // the chunk at hand is the last, and not whole
  bool done_ = false;
};

}  // namespace pos::io
