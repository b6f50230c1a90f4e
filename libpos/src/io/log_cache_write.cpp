#include <fstream>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "log_cache_parts.hpp"
#include "pos/core/error.hpp"
#include "pos/io/sha256.hpp"

namespace pos::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlock = std::size_t{1} << 17U;  // bytes of records in one block
constexpr std::size_t kMostLabels = 65535;

class Writer {
 public:
  Writer(fs::path path, const CacheSource& source) : path_(std::move(path)), file_(path_, std::ios::binary) {
    if (!file_) {
      throw DataError(Complaint{.what = "the packed copy cannot be written",
                                .place = {.file = path_.string()},
                                .suggestion = "check that the folder exists and may be written to"});
    }
    file_.write(kCacheMagic.data(), kCacheMagic.size());
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

CopiedLog packed(LogReader& reader, const fs::path& path, const CacheSource& source) {
  Writer writer(path, source);
  std::uint64_t count = 0;
  for (; auto measurement = reader.next(); ++count) writer.write(*measurement);
  writer.close(reader.end(), reader.tally());
  return {count, reader.end(), reader.tally()};
}

}  // namespace

CacheSource sourceAt(const std::filesystem::path& log, const std::string& sha256) {
  return {.name = log.filename().string(),
          .size = fs::file_size(log),
          .changed = static_cast<std::int64_t>(fs::last_write_time(log).time_since_epoch().count()),
          .sha256 = sha256};
}

fs::path cacheBeside(const fs::path& log) {
  fs::path beside = log;
  beside += ".cache";
  return beside;
}

CopiedLog packLog(const fs::path& log, const fs::path& copy) {
  if (isLogCache(log)) {
    throw DataError(Complaint{.what = "this is a packed copy already",
                              .place = {.file = log.string()},
                              .suggestion = "name the log that it was made of"});
  }
  const std::unique_ptr<LogReader> reader = openLogItself(log.string());
  fs::path part = copy;
  part += ".part";
  try {
    CopiedLog result = packed(*reader, part, sourceAt(log, sha256OfFile(log)));
    fs::rename(part, copy);
    return result;
  } catch (...) {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw;
  }
}

}  // namespace pos::io
