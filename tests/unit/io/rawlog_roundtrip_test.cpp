#include <gtest/gtest.h>

#include "../../../libpos/src/io/byte_source.hpp"
#include "../../../libpos/src/io/object_guard.hpp"
#include "pos/core/error.hpp"
#include "rawlog_samples.hpp"

namespace pos::io {
namespace {

constexpr double kTiny = 1e-12;

void expectPose(const Pose3& a, const Pose3& b) {
  EXPECT_LT(minus(a, b).norm(), kTiny);
}

template <typename T>
bool bothOrNone(const std::optional<T>& a, const std::optional<T>& b) {
  EXPECT_EQ(a.has_value(), b.has_value());
  return a.has_value() && b.has_value();
}

struct ExpectSame {
  const Reading& other;

  void operator()(const OdometryIncrement& a) const {
    const auto& b = std::get<OdometryIncrement>(other);
    EXPECT_NEAR(a.increment.x, b.increment.x, kTiny);
    EXPECT_NEAR(a.increment.y, b.increment.y, kTiny);
    EXPECT_NEAR(a.increment.yaw, b.increment.yaw, kTiny);
    EXPECT_EQ(a.interval, b.interval);
    if (bothOrNone(a.covariance, b.covariance)) {
      EXPECT_EQ(*a.covariance, *b.covariance);
    }
  }
  void operator()(const WheelSpeeds& a) const {
    const auto& b = std::get<WheelSpeeds>(other);
    EXPECT_EQ(a.left, b.left);
    EXPECT_EQ(a.right, b.right);
    EXPECT_EQ(a.yaw_rate, b.yaw_rate);
  }
  void operator()(const WheelTicks& a) const {
    const auto& b = std::get<WheelTicks>(other);
    EXPECT_EQ(a.left, b.left);
    EXPECT_EQ(a.right, b.right);
  }
  void operator()(const ImuSample& a) const {
    const auto& b = std::get<ImuSample>(other);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.angular, b.angular);
    EXPECT_EQ(a.linear, b.linear);
    EXPECT_EQ(a.interval, b.interval);
  }
  void operator()(const BeaconRange& a) const {
    const auto& b = std::get<BeaconRange>(other);
    EXPECT_EQ(a.tag, b.tag);
    EXPECT_EQ(a.anchor, b.anchor);
    EXPECT_FLOAT_EQ(static_cast<float>(a.range), static_cast<float>(b.range));
    EXPECT_EQ(a.sigma, b.sigma);
    EXPECT_EQ(a.rx_power_dbm, b.rx_power_dbm);
    EXPECT_EQ(a.first_path_power_dbm, b.first_path_power_dbm);
    if (bothOrNone(a.tag_body, b.tag_body)) {
      EXPECT_EQ(*a.tag_body, *b.tag_body);
    }
  }
  void operator()(const GnssFix& a) const {
    const auto& b = std::get<GnssFix>(other);
    EXPECT_NEAR(a.latitude, b.latitude, 1e-15);
    EXPECT_NEAR(a.longitude, b.longitude, 1e-15);
    EXPECT_EQ(a.altitude, b.altitude);
    EXPECT_EQ(a.covariance_enu, b.covariance_enu);
    EXPECT_EQ(a.quality, b.quality);
  }
  void operator()(const Scan2D& a) const {
    const auto& b = std::get<Scan2D>(other);
    expectPose(a.T_body_sensor, b.T_body_sensor);
    EXPECT_NEAR(a.angle_first, b.angle_first, 1e-6);
    EXPECT_NEAR(a.angle_step, b.angle_step, 1e-7);
    EXPECT_EQ(a.range_max, b.range_max);
    EXPECT_EQ(a.ranges, b.ranges);
    EXPECT_EQ(a.valid, b.valid);
  }
  void operator()(const PoseTruth& a) const {
    expectPose(a.T_map_body, std::get<PoseTruth>(other).T_map_body);
  }
  void operator()(const PassageFix& a) const {
    const auto& b = std::get<PassageFix>(other);
    EXPECT_EQ(a.place, b.place);
    EXPECT_EQ(a.p_map, b.p_map);
    EXPECT_EQ(a.p_body, b.p_body);
    EXPECT_EQ(a.covariance, b.covariance);
    EXPECT_EQ(a.yaw, b.yaw);
    EXPECT_EQ(a.yaw_sigma, b.yaw_sigma);
  }
};

void expectSame(const std::vector<Measurement>& written, const std::vector<Measurement>& read) {
  ASSERT_EQ(written.size(), read.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    SCOPED_TRACE("measurement " + std::to_string(i) + " " + std::string(readingName(written[i].reading)));
    EXPECT_EQ(written[i].sensor, read[i].sensor);
    EXPECT_EQ(written[i].stamp, read[i].stamp);
    ASSERT_EQ(written[i].reading.index(), read[i].reading.index());
    std::visit(ExpectSame{read[i].reading}, written[i].reading);
  }
}

TEST(RawlogRoundTrip, EveryKindOfMeasurementComesBackFromEveryCompressionLevel) {
  const ScratchFolder folder;
  for (const int level : {0, 1, 9}) {
    SCOPED_TRACE(level);
    const std::string path = folder.file("each.rawlog");
    writeLog(path, oneOfEachKind(), level);
    const ReadLog log = readWhole(path);
    expectSame(oneOfEachKind(), log.measurements);
    EXPECT_FALSE(log.end.damaged) << log.end.message;
    EXPECT_TRUE(log.tally.skipped.empty());
    EXPECT_TRUE(log.tally.refused.empty());
    EXPECT_EQ(log.tally.references, 2U);  // "wheels" and "visual"
    EXPECT_EQ(log.format, LogFormat::Observations);
  }
}

TEST(RawlogRoundTrip, WritingWhatWasReadGivesTheSameMeasurementsAgain) {
  const ScratchFolder folder;
  writeLog(folder.file("a.rawlog"), oneOfEachKind());
  const ReadLog first = readWhole(folder.file("a.rawlog"));
  writeLog(folder.file("b.rawlog"), first.measurements);
  expectSame(first.measurements, readWhole(folder.file("b.rawlog")).measurements);
}

TEST(RawlogRoundTrip, StampsAreKeptToAHundredNanoseconds) {
  const ScratchFolder folder;
  const std::vector<Measurement> log{{Stamp{Duration{1'700'000'000'123'456'749}}, "imu", ImuSample{}},
                                     {Stamp{Duration{1'700'000'000'123'456'750}}, "imu", ImuSample{}},
                                     {Stamp{Duration{-149}}, "imu", ImuSample{}},
                                     {Stamp{Duration{0}}, "imu", ImuSample{}}};
  writeLog(folder.file("t.rawlog"), log);
  const auto read = readWhole(folder.file("t.rawlog")).measurements;
  ASSERT_EQ(read.size(), 4U);
  EXPECT_EQ(read[0].stamp.time_since_epoch().count(), 1'700'000'000'123'456'700);
  EXPECT_EQ(read[1].stamp.time_since_epoch().count(), 1'700'000'000'123'456'800);
  EXPECT_EQ(read[2].stamp.time_since_epoch().count(), -100);
  EXPECT_EQ(read[3].stamp.time_since_epoch().count(), 0);
}

TEST(RawlogRoundTrip, AnEmptyLabelBecomesTheReadingsName) {
  const ScratchFolder folder;
  writeLog(folder.file("l.rawlog"), {{at(0), "", ImuSample{}}, {at(1), "", OdometryIncrement{}}});
  const auto read = readWhole(folder.file("l.rawlog")).measurements;
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].sensor, "imu");
  EXPECT_EQ(read[1].sensor, "odometry");
}

