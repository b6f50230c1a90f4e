#include "pos/io/log_cache.hpp"

#include <zlib.h>

#include <array>
#include <fstream>
#include <limits>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "packed.hpp"
#include "pos/core/error.hpp"
#include "pos/io/sha256.hpp"

namespace pos::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic("POSLOG\x01\n", 8);  // with the version
constexpr std::size_t kBlock = std::size_t{1} << 17U;  // bytes of records in one block
constexpr std::uint32_t kLargestBlock = 1U << 28U;
constexpr std::size_t kMostLabels = 65535;

/// Blocks: type, length, CRC-32 of the content, content.
enum class BlockType : std::uint8_t { Head = 1, Records, End };
constexpr std::size_t kBlockHead = 9;
/// A record begins with the reading's index; this one gives the next label its number instead.
constexpr std::uint8_t kNewLabel = 255;

std::uint32_t crcOf(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

CacheSource sourceAt(const fs::path& log, const std::string& sha256) {
  return {.name = log.filename().string(),
          .size = fs::file_size(log),
          .changed = static_cast<std::int64_t>(fs::last_write_time(log).time_since_epoch().count()),
          .sha256 = sha256};
}

// ---------------------------------------------------------------- writing

class Writer {
 public:
  Writer(fs::path path, const CacheSource& source) : path_(std::move(path)), file_(path_, std::ios::binary) {
    if (!file_) {
      throw DataError(Complaint{.what = "the packed copy cannot be written",
                                .place = {.file = path_.string()},
                                .suggestion = "check that the folder exists and may be written to"});
    }
    file_.write(kMagic.data(), kMagic.size());
    Packer head;
    head(source.name, source.size, source.changed, source.sha256);
    put(BlockType::Head, head.bytes);
  }

  void write(const Measurement& measurement) {
    const std::uint16_t label = labelOf(measurement.sensor);
    records_(static_cast<std::uint8_t>(measurement.reading.index()), label, measurement.stamp);
    std::visit([this](const auto& reading) { fields(records_, reading); }, measurement.reading);
    if (records_.bytes.size() >= kBlock) flush();
  }

  void close(const LogEnd& end, const LogTally& tally) {
    flush();
    Packer last;
    last(end.damaged, end.objects, end.byte, end.message, tally.references);
    for (const auto* counts : {&tally.skipped, &tally.refused}) {
      last(static_cast<std::uint32_t>(counts->size()));
      for (const auto& [what, count] : *counts) last(what, count);
    }
    put(BlockType::End, last.bytes);
    file_.close();
    requireGood();
  }

 private:
  std::uint16_t labelOf(const std::string& label) {
    const auto [found, fresh] = labels_.try_emplace(label, static_cast<std::uint16_t>(labels_.size()));
    if (fresh && labels_.size() > kMostLabels) {
      throw DataError(
          Complaint{.what = "the log has too many sensors to be packed", .place = {.file = path_.string()}});
    }
    if (fresh) records_(kNewLabel, label);
    return found->second;
  }
  void flush() {
    if (!records_.bytes.empty()) put(BlockType::Records, records_.bytes);
    records_.bytes.clear();
  }
  void put(BlockType type, const std::string& content) {
    Packer head;
    head(type, static_cast<std::uint32_t>(content.size()), crcOf(content));
    file_.write(head.bytes.data(), static_cast<std::streamsize>(head.bytes.size()));
    file_.write(content.data(), static_cast<std::streamsize>(content.size()));
    requireGood();
  }
  void requireGood() {
    if (!file_)
      throw DataError(Complaint{.what = "the disk takes no more", .place = {.file = path_.string()}});
  }

  fs::path path_;
  std::ofstream file_;
  Packer records_;
  std::unordered_map<std::string, std::uint16_t> labels_;
};

PackedLog packed(LogReader& reader, const fs::path& path, const CacheSource& source) {
  Writer writer(path, source);
  std::uint64_t count = 0;
  for (; auto measurement = reader.next(); ++count) writer.write(*measurement);
  writer.close(reader.end(), reader.tally());
  return {count, reader.end(), reader.tally()};
}

// ---------------------------------------------------------------- reading

template <std::size_t I = 0>
void emplaceReading(std::size_t index, Reading& reading) {
  if constexpr (I < std::variant_size_v<Reading>) {
    if (index == I) {
      reading.emplace<I>();
    } else {
      emplaceReading<I + 1>(index, reading);
    }
  } else {
    throw Unpackable("a reading of no known kind");
  }
}

void checkKinds(const Reading& reading) {
  const auto* imu = std::get_if<ImuSample>(&reading);
  const auto* fix = std::get_if<GnssFix>(&reading);
  if ((imu != nullptr && imu->kind > ImuSample::Kind::Increments) ||
      (fix != nullptr && fix->quality > GnssFix::Quality::RtkFixed)) {
    throw Unpackable("a kind that is none");
  }
}

}  // namespace

struct LogCacheReader::Impl {
  explicit Impl(const fs::path& file_path) : path(file_path), file(file_path, std::ios::binary) {}

  [[noreturn]] void refuse(const std::string& why) const {
    throw DataError(Complaint{.what = "the packed copy of a log is damaged",
                              .place = {.file = path.string()},
                              .got = why,
                              .suggestion = "delete it; pos convert log makes it again from the log"});
  }
  /// The next block into `block`.
  BlockType readBlock();
  void readHead();
  void readEnd();
  void readLabel();
  /// Goes to the next block where this one is used up; false at the end of the log.
  bool moreRecords();
  std::optional<Measurement> next();

