#include "mcap_reader.hpp"

#include <zstd.h>

#include <algorithm>
#include <memory>
#include <tuple>

#include "packed.hpp"
#include "pos/core/error.hpp"

namespace pos::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRecordHead = 9;                       // opcode and length
constexpr std::uint64_t kLargest = std::uint64_t{1} << 28U;  // bytes of a record that is read, or of a chunk

/// The file holds what the format does not allow, or what is not read here.
using Bad = Unpackable;

std::string unpacked(std::string_view packed, std::uint64_t size) {
  if (size > kLargest) throw Bad("a chunk of an absurd size");
  const unsigned long long stated = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (stated == ZSTD_CONTENTSIZE_ERROR) throw Bad("a chunk that is not packed by zstd");
  if (stated != ZSTD_CONTENTSIZE_UNKNOWN && stated != size) throw Bad("a chunk that does not have its size");
  std::string plain(size, '\0');
  const std::size_t got = ZSTD_decompress(plain.data(), plain.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) != 0 || got != size) throw Bad("a chunk that cannot be unpacked");
  return plain;
}

/// What comes out of the beginning of packed bytes.
std::string unpackedPart(std::string_view packed) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(),
                                                                          &ZSTD_freeDStream);
  ensure(stream != nullptr, "zstd has no memory left");
  std::string plain;
  std::string block(ZSTD_DStreamOutSize(), '\0');
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  while (plain.size() < kLargest) {
    ZSTD_outBuffer out{block.data(), block.size(), 0};
    const std::size_t state = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(state) != 0) break;
    plain.append(block, 0, out.pos);
    if (state == 0 || (in.pos == in.size && out.pos < out.size)) break;
  }
  return plain;
}

}  // namespace

McapReader::McapReader(const fs::path& path) : file_(path, std::ios::binary) {
  if (!file_ || fs::is_directory(path)) {
    throw DataError(Complaint{.what = "there is no such file, or it may not be read",
                              .place = {.file = path.string()},
                              .suggestion = "check the path and its spelling"});
  }
  size_ = fs::file_size(path);
  std::array<char, kMcapMagic.size()> magic{};
  if (!file_.read(magic.data(), magic.size()) || std::string_view(magic.data(), magic.size()) != kMcapMagic) {
    throw DataError(Complaint{.what = "this is no MCAP file", .place = {.file = path.string()}});
  }
  position_ = magic.size();
  crc_ = crcOf(kMcapMagic);
}

std::optional<McapMessage> McapReader::next() {
  if (done_) return std::nullopt;
  try {
    if (auto found = search()) return found;
  } catch (const Bad& bad) {
    damage_ = cut_ ? "the file is cut short" : bad.what();
  }
  done_ = true;
  return std::nullopt;
}

std::optional<McapMessage> McapReader::search() {
  while (const auto next = record()) {
    switch (next->opcode) {
      case McapRecord::Schema:
        addSchema(next->content);
        break;
      case McapRecord::Channel:
        addChannel(next->content);
        break;
      case McapRecord::Message:
        return message(next->content);
      case McapRecord::Chunk:
        openChunk(next->content);
        break;
      default:  // indexes, attachments, metadata: nothing that is needed here
        break;
    }
  }
  return std::nullopt;
}

std::optional<McapReader::Record> McapReader::record() {
  if (rest_.empty()) return fileRecord();
  Unpacker fields(rest_);
  Record result;
  result.opcode = fields.value<McapRecord>();
  result.content = fields.bytes(fields.value<std::uint64_t>());
  rest_ = fields.rest();
  if (result.opcode == McapRecord::Chunk) throw Bad("a chunk inside a chunk");
  return result;
}

void McapReader::readBytes(char* target, std::uint64_t size) {
  if (!file_.read(target, static_cast<std::streamsize>(size))) throw Bad("the file is cut short");
  crc_ = crcOf({target, size}, crc_);
}

void McapReader::skipBytes(std::uint64_t size) {
  std::array<char, std::size_t{1} << 14U> block;
  for (; size > 0; size -= std::min<std::uint64_t>(size, block.size()))
    readBytes(block.data(), std::min<std::uint64_t>(size, block.size()));
}

/// `length` is that of the record that ends the data.
void McapReader::endOfData(std::uint64_t length) {
  const std::uint32_t crc = crc_;
  content_.resize(std::min<std::uint64_t>(length, sizeof(std::uint32_t)));
  if (!file_.read(content_.data(), static_cast<std::streamsize>(content_.size())))
    throw Bad("the file is cut short");
  const auto stated = Unpacker(content_).value<std::uint32_t>();
  if (stated != 0 && stated != crc) throw Bad("the file does not match its checksum");
}

