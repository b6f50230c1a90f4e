#pragma once
/// Small logs and a scratch folder for the rawlog tests.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "pos/io/rawlog_reader.hpp"
#include "pos/io/rawlog_writer.hpp"

namespace pos::io {

/// A folder of this test's own, removed afterwards.
class ScratchFolder {
 public:
  ScratchFolder() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() / (std::string("pos_") + info->test_suite_name() + "_" +
                                                      info->name() + "_" + std::to_string(::getpid()));
    std::filesystem::create_directories(path_);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline std::string contentOf(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void replaceContent(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

struct ReadLog {
  std::vector<Measurement> measurements;
  std::vector<std::optional<std::size_t>> frames;
  LogEnd end;
  LogTally tally;
  LogFormat format = LogFormat::Unknown;
};

inline ReadLog readWhole(const std::string& path) {
  RawlogReader reader(path);
  ReadLog log;
  while (auto measurement = reader.next()) {
    log.measurements.push_back(std::move(*measurement));
    log.frames.push_back(reader.frame());
  }
  log.end = reader.end();
  log.tally = reader.tally();
  log.format = reader.format();
  return log;
}

inline void writeLog(const std::string& path, const std::vector<Measurement>& measurements, int level = 1) {
  RawlogWriter writer(path, {.gzip_level = level});
  for (const Measurement& measurement : measurements) writer.write(measurement);
  writer.close();
}

inline Stamp at(double s) {
  return stampFromSeconds(1'700'000'000.0) + durationFromSeconds(s);
}

inline BeaconRange rangeTo(AnchorId anchor, double range) {
  BeaconRange reading;
  reading.anchor = anchor;
  reading.range = range;
  return reading;
}

/// Every kind of reading, with and without the parts that MRPT has no room for.
inline std::vector<Measurement> oneOfEachKind() {
  const auto ms = [](int n) { return Duration{1'000'000LL * n}; };
  Matrix<3, 3> P;
  P << 0.04, 0.01, 0.002, 0.01, 0.09, -0.003, 0.002, -0.003, 0.01;
  ImuSample rates;
  rates.angular = {0.1, -0.2, 0.3};
  rates.linear = {0.5, -0.25, 9.81};
  ImuSample increments = rates;
  increments.kind = ImuSample::Kind::Increments;
  increments.interval = ms(7);
  const BeaconRange bare = rangeTo(12, 7.25);
  BeaconRange full = rangeTo(-77, 41.5);
  full.tag = 3;
  full.sigma = 0.125;
  full.tag_body = Eigen::Vector3d{0.16, -0.5, 1.12};
  full.rx_power_dbm = -81.3;
  full.first_path_power_dbm = -84.7;
  BeaconRange centred = bare;
  centred.tag_body = Eigen::Vector3d::Zero();
  GnssFix fix;
  fix.latitude = 0.654321;
  fix.longitude = -0.123456;
  fix.altitude = 210.25;
  fix.covariance_enu = P;
  fix.quality = GnssFix::Quality::RtkFloat;
  Scan2D scan;
  scan.T_body_sensor = Pose3::fromXyzYawPitchRoll(0.1, 0.0, 0.3, 0.5, 0.1, -0.2);
  scan.angle_first = -1.5;
  scan.angle_step = 0.75;
  scan.range_max = 80.0;
  scan.ranges = {1.5F, 2.5F, 80.0F, 81.0F, 4.0F};
  scan.valid = {1, 1, 1, 0, 0};
  Scan2D lopsided = scan;
  lopsided.angle_first = 0.25;
  lopsided.angle_step = -0.125;
  PassageFix named;
  named.place = "refuge 7 = \xC3\x9C, 50 %";
  named.p_map = {10.0, -20.0, -300.0};
  named.covariance = P;
  PassageFix turned = named;
  turned.yaw = 2.5;
  turned.yaw_sigma = 0.01;
  turned.p_body = {1.5, -0.25, 2.0};
  return {
      {at(1.0), "wheels", OdometryIncrement{{0.3, 0.01, 0.05}, ms(500), {}}},
      {at(1.5), "wheels", OdometryIncrement{{0.4, -0.01, -0.15}, ms(500), P}},
      {at(2.0), "wheels", OdometryIncrement{{0.2, 0.0, 3.0}, {}, {}}},
      {at(2.5), "wheels", OdometryIncrement{{0.2, 0.0, 0.1}, ms(120), {}}},
      {at(2.6), "visual", OdometryIncrement{{-0.2, 0.1, 0.1}, {}, P}},
      {at(3.0), "wheels", WheelSpeeds{1.5, 1.25, {}}},
      {at(3.1), "wheels", WheelSpeeds{1.5, -1.25, 0.0}},
      {at(3.2), "ticks", WheelTicks{5'000'000'000LL, -17}},
      {at(3.3), "wheels", OdometryIncrement{{0.1, 0.0, 0.0}, ms(800), {}}},
      {at(4.0), "imu", rates},
      {at(4.1), "imu", increments},
      {at(4.2), "uwb", bare},
      {at(4.2), "uwb", full},
      {at(4.2), "uwb;tag=5", centred},
      {at(5.0), "gps", fix},
      {at(6.0), "front", scan},
      {at(6.5), "front", lopsided},
      {at(7.0), "total_station", PoseTruth{Pose3::fromXyzYawPitchRoll(1.0, 2.0, 3.0, -2.0, 0.3, 0.2)}},
      {at(8.0), "portal", named},
      {at(8.5), "portal", turned},
      {at(7.9), "imu", rates},
  };
}

}  // namespace pos::io
