#pragma once
/// MRPT rawlogs as a stream of measurements, plain or gzip, observation-only or action/sensory-frame.
/// What becomes what, and what is left out: docs/formats/rawlog.md.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pos/core/measurement.hpp"
#include "pos/io/frame_stamps.hpp"

namespace pos::io {

/// How reading ended. Everything before the damage was delivered.
struct LogEnd {
  bool damaged = false;
  std::uint64_t objects = 0;  ///< whole objects read
  /// Bytes of the uncompressed stream read whole; for a plain file that is the place in the file.
  std::uint64_t byte = 0;
  std::string message;  ///< what is wrong, empty for a clean end
};

enum class LogFormat { Unknown, Observations, ActionsAndFrames, Mixed };

/// What was in the log and not delivered as a measurement, so that nothing disappears in silence.
struct LogTally {
  /// Objects with no measurement of their own, by MRPT class name (and why, where the class has one).
  std::map<std::string, std::uint64_t> skipped;
  /// Readings that are not believable, by reason.
  std::map<std::string, std::uint64_t> refused;
  /// Absolute odometry that only served as the first reference of its sensor.
  std::uint64_t references = 0;
};

/// Reads one log from front to back in constant memory. Stamps are in the order of the file.
class RawlogReader {
 public:
  /// Throws DataError for a missing or empty file and for one whose first object cannot be read.
  explicit RawlogReader(const std::string& path);
  RawlogReader(RawlogReader&&) noexcept;
  RawlogReader& operator=(RawlogReader&&) noexcept;
  ~RawlogReader();

  /// The next measurement, or nothing at the end of the readable part.
  std::optional<Measurement> next();
  /// Valid once next() returned nothing.
  const LogEnd& end() const;

  /// Where the measurement last returned comes from: the index of its action/observation pair (an action and
  /// the sensory frame after it), or of the observation in an observation-only log. Nothing for the frames
  /// before the first action, which belong to no pair.
  std::optional<std::size_t> frame() const;
  LogFormat format() const;
  const std::map<std::string, std::uint64_t>& skipped() const { return tally().skipped; }
  const std::map<std::string, std::uint64_t>& refused() const { return tally().refused; }
  const LogTally& tally() const;

 private:
  friend FrameStamps frameStamps(const std::string& path);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pos::io