std::optional<McapReader::Record> McapReader::fileRecord() {
  if (cut_) throw Bad("the file is cut short");
  const std::uint32_t crc_before = crc_;
  std::array<char, kRecordHead> head{};
  readBytes(head.data(), head.size());
  Unpacker fields({head.data(), head.size()});
  Record result;
  result.opcode = fields.value<McapRecord>();
  const auto length = fields.value<std::uint64_t>();
  if (const std::uint64_t left = size_ - position_ - kRecordHead; length > left) {
    if (result.opcode != McapRecord::Chunk) throw Bad("the file is cut short");
    openCutChunk(left);
    return Record{};
  }
  if (result.opcode == McapRecord::Footer) return std::nullopt;
  if (result.opcode == McapRecord::DataEnd) {
    crc_ = crc_before;
    endOfData(length);
    return std::nullopt;
  }
  const bool wanted = result.opcode >= McapRecord::Schema && result.opcode <= McapRecord::Chunk;
  if (wanted) {
    if (length > kLargest) throw Bad("a record of an absurd size");
    content_.resize(length);
    readBytes(content_.data(), length);
    result.content = content_;
  } else {
    skipBytes(length);
  }
  position_ += kRecordHead + length;
  return result;
}

void McapReader::openCutChunk(std::uint64_t size) {
  cut_ = true;
  content_.resize(std::min(size, kLargest));
  readBytes(content_.data(), content_.size());
  Unpacker fields(content_);
  fields.bytes(2 * sizeof(std::uint64_t) + sizeof(std::uint64_t) +
               sizeof(std::uint32_t));  // stamps, size, checksum
  const std::string_view compression = fields.text();
  fields.value<std::uint64_t>();  // of the records
  if (compression.empty()) chunk_ = fields.rest();
  if (compression == "zstd") chunk_ = unpackedPart(fields.rest());
  rest_ = chunk_;
}

void McapReader::openChunk(std::string_view content) {
  Unpacker fields(content);
  fields.bytes(2 * sizeof(std::uint64_t));  // its first and last stamp
  const auto size = fields.value<std::uint64_t>();
  const auto crc = fields.value<std::uint32_t>();
  const std::string_view compression = fields.text();
  const std::string_view records = fields.bytes(fields.value<std::uint64_t>());
  if (compression.empty()) {
    chunk_ = records;
  } else if (compression == "zstd") {
    chunk_ = unpacked(records, size);
  } else {
    throw Bad("a chunk is packed by " + std::string(compression.substr(0, 20)) +
              ", which is not read here (mcap compress --compression zstd makes a file that is)");
  }
  if (crc != 0 && crcOf(chunk_) != crc) throw Bad("a chunk does not match its checksum");
  rest_ = chunk_;
}

void McapReader::addSchema(std::string_view content) {
  Unpacker fields(content);
  const auto id = fields.value<std::uint16_t>();
  const std::string_view name = fields.text();
  schemas_[id] = {std::string(name), std::string(fields.text())};
}

void McapReader::addChannel(std::string_view content) {
  Unpacker fields(content);
  const auto id = fields.value<std::uint16_t>();
  if (channels_.count(id) != 0) return;  // told again, which is allowed
  McapChannel channel;
  const auto schema = schemas_.find(fields.value<std::uint16_t>());
  if (schema != schemas_.end()) std::tie(channel.type, channel.schema_encoding) = schema->second;
  channel.topic = fields.text();
  channel.encoding = fields.text();
  Unpacker pairs(fields.text());
  while (!pairs.rest().empty()) {
    const std::string key(pairs.text());
    channel.metadata[key] = pairs.text();
  }
  channels_.emplace(id, std::move(channel));
}

McapMessage McapReader::message(std::string_view content) {
  Unpacker fields(content);
  McapMessage result;
  result.id = fields.value<std::uint16_t>();
  const auto channel = channels_.find(result.id);
  if (channel == channels_.end()) throw Bad("a message of a channel that was not told");
  result.channel = &channel->second;
  fields.value<std::uint32_t>();  // its running number
  result.logged = Stamp{Duration{static_cast<Duration::rep>(fields.value<std::uint64_t>())}};
  fields.value<std::uint64_t>();  // when it was published
  result.bytes = fields.rest();
  ++messages_;
  return result;
}

}  // namespace pos::io
