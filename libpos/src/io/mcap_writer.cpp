#include "pos/io/mcap_writer.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "pos/core/error.hpp"

namespace pos::io {
namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr std::size_t kChunk = std::size_t{1} << 20U;  // bytes before packing
constexpr int kLevel = 3;                              // of zstd

enum Opcode : std::uint8_t {
  kHeader = 1,
  kFooter,
  kSchema,
  kChannel,
  kMessage,
  kChunkRecord,
  kMessageIndex,
  kChunkIndex,
  kAttachment,
  kAttachmentIndex,
  kStatistics,
  kSummaryOffset = 14,
  kDataEnd,
};

/// Little-endian fields without padding.
class Fields {
 public:
  template <class T>
  requires std::is_integral_v<T> Fields& operator<<(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
    return *this;
  }
  Fields& operator<<(const std::string& text) {
    *this << static_cast<std::uint32_t>(text.size());
    bytes += text;
    return *this;
  }
  /// A map of numbers: its length in bytes, then the pairs.
  template <class Value>
  Fields& operator<<(const std::map<std::uint16_t, Value>& pairs) {
    *this << static_cast<std::uint32_t>(pairs.size() * (sizeof(std::uint16_t) + sizeof(Value)));
    for (const auto& [key, value] : pairs) *this << key << value;
    return *this;
  }

  std::string bytes;
};

std::string record(std::uint8_t opcode, const std::string& content) {
  return (Fields() << opcode << static_cast<std::uint64_t>(content.size())).bytes + content;
}

std::uint32_t crcOf(const std::string& bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

std::string packed(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kLevel);
  ensure(ZSTD_isError(size) == 0, "zstd has no memory left");
  out.resize(size);
  return out;
}

std::uint64_t nanoseconds(Stamp stamp) {
  return static_cast<std::uint64_t>(stamp.time_since_epoch().count());
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& path) : path_(path), file_(path, std::ios::binary) {
  if (!file_)
    throw DataError(Complaint{.what = "the file cannot be written", .place = {.file = path.string()}});
  put(std::string(kMagic));
  putRecord(kHeader, (Fields() << std::string("ros2") << std::string("pos")).bytes);
}

void McapWriter::put(const std::string& bytes) {
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file_) throw DataError(Complaint{.what = "the disk takes no more", .place = {.file = path_.string()}});
  position_ += bytes.size();
  crc_ = crcOf(bytes, crc_);
}

void McapWriter::putRecord(std::uint8_t opcode, const std::string& content) {
  put(record(opcode, content));
}

std::uint16_t McapWriter::addChannel(const std::string& topic, const RosType& type,
                                     const std::map<std::string, std::string>& metadata) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  const auto [schema, fresh] =
      schema_ids_.emplace(type.name, static_cast<std::uint16_t>(schema_ids_.size() + 1));
  if (fresh) {
    schemas_.push_back(
        (Fields() << schema->second << type.name << std::string("ros2msg") << type.definition).bytes);
    chunk_ += record(kSchema, schemas_.back());
  }
  Fields pairs;
  for (const auto& [key, value] : metadata) pairs << key << value;
  channels_.push_back((Fields() << id << schema->second << topic << std::string("cdr") << pairs.bytes).bytes);
  chunk_ += record(kChannel, channels_.back());
  return id;
}

void McapWriter::write(std::uint16_t channel, Stamp stamp, const std::string& cdr) {
  const std::uint64_t ns = nanoseconds(stamp);
  const auto sequence = static_cast<std::uint32_t>(++counts_[channel]);
  entries_[channel].push_back({ns, chunk_.size()});
  chunk_ += record(kMessage, (Fields() << channel << sequence << ns << ns).bytes + cdr);
  if (chunk_.size() >= kChunk) closeChunk();
}

