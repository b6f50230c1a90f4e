#pragma once
/// A recording as a stream of measurements, whatever file it lies in: an MRPT rawlog, a packed copy of one,
/// an MCAP file.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "pos/core/measurement.hpp"

namespace pos::io {

/// How reading ended. Everything before the damage was delivered.
struct LogEnd {
  bool damaged = false;
  std::uint64_t objects = 0;  ///< whole objects read
  /// Bytes of the uncompressed stream read whole; for a plain file that is the place in the file.
  std::uint64_t byte = 0;
  std::string message;  ///< what is wrong, empty for a clean end
};

/// What was in the log and not delivered as a measurement, so that nothing disappears in silence.
struct LogTally {
  /// Objects with no measurement of their own, by class or message type (and why, where the class has one).
  std::map<std::string, std::uint64_t> skipped;
  /// Readings that are not believable, by reason.
  std::map<std::string, std::uint64_t> refused;
  /// Absolute odometry that only served as the first reference of its sensor.
  std::uint64_t references = 0;
};

/// Of a rawlog how it tells its story; else the file's own kind.
enum class LogFormat { Unknown, Observations, ActionsAndFrames, Mixed, Mcap, PackedCopy };

/// Reads one log from front to back in constant memory. Stamps are in the order of the file.
class LogReader {
 public:
  virtual ~LogReader() = default;

  /// The next measurement, or nothing at the end of the readable part.
  virtual std::optional<Measurement> next() = 0;
  /// Valid once next() returned nothing.
  virtual const LogEnd& end() const = 0;
  virtual const LogTally& tally() const = 0;
  virtual LogFormat format() const = 0;

 protected:
  LogReader() = default;
  LogReader(const LogReader&) = default;
  LogReader(LogReader&&) = default;
  LogReader& operator=(const LogReader&) = default;
  LogReader& operator=(LogReader&&) = default;
};

/// A log and what its user should be told about how it is read.
struct OpenedLog {
  std::unique_ptr<LogReader> reader;
  std::string note;  ///< empty where there is nothing to say
};

/// The reader that the file's first bytes ask for. A rawlog with a packed copy beside it (log_cache.hpp) that
/// still belongs to it is read from there. Throws DataError as the readers do.
OpenedLog openLog(const std::string& path);
/// The same, packed copies beside it left alone.
std::unique_ptr<LogReader> openLogItself(const std::string& path);

}  // namespace pos::io
