/// Logs as MCAP files and back; what other people's files may hold and lack.
#include "pos/io/mcap_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "../../../libpos/src/io/cdr.hpp"
#include "../../../libpos/src/io/ros_messages.hpp"
#include "../../../libpos/src/io/ros_sensors.hpp"
#include "pos/core/error.hpp"
#include "pos/core/random.hpp"
#include "pos/io/json_lines.hpp"
#include "pos/io/log_info.hpp"
#include "pos/io/mcap_writer.hpp"
#include "rawlog_samples.hpp"

namespace pos::io {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Key;
using ::testing::SizeIs;

struct Read {
  std::vector<Measurement> measurements;
  LogEnd end;
  LogTally tally;
};

Read readMcap(const std::string& path, Mounts mounts = {}) {
  McapLogReader reader(path, std::move(mounts));
  Read all;
  while (auto measurement = reader.next()) all.measurements.push_back(std::move(*measurement));
  all.end = reader.end();
  all.tally = reader.tally();
  return all;
}

void writeMcap(const std::string& path, const std::vector<Measurement>& measurements) {
  McapLogWriter writer(path);
  for (const Measurement& measurement : measurements) writer.write(measurement);
  writer.close();
}

template <class T>
const T* as(const Measurement& measurement) {
  return std::get_if<T>(&measurement.reading);
}

/// What the format cannot keep is put as it comes back.
Measurement asKept(Measurement m, std::map<std::string, Stamp>& last) {
  if (auto* odometry = std::get_if<OdometryIncrement>(&m.reading)) {
    const auto before = last.find(m.sensor);
    const Duration since =
        before != last.end() ? m.stamp - before->second : odometry->interval.value_or(Duration{0});
    odometry->interval = since > Duration{0} ? std::optional(since) : std::nullopt;
    if (since <= Duration{0}) odometry->covariance.reset();
    last[m.sensor] = m.stamp;
  }
  if (auto* imu = std::get_if<ImuSample>(&m.reading);
      imu != nullptr && imu->kind == ImuSample::Kind::Increments) {
    imu->angular /= seconds(*imu->interval);
    imu->linear /= seconds(*imu->interval);
    imu->kind = ImuSample::Kind::Rates;
    imu->interval.reset();
  }
  if (auto* scan = std::get_if<Scan2D>(&m.reading)) {
    for (std::size_t i = 0; i < scan->ranges.size(); ++i)
      scan->ranges[i] = scan->valid[i] != 0 ? scan->ranges[i] : 0.0F;
  }
  return m;
}

void expectNear(const Measurement& got, const Measurement& wanted) {
  EXPECT_EQ(got.stamp, wanted.stamp);
  EXPECT_EQ(got.sensor, wanted.sensor);
  ASSERT_EQ(got.reading.index(), wanted.reading.index());
  if (const auto* a = as<OdometryIncrement>(got)) {
    const auto* b = as<OdometryIncrement>(wanted);
    EXPECT_LT(minus(a->increment, b->increment).norm(), 1e-12);
    EXPECT_EQ(a->interval, b->interval);
    ASSERT_EQ(a->covariance.has_value(), b->covariance.has_value());
    if (a->covariance) {
      EXPECT_LT((*a->covariance - *b->covariance).norm(), 1e-12);
    }
  } else if (const auto* scan = as<Scan2D>(got)) {
    const auto* b = as<Scan2D>(wanted);
    EXPECT_LT(minus(scan->T_body_sensor, b->T_body_sensor).norm(), 1e-12);
    EXPECT_NEAR(scan->angle_first, b->angle_first, 1e-6);
    EXPECT_NEAR(scan->angle_step, b->angle_step, 1e-7);
    EXPECT_EQ(scan->ranges, b->ranges);
    EXPECT_EQ(scan->valid, b->valid);
  } else if (const auto* truth = as<PoseTruth>(got)) {
    EXPECT_LT(minus(truth->T_map_body, as<PoseTruth>(wanted)->T_map_body).norm(), 1e-12);
  } else if (const auto* fix = as<GnssFix>(got)) {
    const auto* b = as<GnssFix>(wanted);
    EXPECT_NEAR(fix->latitude, b->latitude, 1e-15);
    EXPECT_NEAR(fix->longitude, b->longitude, 1e-15);
    EXPECT_EQ(fix->altitude, b->altitude);
    EXPECT_EQ(fix->covariance_enu, b->covariance_enu);
    EXPECT_EQ(fix->quality, b->quality);
  } else {
    EXPECT_EQ(jsonLine(got), jsonLine(wanted));
  }
}

TEST(McapLog, EveryKindOfReadingComesBack) {
  const ScratchFolder folder;
  writeMcap(folder.file("a.mcap"), oneOfEachKind());
  const Read read = readMcap(folder.file("a.mcap"));
  std::map<std::string, Stamp> last;
  const std::vector<Measurement> wanted = oneOfEachKind();
  ASSERT_THAT(read.measurements, SizeIs(wanted.size()));
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    SCOPED_TRACE(jsonLine(wanted[i]));
    expectNear(read.measurements[i], asKept(wanted[i], last));
  }
  EXPECT_FALSE(read.end.damaged) << read.end.message;
  EXPECT_TRUE(read.tally.refused.empty());
  EXPECT_EQ(read.tally.references, 2U);  // one a sensor of odometry
}

