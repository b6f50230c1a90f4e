#pragma once
/// Measurements into an observation-only MRPT rawlog. Format: docs/formats/rawlog.md.

#include <memory>
#include <string>

#include "pos/core/measurement.hpp"

namespace pos::io {

struct RawlogWriterConfig {
  int gzip_level = 1;  ///< 0 none .. 9 smallest; reading time hardly depends on it
};

/// Writes in the order given; the file is complete when the writer is closed or destroyed.
class RawlogWriter {
 public:
  /// Throws DataError when the file cannot be created, ConfigError for a level outside 0..9.
  explicit RawlogWriter(const std::string& path, const RawlogWriterConfig& config = {});
  RawlogWriter(RawlogWriter&&) noexcept;
  RawlogWriter& operator=(RawlogWriter&&) noexcept;
  ~RawlogWriter();

  /// RawlogReader gives the same measurement back: stamps to 100 ns, ranges and scans to single precision.
  /// Throws DataError for a defective measurement and when the disk is full.
  void write(const Measurement& measurement);
  /// Flushes and ends the file; throws DataError when that fails. Nothing can be written afterwards.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pos::io
