/// libFuzzer entry point: MCAP files, the messages in them, and packed copies of logs. The first byte says
/// which. Any bytes end as a DataError, a damaged log or a clean one, and no defective measurement comes out.
/// Build with clang: -fsanitize=fuzzer,address, linked with pos_io.

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "../../libpos/src/io/cdr.hpp"
#include "../../libpos/src/io/log_cache_parts.hpp"
#include "../../libpos/src/io/mcap_reader.hpp"
#include "../../libpos/src/io/ros_sensors.hpp"
#include "pos/core/error.hpp"
#include "pos/io/log_cache.hpp"
#include "pos/io/mcap_log.hpp"

namespace {

using pos::io::LogReader;

std::string scratchFile() {
  return (std::filesystem::temp_directory_path() / ("pos_fuzz_logs_" + std::to_string(::getpid()))).string();
}

void write(const std::string& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void readThrough(LogReader& reader, bool checked) {
  while (const auto measurement = reader.next()) {
    if (checked && pos::defect(*measurement)) std::abort();
  }
}

void readMcap(const std::string& path, std::string_view bytes) {
  write(path, std::string(pos::io::kMcapMagic) + std::string(bytes));
  pos::io::McapLogReader reader(path);
  readThrough(reader, true);
}

void readMessage(std::string_view bytes) {
  constexpr std::array<std::string_view, 8> kTypes{
      "sensor_msgs/msg/Imu",           "sensor_msgs/msg/NavSatFix", "sensor_msgs/msg/LaserScan",
      "geometry_msgs/msg/PoseStamped", "pos_msgs/msg/BeaconRange",  "pos_msgs/msg/WheelSpeeds",
      "pos_msgs/msg/WheelTicks",       "pos_msgs/msg/PassageFix"};
  for (const std::string_view type : kTypes) {
    try {
      (void)pos::io::ros::sensorFrom(type, bytes);
    } catch (const pos::io::BadCdr&) {
      continue;
    }
  }
  try {
    (void)pos::io::ros::odometryFrom(bytes);
  } catch (const pos::io::BadCdr&) {
  }
  try {
    (void)pos::io::ros::transformsFrom(bytes);
  } catch (const pos::io::BadCdr&) {
  }
}

/// The bytes as records and end of a copy whose checksums are right; the first two say where the one becomes
/// the other.
void readCopy(const std::string& path, std::string_view bytes) {
  using namespace pos::io;
  if (bytes.size() < 2) return;
  const std::size_t length = static_cast<std::uint8_t>(bytes[0]) + 256U * static_cast<std::uint8_t>(bytes[1]);
  bytes.remove_prefix(2);
  const auto block = [](BlockType type, std::string_view content) {
    return packedBytes(type, static_cast<std::uint32_t>(content.size()), crcOf(content)) +
           std::string(content);
  };
  const std::string source =
      packedBytes(std::string("a.rawlog"), std::uint64_t{0}, std::int64_t{0}, std::string());
  const std::size_t half = std::min(length, bytes.size());
  write(path, std::string(kCacheMagic) + block(BlockType::Head, source) +
                  block(BlockType::Records, bytes.substr(0, half)) +
                  block(BlockType::End, bytes.substr(half)));
  pos::io::LogCacheReader reader(path);
  readThrough(reader, false);  // a copy holds what its reader was given; estimators check again
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string kPath = scratchFile();
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    if (data[0] % 3 == 0) readMcap(kPath, bytes);
    if (data[0] % 3 == 1) readMessage(bytes);
    if (data[0] % 3 == 2) readCopy(kPath, bytes);
  } catch (const pos::DataError&) {
    return 0;
  }
  return 0;
}
