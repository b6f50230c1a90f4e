#pragma once
/// A rawlog made for the occasion, and MRPT's bare read of it: the yardstick of reading and of replaying.

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/registerAllClasses.h>
#include <mrpt/serialization/CArchive.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "pos/io/rawlog_writer.hpp"
#include "support.hpp"

namespace pos::bench {

inline constexpr int kSamplesPerRange = 10;
inline constexpr int kLogAnchors = 8;
inline constexpr double kSampleInterval = 0.005;  // s

inline Stamp logStart() {
  return stampFromSeconds(1.7e9);
}

/// A circle drive of `samples` IMU samples at 200 Hz with a range after every tenth; the file lives as long
/// as the object.
class GeneratedLog {
 public:
  explicit GeneratedLog(int samples)
      : path_(std::filesystem::temp_directory_path() /
              ("pos_bench_" + std::to_string(::getpid()) + "_" + std::to_string(samples) + ".rawlog")) {
    io::RawlogWriter writer(path_.string());
    for (int i = 0; i < samples; ++i) {
      const Stamp stamp = logStart() + i * durationFromSeconds(kSampleInterval);
      writer.write({stamp, "imu", sample(i)});
      if (i % kSamplesPerRange == 0) writer.write({stamp, "uwb", range(i)});
    }
    writer.close();
  }
  GeneratedLog(const GeneratedLog&) = delete;
  GeneratedLog& operator=(const GeneratedLog&) = delete;
  ~GeneratedLog() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  std::string path() const { return path_.string(); }

 private:
  static ImuSample sample(int i) {
    ImuSample sample;
    sample.angular = {1e-3 * (i % 17), -1e-3 * (i % 5), 0.2 + 1e-3 * (i % 11)};
    sample.linear = {1e-2 * (i % 7), 0.4 + 1e-2 * (i % 13), 9.81};
    return sample;
  }
  BeaconRange range(int i) const {
    const int heard = i / kSamplesPerRange;
    const map::Anchor& anchor = map_->anchors[static_cast<std::size_t>(heard % kLogAnchors)];
    BeaconRange range;
    range.anchor = anchor.id;
    range.range = CircleDrive::range(CircleDrive::pose(kSampleInterval * i), anchor, heard);
    return range;
  }

  std::shared_ptr<const map::TunnelMap> map_ = ringOfAnchors(kLogAnchors);
  std::filesystem::path path_;
};

/// Reads every object of the log as MRPT's own applications do, and drops it. Says how many there were.
inline std::int64_t objectsReadByMrpt(const std::string& path) {
  mrpt::io::CFileGZInputStream file(path);
  auto archive = mrpt::serialization::archiveFrom(file);
  std::int64_t count = 0;
  try {
    for (;;) {
      mrpt::serialization::CSerializable::Ptr object;
      archive >> object;
      benchmark::DoNotOptimize(object);
      ++count;
    }
  } catch (const mrpt::serialization::CExceptionEOF&) {
    return count;
  }
}

}  // namespace pos::bench