void McapWriter::closeChunk() {
  if (chunk_.empty()) return;
  ChunkEntry chunk;
  chunk.first = entries_.empty() ? 0 : std::numeric_limits<std::uint64_t>::max();
  for (const auto& [channel, entries] : entries_) {
    for (const Entry& entry : entries) {
      chunk.first = std::min(chunk.first, entry.stamp);
      chunk.last = std::max(chunk.last, entry.stamp);
    }
  }
  const std::string records = packed(chunk_);
  chunk.start = position_;
  chunk.plain = chunk_.size();
  chunk.packed = records.size();
  putRecord(kChunkRecord, (Fields() << chunk.first << chunk.last << chunk.plain << crcOf(chunk_)
                                    << std::string("zstd") << chunk.packed)
                                  .bytes +
                              records);
  chunk.length = position_ - chunk.start;
  for (const auto& [channel, entries] : entries_) {
    chunk.indexes[channel] = position_;
    Fields index;
    index << channel << static_cast<std::uint32_t>(entries.size() * sizeof(Entry));
    for (const Entry& entry : entries) index << entry.stamp << entry.offset;
    putRecord(kMessageIndex, index.bytes);
  }
  chunk.indexes_length = position_ - chunk.start - chunk.length;
  chunks_.push_back(chunk);
  chunk_.clear();
  entries_.clear();
}

void McapWriter::attach(const std::string& name, const std::string& media_type, const std::string& bytes,
                        Stamp stamp) {
  const std::uint64_t ns = nanoseconds(stamp);
  const std::uint64_t start = position_;
  const auto size = static_cast<std::uint64_t>(bytes.size());
  std::string content = (Fields() << ns << ns << name << media_type << size).bytes + bytes;
  content += (Fields() << crcOf(content)).bytes;
  putRecord(kAttachment, content);
  attachments_.push_back(
      (Fields() << start << position_ - start << ns << ns << size << name << media_type).bytes);
}

/// Everything between the data and the footer; it will begin at `start`.
std::string McapWriter::summary(std::uint64_t start) {
  std::string all;
  std::string offsets;
  const auto group = [&](Opcode opcode, const std::vector<std::string>& contents) {
    if (contents.empty()) return;
    const std::uint64_t begin = start + all.size();
    for (const std::string& content : contents) all += record(opcode, content);
    const auto length = static_cast<std::uint64_t>(start + all.size() - begin);
    offsets += record(kSummaryOffset, (Fields() << std::uint8_t{opcode} << begin << length).bytes);
  };
  std::vector<std::string> chunk_indexes;
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t last = 0;
  for (const ChunkEntry& c : chunks_) {
    chunk_indexes.push_back((Fields() << c.first << c.last << c.start << c.length << c.indexes
                                      << c.indexes_length << std::string("zstd") << c.packed << c.plain)
                                .bytes);
    if (c.indexes.empty()) continue;
    first = std::min(first, c.first);
    last = std::max(last, c.last);
  }
  std::uint64_t messages = 0;
  for (const auto& [channel, count] : counts_) messages += count;
  if (messages == 0) first = 0;
  const std::uint32_t no_metadata = 0;
  group(kSchema, schemas_);
  group(kChannel, channels_);
  group(kStatistics, {(Fields() << messages << static_cast<std::uint16_t>(schemas_.size())
                                << static_cast<std::uint32_t>(channels_.size())
                                << static_cast<std::uint32_t>(attachments_.size()) << no_metadata
                                << static_cast<std::uint32_t>(chunks_.size()) << first << last << counts_)
                          .bytes});
  group(kChunkIndex, chunk_indexes);
  group(kAttachmentIndex, attachments_);
  const std::uint64_t offsets_start = start + all.size();
  all += offsets;
  // The checksum covers the summary and the footer up to itself.
  const std::string footer = (Fields() << start << offsets_start).bytes;
  const std::uint64_t footer_length = footer.size() + sizeof(std::uint32_t);
  const std::string head = (Fields() << std::uint8_t{kFooter} << footer_length).bytes;
  all += head + footer;
  return all + (Fields() << crcOf(all)).bytes;
}

void McapWriter::close() {
  closeChunk();
  putRecord(kDataEnd, (Fields() << crc_).bytes);
  put(summary(position_) + std::string(kMagic));
  file_.close();
  if (!file_) throw DataError(Complaint{.what = "the disk takes no more", .place = {.file = path_.string()}});
}

}  // namespace pos::io
