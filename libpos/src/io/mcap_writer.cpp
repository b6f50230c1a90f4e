#include "pos/io/mcap_writer.hpp"

#include <zstd.h>

#include <algorithm>
#include <limits>

#include "mcap_parts.hpp"
#include "packed.hpp"
#include "pos/core/error.hpp"

namespace pos::io {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 20U;  // bytes before packing
constexpr int kLevel = 3;                              // of zstd

/// Keys and values one behind the other; as a field, with its length in bytes before it, this is the format's
/// map.
template <class Key, class Value>
std::string pairsOf(const std::map<Key, Value>& map) {
  Packer packer;
  for (const auto& [key, value] : map) packer(key, value);
  return std::move(packer.bytes);
}

std::string record(McapRecord opcode, const std::string& content) {
  return packedBytes(opcode, static_cast<std::uint64_t>(content.size())) + content;
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
  put(std::string(kMcapMagic));
  putRecord(McapRecord::Header, packedBytes(std::string("ros2"), std::string("pos")));
}

void McapWriter::put(const std::string& bytes) {
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file_) throw DataError(Complaint{.what = "the disk takes no more", .place = {.file = path_.string()}});
  position_ += bytes.size();
  crc_ = crcOf(bytes, crc_);
}

void McapWriter::putRecord(McapRecord opcode, const std::string& content) {
  put(record(opcode, content));
}

std::uint16_t McapWriter::addChannel(const std::string& topic, const RosType& type,
                                     const std::map<std::string, std::string>& metadata) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  const auto [schema, fresh] =
      schema_ids_.emplace(type.name, static_cast<std::uint16_t>(schema_ids_.size() + 1));
  if (fresh) {
    schemas_.push_back(packedBytes(schema->second, type.name, std::string("ros2msg"), type.definition));
    chunk_ += record(McapRecord::Schema, schemas_.back());
  }
  channels_.push_back(packedBytes(id, schema->second, topic, std::string("cdr"), pairsOf(metadata)));
  chunk_ += record(McapRecord::Channel, channels_.back());
  return id;
}

void McapWriter::write(std::uint16_t channel, Stamp stamp, const std::string& cdr) {
  const std::uint64_t ns = nanoseconds(stamp);
  const auto sequence = static_cast<std::uint32_t>(++counts_[channel]);
  entries_[channel].push_back({ns, chunk_.size()});
  chunk_ += record(McapRecord::Message, packedBytes(channel, sequence, ns, ns) + cdr);
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
  putRecord(McapRecord::Chunk, packedBytes(chunk.first, chunk.last, chunk.plain, crcOf(chunk_),
                                           std::string("zstd"), chunk.packed) +
                                   records);
  chunk.length = position_ - chunk.start;
  for (const auto& [channel, entries] : entries_) {
    chunk.indexes[channel] = position_;
    Packer index;
    for (const Entry& entry : entries) index(entry.stamp, entry.offset);
    putRecord(McapRecord::MessageIndex, packedBytes(channel, index.bytes));
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
  std::string content = packedBytes(ns, ns, name, media_type, size) + bytes;
  content += packedBytes(crcOf(content));
  putRecord(McapRecord::Attachment, content);
  attachments_.push_back(packedBytes(start, position_ - start, ns, ns, size, name, media_type));
}

/// Everything between the data and the footer; it will begin at `start`.
std::string McapWriter::summary(std::uint64_t start) {
  std::string all;
  std::string offsets;
  const auto group = [&](McapRecord opcode, const std::vector<std::string>& contents) {
    if (contents.empty()) return;
    const std::uint64_t begin = start + all.size();
    for (const std::string& content : contents) all += record(opcode, content);
    const auto length = static_cast<std::uint64_t>(start + all.size() - begin);
    offsets += record(McapRecord::SummaryOffset, packedBytes(opcode, begin, length));
  };
  std::vector<std::string> chunk_indexes;
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t last = 0;
  for (const ChunkEntry& c : chunks_) {
    chunk_indexes.push_back(packedBytes(c.first, c.last, c.start, c.length, pairsOf(c.indexes),
                                        c.indexes_length, std::string("zstd"), c.packed, c.plain));
    if (c.indexes.empty()) continue;
    first = std::min(first, c.first);
    last = std::max(last, c.last);
  }
  std::uint64_t messages = 0;
  for (const auto& [channel, count] : counts_) messages += count;
  if (messages == 0) first = 0;
  const std::uint32_t no_metadata = 0;
  group(McapRecord::Schema, schemas_);
  group(McapRecord::Channel, channels_);
  group(McapRecord::Statistics,
        {packedBytes(messages, static_cast<std::uint16_t>(schemas_.size()),
                     static_cast<std::uint32_t>(channels_.size()),
                     static_cast<std::uint32_t>(attachments_.size()), no_metadata,
                     static_cast<std::uint32_t>(chunks_.size()), first, last, pairsOf(counts_))});
  group(McapRecord::ChunkIndex, chunk_indexes);
  group(McapRecord::AttachmentIndex, attachments_);
  const std::uint64_t offsets_start = start + all.size();
  all += offsets;
  // The checksum covers the summary and the footer up to itself.
  const std::string footer = packedBytes(start, offsets_start);
  const std::uint64_t footer_length = footer.size() + sizeof(std::uint32_t);
  const std::string head = packedBytes(McapRecord::Footer, footer_length);
  all += head + footer;
  return all + packedBytes(crcOf(all));
}

void McapWriter::close() {
  closeChunk();
  putRecord(McapRecord::DataEnd, packedBytes(crc_));
  put(summary(position_) + std::string(kMcapMagic));
  file_.close();
  if (!file_) throw DataError(Complaint{.what = "the disk takes no more", .place = {.file = path_.string()}});
}

}  // namespace pos::io