TEST(RawlogRoundTrip, TheGuardKnowsTheLengthOfEveryObjectTheWriterMakes) {
  const ScratchFolder folder;
  writeLog(folder.file("g.rawlog"), oneOfEachKind());
  ByteSource source(folder.file("g.rawlog"));
  int objects = 0;
  while (!source.atEnd()) {
    const ObjectOutline outline = outlineNext(source);
    ASSERT_FALSE(outline.damage) << *outline.damage << " in object " << objects;
    ASSERT_TRUE(outline.length) << "object " << objects << " "
                                << std::string(reinterpret_cast<const char*>(source.peek(60).data()), 60);
    std::string bytes(*outline.length, ' ');
    ASSERT_EQ(source.read(bytes.data(), bytes.size()), bytes.size());
    ++objects;
  }
  EXPECT_GT(objects, 30);
}

TEST(RawlogWriter, RefusesADefectiveMeasurement) {
  const ScratchFolder folder;
  RawlogWriter writer(folder.file("w.rawlog"));
  EXPECT_THROW(writer.write({at(0), "uwb", rangeTo(1, 0.0)}), DataError);
  EXPECT_THROW(writer.write({at(0), "scan", Scan2D{}}), DataError);
}

TEST(RawlogWriter, SaysWhichFolderOrLevelIsWrong) {
  const ScratchFolder folder;
  EXPECT_THROW(RawlogWriter(folder.file("no/such/folder.rawlog")), DataError);
  EXPECT_THROW(RawlogWriter(folder.file("w.rawlog"), {.gzip_level = 10}), ConfigError);
}

}  // namespace
}  // namespace pos::io
