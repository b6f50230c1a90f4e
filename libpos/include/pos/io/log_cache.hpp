#pragma once
/// A packed copy of a log, read many times faster than the log itself, for runs that are repeated. Tied to
/// its source by a checksum. Format: docs/formats/log_cache.md.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "pos/io/log_reader.hpp"

namespace pos::io {

/// The file that a copy was made of.
struct CacheSource {
  std::string name;          ///< without its folder
  std::uint64_t size = 0;    ///< bytes
  std::int64_t changed = 0;  ///< when it was last written, in ticks of the file system's clock
  std::string sha256;
};

/// Where the packed copy of a log is looked for: "<log>.cache".
std::filesystem::path cacheBeside(const std::filesystem::path& log);

/// True where the file begins as a packed copy does.
bool isLogCache(const std::filesystem::path& path);

/// What was copied, and what was not.
struct CopiedLog {
  std::uint64_t measurements = 0;
  LogEnd end;
  LogTally tally;
};
/// Reads the log once and writes its copy, which appears whole or not at all. Throws DataError when the log
/// cannot be read or the copy not be written.
CopiedLog packLog(const std::filesystem::path& log, const std::filesystem::path& copy);

/// Delivers what the reader of the source delivers, bit by bit, its end and tally included.
class LogCacheReader final : public LogReader {
 public:
  /// Throws DataError for a missing file and one that is no whole packed copy of this version.
  explicit LogCacheReader(const std::filesystem::path& path);
  LogCacheReader(LogCacheReader&&) noexcept;
  LogCacheReader& operator=(LogCacheReader&&) noexcept;
  ~LogCacheReader() override;

  /// Throws DataError where a block does not match its checksum.
  std::optional<Measurement> next() override;
  const LogEnd& end() const override;
  const LogTally& tally() const override;
  LogFormat format() const override { return LogFormat::PackedCopy; }

  const CacheSource& source() const;
  /// Whether `log` still holds what the copy was made of: the same size and time of writing, or else the same
  /// checksum.
  bool belongsTo(const std::filesystem::path& log) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pos::io
