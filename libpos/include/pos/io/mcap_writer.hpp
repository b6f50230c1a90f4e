#pragma once
/// Writes MCAP files (mcap.dev/spec), profile `ros2`: messages in CDR with their definitions as text, in
/// chunks packed by zstd, with indexes, statistics and checksums. Viewers for ROS 2 open them without a ROS.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "pos/core/stamp.hpp"

namespace pos::io {

enum class McapRecord : std::uint8_t;  // the format's own kinds

/// A ROS 2 message type: its name ("nav_msgs/msg/Odometry") and its definition, with those of its parts
/// behind lines of equal signs.
struct RosType {
  std::string name;
  std::string definition;
};

/// One file, in constant memory but for 16 bytes a message of the chunk under way and one index entry a
/// chunk. Throws DataError when the disk takes no more. The destructor does not finish the file: call
/// close().
class McapWriter {
 public:
  explicit McapWriter(const std::filesystem::path& path);

  /// A topic; the number that `write` wants. Types of the same name are stored once. `metadata` is for
  /// readers who know its keys.
  std::uint16_t addChannel(const std::string& topic, const RosType& type,
                           const std::map<std::string, std::string>& metadata = {});
  /// One message, as the CDR bytes of the channel's type.
  void write(std::uint16_t channel, Stamp stamp, const std::string& cdr);
  /// A file inside the file.
  void attach(const std::string& name, const std::string& media_type, const std::string& bytes, Stamp stamp);
  void close();

 private:
  struct ChunkEntry {
    std::uint64_t start = 0;
    std::uint64_t length = 0;
    std::uint64_t first = 0;  ///< ns
    std::uint64_t last = 0;
    std::map<std::uint16_t, std::uint64_t> indexes;  ///< where each channel's message index begins
    std::uint64_t indexes_length = 0;
    std::uint64_t packed = 0;
    std::uint64_t plain = 0;
  };
  struct Entry {
    std::uint64_t stamp;
    std::uint64_t offset;
  };

  void put(const std::string& bytes);
  void putRecord(McapRecord opcode, const std::string& content);
  void closeChunk();
  std::string summary(std::uint64_t start);

  std::filesystem::path path_;
  std::ofstream file_;
  std::uint64_t position_ = 0;
  std::uint32_t crc_ = 0;  // of everything written
  std::map<std::string, std::uint16_t> schema_ids_;
  std::vector<std::string> schemas_;  // their records' contents
  std::vector<std::string> channels_;
  std::string chunk_;  // records of the chunk under way
  std::map<std::uint16_t, std::vector<Entry>> entries_;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::vector<ChunkEntry> chunks_;
  std::vector<std::string> attachments_;  // contents of their index records
};

}  // namespace pos::io
