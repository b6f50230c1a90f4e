#pragma once
/// Sensors' readings in MCAP files of profile `ros2`: a bag of any ROS 2 vehicle as a log, and a log as such
/// a bag. What becomes what: docs/formats/mcap.md.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "pos/core/pose3.hpp"
#include "pos/io/log_reader.hpp"

namespace pos::io {

/// Where the sensors of a frame sit on the vehicle, T_body_frame, by the frame's name.
using Mounts = std::map<std::string, Pose3>;

/// True where the file begins as an MCAP file does.
bool isMcap(const std::filesystem::path& path);

/// Reads one file from front to back, one chunk at a time in memory. A reading's stamp is that of its
/// message's header.
class McapLogReader final : public LogReader {
 public:
  /// `mounts` go before what the file's own /tf_static says. Throws DataError for a missing file and one that
  /// is no MCAP file.
  explicit McapLogReader(const std::filesystem::path& path, Mounts mounts = {});
  McapLogReader(McapLogReader&&) noexcept;
  McapLogReader& operator=(McapLogReader&&) noexcept;
  ~McapLogReader() override;

  std::optional<Measurement> next() override;
  const LogEnd& end() const override;
  const LogTally& tally() const override;
  LogFormat format() const override { return LogFormat::Mcap; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes in the order given. McapLogReader gives the same readings back: angles of scans to single
/// precision, IMU increments as rates, the interval of an odometry increment as the time since the one
/// before.
class McapLogWriter {
 public:
  /// Throws DataError when the file cannot be created.
  explicit McapLogWriter(const std::filesystem::path& path);
  McapLogWriter(McapLogWriter&&) noexcept;
  McapLogWriter& operator=(McapLogWriter&&) noexcept;
  ~McapLogWriter();

  /// Throws DataError for a defective measurement and when the disk is full.
  void write(const Measurement& measurement);
  /// Ends the file; nothing can be written afterwards.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pos::io
