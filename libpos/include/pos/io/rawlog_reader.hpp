#pragma once
/// MRPT rawlogs as a stream of measurements, plain or gzip, observation-only or action/sensory-frame.
/// What becomes what, and what is left out: docs/formats/rawlog.md.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pos/io/frame_stamps.hpp"
#include "pos/io/log_reader.hpp"

namespace pos::io {

/// Whether a thread of its own takes the objects out of the file while the caller works on those before. What
/// comes out is the same.
enum class ReadAhead { No, Yes };

/// Reads one rawlog from front to back in constant memory. Stamps are in the order of the file.
class RawlogReader final : public LogReader {
 public:
  /// Throws DataError for a missing or empty file and for one whose first object cannot be read.
  explicit RawlogReader(const std::string& path, ReadAhead ahead = ReadAhead::Yes);
  RawlogReader(RawlogReader&&) noexcept;
  RawlogReader& operator=(RawlogReader&&) noexcept;
  ~RawlogReader() override;

  std::optional<Measurement> next() override;
  const LogEnd& end() const override;

  /// Where the measurement last returned comes from: the index of its action/observation pair (an action and
  /// the sensory frame after it), or of the observation in an observation-only log. Nothing for the frames
  /// before the first action, which belong to no pair.
  std::optional<std::size_t> frame() const;
  LogFormat format() const override;
  const std::map<std::string, std::uint64_t>& skipped() const { return tally().skipped; }
  const std::map<std::string, std::uint64_t>& refused() const { return tally().refused; }
  const LogTally& tally() const override;

 private:
  friend FrameStamps frameStamps(const std::string& path);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pos::io