  fs::path path;
  std::ifstream file;
  std::string block;
  Unpacker records;
  bool done = false;
  CacheSource source;
  LogEnd end;
  LogTally tally;
  std::vector<std::string> labels;
};

BlockType LogCacheReader::Impl::readBlock() {
  std::array<char, kBlockHead> head{};
  if (!file.read(head.data(), head.size())) refuse("it is cut short");
  BlockType type{};
  std::uint32_t size = 0;
  std::uint32_t crc = 0;
  Unpacker fields_of_head({head.data(), head.size()});
  fields_of_head(type, size, crc);
  if (size > kLargestBlock) refuse("a block of an absurd size");
  block.resize(size);
  if (!file.read(block.data(), static_cast<std::streamsize>(size))) refuse("it is cut short");
  if (crcOf(block) != crc) refuse("a block does not match its checksum");
  return type;
}

void LogCacheReader::Impl::readHead() {
  std::array<char, kMagic.size()> magic{};
  if (!file) throw DataError(Complaint{.what = "there is no such file", .place = {.file = path.string()}});
  if (!file.read(magic.data(), magic.size()) || std::string_view(magic.data(), magic.size()) != kMagic)
    refuse("its head is that of another version or file");
  if (readBlock() != BlockType::Head) refuse("it does not begin with its head");
  Unpacker fields_of_head(block);
  fields_of_head(source.name, source.size, source.changed, source.sha256);
}

void LogCacheReader::Impl::readEnd() {
  Unpacker last(block);
  last(end.damaged, end.objects, end.byte, end.message, tally.references);
  for (auto* counts : {&tally.skipped, &tally.refused}) {
    std::uint32_t entries = 0;
    last(entries);
    for (std::uint32_t i = 0; i < entries; ++i) {
      std::string what;
      last(what);
      last((*counts)[what]);
    }
  }
  if (!last.atEnd() || file.peek() != std::ifstream::traits_type::eof())
    refuse("more follows behind its end");
}

bool LogCacheReader::Impl::moreRecords() {
  while (records.atEnd()) {
    if (done) return false;
    switch (readBlock()) {
      case BlockType::Records:
        records = Unpacker(block);
        break;
      case BlockType::End:
        done = true;
        readEnd();
        return false;
      default:
        refuse("a block of no known type");
    }
  }
  return true;
}

void LogCacheReader::Impl::readLabel() {
  std::string label;
  records(label);
  labels.push_back(std::move(label));
}

std::optional<Measurement> LogCacheReader::Impl::next() {
  while (moreRecords()) {
    std::uint8_t kind = 0;
    records(kind);
    if (kind == kNewLabel) {
      readLabel();
      continue;
    }
    std::optional<Measurement> measurement(std::in_place);
    std::uint16_t label = 0;
    records(label, measurement->stamp);
    if (label >= labels.size()) throw Unpackable("a sensor that was not named");
    measurement->sensor = labels[label];
    emplaceReading(kind, measurement->reading);
    std::visit([this](auto& reading) { fields(records, reading); }, measurement->reading);
    checkKinds(measurement->reading);
    return measurement;
  }
  return std::nullopt;
}

LogCacheReader::LogCacheReader(const fs::path& path) : impl_(std::make_unique<Impl>(path)) {
  try {
    impl_->readHead();
  } catch (const Unpackable& error) {
    impl_->refuse(error.what());
  }
}

LogCacheReader::LogCacheReader(LogCacheReader&&) noexcept = default;
LogCacheReader& LogCacheReader::operator=(LogCacheReader&&) noexcept = default;
LogCacheReader::~LogCacheReader() = default;

std::optional<Measurement> LogCacheReader::next() {
  try {
    return impl_->next();
  } catch (const Unpackable& error) {
    impl_->refuse(error.what());
  }
}

const LogEnd& LogCacheReader::end() const {
  return impl_->end;
}

const LogTally& LogCacheReader::tally() const {
  return impl_->tally;
}

const CacheSource& LogCacheReader::source() const {
  return impl_->source;
}

bool LogCacheReader::belongsTo(const fs::path& log) const {
  std::error_code error;
  if (fs::file_size(log, error) != impl_->source.size || error) return false;
  const CacheSource now = sourceAt(log, {});
  return now.changed == impl_->source.changed || sha256OfFile(log) == impl_->source.sha256;
}

fs::path cacheBeside(const fs::path& log) {
  fs::path beside = log;
  beside += ".cache";
  return beside;
}

bool isLogCache(const fs::path& path) {
  std::array<char, kMagic.size()> magic{};
  std::ifstream file(path, std::ios::binary);
  constexpr std::string_view kAnyVersion = kMagic.substr(0, 6);
  return file.read(magic.data(), magic.size()) &&
         std::string_view(magic.data(), kAnyVersion.size()) == kAnyVersion;
}

PackedLog packLog(const fs::path& log, const fs::path& copy) {
  if (isLogCache(log)) {
    throw DataError(Complaint{.what = "this is a packed copy already",
                              .place = {.file = log.string()},
                              .suggestion = "name the log that it was made of"});
  }
  const std::unique_ptr<LogReader> reader = openLogItself(log.string());
  fs::path part = copy;
  part += ".part";
  try {
    PackedLog result = packed(*reader, part, sourceAt(log, sha256OfFile(log)));
    fs::rename(part, copy);
    return result;
  } catch (...) {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw;
  }
}

}  // namespace pos::io
