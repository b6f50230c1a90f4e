#include <array>
#include <fstream>
#include <system_error>
#include <utility>

#include "file_kind.hpp"
#include "log_cache_parts.hpp"
#include "pos/core/error.hpp"
#include "pos/io/sha256.hpp"

namespace pos::io {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kLargestBlock = 1U << 28U;

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
  std::array<char, kCacheMagic.size()> magic{};
  if (!file) throw DataError(Complaint{.what = "there is no such file", .place = {.file = path.string()}});
  if (!file.read(magic.data(), magic.size()) || std::string_view(magic.data(), magic.size()) != kCacheMagic)
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

bool isLogCache(const fs::path& path) {
  return beginsWith(path, kCacheMagic.substr(0, 6));  // of any version
}

}  // namespace pos::io