TEST(McapLog, IsOpenedByItsFirstBytesAndToldByInfo) {
  const ScratchFolder folder;
  writeMcap(folder.file("a.log"), oneOfEachKind());
  EXPECT_NE(dynamic_cast<McapLogReader*>(openLog(folder.file("a.log")).reader.get()), nullptr);
  const LogInfo info = logInfo(folder.file("a.log"));
  EXPECT_EQ(info.measurements, oneOfEachKind().size());
  EXPECT_THAT(toText(info), HasSubstr("MCAP"));
}

TEST(McapLog, ADefectiveMeasurementIsNotWritten) {
  const ScratchFolder folder;
  McapLogWriter writer(folder.file("a.mcap"));
  EXPECT_THROW(writer.write({at(0.0), "uwb", rangeTo(1, -2.0)}), DataError);
}

/// A scan in a frame that is not the vehicle's, as a foreign file has it.
void writeForeignScan(const std::string& path, bool with_mount) {
  McapWriter file(path);
  const Scan2D scan = std::get<Scan2D>(oneOfEachKind()[15].reading);
  if (with_mount) {
    const auto tf = file.addChannel("/tf_static", ros::transformsType());
    const Pose3 mast = Pose3::fromXyzYawPitchRoll(1.0, 0.0, 2.0, kPi / 2.0, 0.0, 0.0);
    const Pose3 laser = Pose3::fromXyzYawPitchRoll(0.5, 0.0, 0.0, 0.0, 0.0, 0.0);
    file.write(tf, at(0.0), ros::transforms(at(0.0), laser, "laser", "mast"));
    file.write(tf, at(0.0), ros::transforms(at(0.0), mast, "mast", "base_link"));
  }
  const auto channel = file.addChannel("/scan", ros::sensorType(scan));
  file.write(channel, at(1.0), ros::sensorMessage(at(1.0), scan, "laser"));
  file.close();
}

TEST(McapLog, ScansArePlacedByTheFilesStaticTransforms) {
  const ScratchFolder folder;
  writeForeignScan(folder.file("a.mcap"), true);
  const Read read = readMcap(folder.file("a.mcap"));
  ASSERT_THAT(read.measurements, SizeIs(1));
  EXPECT_EQ(read.measurements.front().sensor, "scan");
  const Pose3& T = as<Scan2D>(read.measurements.front())->T_body_sensor;
  EXPECT_LT((T.translation - Eigen::Vector3d(1.0, 0.5, 2.0)).norm(),
            1e-12);  // half a metre ahead of a mast turned left
  EXPECT_NEAR(T.yaw(), kPi / 2.0, 1e-12);
}

TEST(McapLog, AScanThatNothingPlacesIsRefusedUnlessItsMountIsTold) {
  const ScratchFolder folder;
  writeForeignScan(folder.file("a.mcap"), false);
  const Read read = readMcap(folder.file("a.mcap"));
  EXPECT_TRUE(read.measurements.empty());
  ASSERT_THAT(read.tally.refused, SizeIs(1));
  EXPECT_THAT(read.tally.refused.begin()->first, HasSubstr("'laser'"));
  EXPECT_THAT(read.tally.refused.begin()->first, HasSubstr("--mount"));
  const Pose3 mount = Pose3::fromXyzYawPitchRoll(1.0, 2.0, 3.0, 0.0, 0.0, 0.0);
  const Read placed = readMcap(folder.file("a.mcap"), {{"laser", mount}});
  ASSERT_THAT(placed.measurements, SizeIs(1));
  EXPECT_EQ(as<Scan2D>(placed.measurements.front())->T_body_sensor.translation, mount.translation);
}

TEST(McapLog, TransformsInACircleEndAsRefused) {
  const ScratchFolder folder;
  McapWriter file(folder.file("a.mcap"));
  const auto tf = file.addChannel("/tf_static", ros::transformsType());
  file.write(tf, at(0.0), ros::transforms(at(0.0), {}, "imu", "mast"));
  file.write(tf, at(0.0), ros::transforms(at(0.0), {}, "mast", "imu"));
  const auto channel = file.addChannel("/imu", ros::sensorType(ImuSample{}));
  file.write(channel, at(1.0), ros::sensorMessage(at(1.0), ImuSample{}, "imu"));
  file.close();
  EXPECT_THAT(readMcap(folder.file("a.mcap")).tally.refused, SizeIs(1));
}

TEST(McapLog, TheImusAxesBecomeTheBodys) {
  const ScratchFolder folder;
  McapWriter file(folder.file("a.mcap"));
  const auto tf = file.addChannel("/tf_static", ros::transformsType());
  const Pose3 upside_down = Pose3::fromXyzYawPitchRoll(0.0, 0.0, 1.0, 0.0, 0.0, kPi);
  file.write(tf, at(0.0), ros::transforms(at(0.0), upside_down, "imu", "base_link"));
  ImuSample sample;
  sample.angular = {0.1, 0.2, 0.3};
  sample.linear = {0.0, 0.0, -9.81};
  const auto channel = file.addChannel("/imu", ros::sensorType(sample));
  file.write(channel, at(1.0), ros::sensorMessage(at(1.0), sample, "imu"));
  file.close();
  const Read read = readMcap(folder.file("a.mcap"));
  ASSERT_THAT(read.measurements, SizeIs(1));
  EXPECT_LT((as<ImuSample>(read.measurements.front())->linear - Eigen::Vector3d(0.0, 0.0, 9.81)).norm(),
            1e-12);
  EXPECT_LT((as<ImuSample>(read.measurements.front())->angular - Eigen::Vector3d(0.1, -0.2, -0.3)).norm(),
            1e-12);
}

TEST(McapLog, WhatIsNotReadIsCounted) {
  const ScratchFolder folder;
  McapWriter file(folder.file("a.mcap"));
  const auto text = file.addChannel("/chatter", {"std_msgs/msg/String", "string data\n"});
  const auto pose = file.addChannel("/goal", ros::poseType());
  const auto imu = file.addChannel("/imu", ros::sensorType(ImuSample{}));
  file.write(text, at(0.0), (CdrWriter() << std::string("hello")).bytes());
  file.write(pose, at(0.0), ros::pose(at(0.0), {}));
  const std::string whole = ros::sensorMessage(at(1.0), ImuSample{}, "base_link");
  file.write(imu, at(1.0), whole.substr(0, whole.size() / 2));
  file.close();
  const Read read = readMcap(folder.file("a.mcap"));
  EXPECT_TRUE(read.measurements.empty());
  EXPECT_THAT(read.tally.skipped, Contains(Key("std_msgs/msg/String")));
  EXPECT_THAT(read.tally.skipped, Contains(Key(HasSubstr("/ground_truth"))));
  EXPECT_THAT(read.tally.refused, Contains(Key(HasSubstr("damaged"))));
  EXPECT_EQ(read.end.objects, 3U);
}

/// Where the record that ends the data ends.
std::size_t endOfData(const std::string& file) {
  constexpr char kDataEnd = 15;
  std::size_t place = 8;
  while (true) {
    std::uint64_t length = 0;
    std::memcpy(&length, file.data() + place + 1, sizeof(length));
    const bool last = file[place] == kDataEnd;
    place += 9 + length;
    if (last) return place;
  }
}

TEST(McapLog, EveryCutIsToldAndNoFlipIsTaken) {
  const ScratchFolder folder;
  writeMcap(folder.file("a.mcap"), oneOfEachKind());
  const std::string whole = contentOf(folder.file("a.mcap"));
  const std::size_t data_end = endOfData(whole);  // behind it are only indexes
  for (std::size_t size = 8; size < data_end; size += 11) {
    replaceContent(folder.file("b.mcap"), whole.substr(0, size));
    EXPECT_TRUE(readMcap(folder.file("b.mcap")).end.damaged) << size;
  }
  const std::size_t expected = oneOfEachKind().size();
  for (std::size_t i = 8; i < whole.size(); i += 5) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x10);
    replaceContent(folder.file("b.mcap"), bytes);
    const Read read = readMcap(folder.file("b.mcap"));
    EXPECT_TRUE(read.end.damaged || read.measurements.size() == expected) << i;
  }
}

TEST(McapLog, WhatLiesBeforeACutInsideAChunkIsDelivered) {
  const ScratchFolder folder;
  std::vector<Measurement> many;
  RandomStream random(3, 0);
  for (int i = 0; i < 20'000; ++i)
    many.push_back({at(0.01 * i), "uwb", rangeTo(i % 9, random.uniform(1.0, 99.0))});
  writeMcap(folder.file("a.mcap"), many);
  const std::string whole = contentOf(folder.file("a.mcap"));
  std::size_t before = 0;
  for (const double part : {0.05, 0.2, 0.4, 0.6, 0.8}) {
    const auto size = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
    replaceContent(folder.file("b.mcap"), whole.substr(0, size));
    const Read read = readMcap(folder.file("b.mcap"));
    EXPECT_EQ(read.end.message, "the file is cut short");
    EXPECT_GT(read.measurements.size(), before);
    EXPECT_GT(static_cast<double>(read.measurements.size()), 0.5 * part * 20'000);
    for (std::size_t i = 0; i < read.measurements.size(); ++i)
      EXPECT_EQ(jsonLine(read.measurements[i]), jsonLine(many[i]));
    before = read.measurements.size();
  }
}

TEST(McapLog, AnotherFileIsRefused) {
  const ScratchFolder folder;
  replaceContent(folder.file("a.mcap"), "time,range\n");
  EXPECT_THROW(McapLogReader(folder.file("a.mcap")), DataError);
  EXPECT_THROW(McapLogReader(folder.file("none.mcap")), DataError);
  EXPECT_THROW(McapLogReader(folder.file("")), DataError);
}

}  // namespace
}  // namespace pos::io
