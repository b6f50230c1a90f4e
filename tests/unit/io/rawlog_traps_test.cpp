/// One test for each trap of MRPT that the reader takes out of the way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "../../../libpos/src/io/mrpt_conversion.hpp"
#include "rawlog_mrpt_samples.hpp"

namespace pos::io {
namespace {

TEST(RawlogTraps, PoseCovarianceHasYawBeforePitchAndRoll) {
  mrpt::poses::CPose3DPDFGaussian pose;
  pose.cov.setZero();
  for (int i = 0; i < 6; ++i) pose.cov(i, i) = i + 1.0;
  const LevelCovariance found = levelCovariance(pose);
  EXPECT_EQ(found.yaw_variance, 4.0);
  EXPECT_EQ(found.position(2, 2), 3.0);
  EXPECT_EQ(gaussianToMrpt({}, found).cov(3, 3), 4.0);
  EXPECT_EQ(gaussianToMrpt({}, found).cov(5, 5), 0.0);
}

TEST(RawlogTraps, ImuRatesAreStoredZFirst) {
  auto imu = observed<CObservationIMU>(0);
  for (int i = 0; i < 6; ++i) imu->set(static_cast<TIMUDataIndex>(i), i);
  const auto log = readBack({imu});
  ASSERT_EQ(log.measurements.size(), 1U);
  const auto& sample = std::get<ImuSample>(log.measurements[0].reading);
  EXPECT_EQ(sample.linear, Eigen::Vector3d(0, 1, 2));
  EXPECT_EQ(sample.angular, Eigen::Vector3d(5, 4, 3));
  EXPECT_EQ(log.measurements[0].sensor, "imu");
}

TEST(RawlogTraps, AnImuMountedTurnedIsBroughtIntoBodyAxes) {
  auto imu = observed<CObservationIMU>(0);
  for (const auto channel : {IMU_X_ACC, IMU_Y_ACC, IMU_Z_ACC, IMU_WX, IMU_WY, IMU_WZ}) imu->set(channel, 0.0);
  imu->set(IMU_X_ACC, 1.0);
  imu->set(IMU_WY, 2.0);
  imu->sensorPose = mrpt::poses::CPose3D(0, 0, 0, 0.5 * kPi, 0, 0);
  const auto sample = std::get<ImuSample>(readBack({imu}).measurements.at(0).reading);
  EXPECT_LT((sample.linear - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((sample.angular - Eigen::Vector3d(-2, 0, 0)).norm(), 1e-12);
}

TEST(RawlogTraps, AnImuWithoutGyroIsCountedNotInvented) {
  auto imu = observed<CObservationIMU>(0);
  imu->set(IMU_X_ACC, 1.0);
  const auto log = readBack({imu});
  EXPECT_TRUE(log.measurements.empty());
  ASSERT_EQ(log.tally.skipped.size(), 1U);
  EXPECT_THAT(log.tally.skipped.begin()->first, ::testing::StartsWith("mrpt::obs::CObservationIMU without"));
}

TEST(RawlogTraps, TicksAreAHundredNanosecondsFrom1601) {
  const auto epoch = stampFromMrpt(mrpt::Clock::fromDouble(1'000.25));
  ASSERT_TRUE(epoch);
  EXPECT_EQ(epoch->time_since_epoch().count(), 1'000'250'000'000);
  EXPECT_EQ(mrpt::Clock::toDouble(stampToMrpt(stampFromSeconds(1'000.25))), 1'000.25);
}

TEST(RawlogTraps, InvalidAndAbsurdStampsAreNone) {
  const auto ticks = [](std::int64_t n) { return mrpt::Clock::time_point{mrpt::Clock::duration{n}}; };
  EXPECT_FALSE(stampFromMrpt(INVALID_TIMESTAMP));
  EXPECT_FALSE(stampFromMrpt(ticks(-5)));
  EXPECT_FALSE(stampFromMrpt(ticks(std::numeric_limits<std::int64_t>::max())));
  EXPECT_FALSE(stampFromMrpt(ticks(1)));
}

TEST(RawlogTraps, AStampMadeUpWhileReadingIsNoStamp) {
  // Scans of class version 2 store no stamp, so MRPT leaves its default: now.
  const ScratchFolder folder;
  const std::string path = folder.file("old.rawlog");
  {
    mrpt::io::CFileGZOutputStream file(path);
    auto archive = mrpt::serialization::archiveFrom(file);
    const std::string name = "CObservation2DRangeScan";
    archive << static_cast<std::uint8_t>(0x80U | name.size());
    archive.WriteBuffer(name.data(), name.size());
    archive << std::uint8_t{2} << 3.0F << true << 80.0F << mrpt::poses::CPose3D();
    const std::string matrix = "CMatrixF";
    archive << static_cast<std::uint8_t>(0x80U | matrix.size());
    archive.WriteBuffer(matrix.data(), matrix.size());
    archive << std::uint8_t{0} << std::uint32_t{0} << std::uint32_t{0} << std::uint8_t{0x88};
    archive << std::uint32_t{1} << 5.0F << std::uint8_t{1} << 0.01F << std::uint8_t{0x88};
  }
  const auto log = readWhole(path);
  EXPECT_FALSE(log.end.damaged) << log.end.message;
  EXPECT_TRUE(log.measurements.empty());
  EXPECT_THAT(log.tally.refused, ::testing::ElementsAre(::testing::Pair("no time stamp", 1U)));
}

TEST(RawlogTraps, AbsoluteOdometryBecomesIncrementsOfEachSensor) {
  auto other = odometryAt(0.5, 100.0, 0.0, 0.0);
  other->sensorLabel = "visual";
  const auto log = readBack({odometryAt(0, 5, 5, 0.5 * kPi), other, odometryAt(1, 5, 7, kPi)});
  ASSERT_EQ(log.measurements.size(), 1U);
  EXPECT_EQ(log.tally.references, 2U);
  const auto& reading = std::get<OdometryIncrement>(log.measurements[0].reading);
  EXPECT_NEAR(reading.increment.x, 2.0, 1e-12);
  EXPECT_NEAR(reading.increment.y, 0.0, 1e-12);
  EXPECT_NEAR(reading.increment.yaw, 0.5 * kPi, 1e-12);
  EXPECT_EQ(reading.interval, durationFromSeconds(1.0));
}

TEST(RawlogTraps, AnOdometryPoseThatIsNoNumberDoesNotSpoilTheNextIncrement) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto log = readBack({odometryAt(0, 0, 0, 0), odometryAt(1, nan, 0, 0), odometryAt(2, 3, 0, 0)});
  ASSERT_EQ(log.measurements.size(), 1U);
  EXPECT_NEAR(std::get<OdometryIncrement>(log.measurements[0].reading).increment.x, 3.0, 1e-12);
  EXPECT_EQ(log.tally.refused.at("odometry pose is not a finite number"), 1U);
}

TEST(RawlogTraps, EncodersAndSpeedsComeOnlyWhenFlagged) {
  auto plain = odometryAt(0, 0, 0, 0);
  plain->encoderLeftTicks = 9;
  auto flagged = odometryAt(1, 0, 0, 0);
  flagged->hasEncodersInfo = true;
  flagged->encoderLeftTicks = 7;
  flagged->encoderRightTicks = 8;
  flagged->hasVelocities = true;
  flagged->velocityLocal = {1.5, 0.0, 0.25};
  const auto log = readBack({plain, flagged});
  ASSERT_EQ(log.measurements.size(), 3U);
  EXPECT_EQ(std::get<WheelTicks>(log.measurements[1].reading).right, 8);
  const auto& speeds = std::get<WheelSpeeds>(log.measurements[2].reading);
  EXPECT_EQ(speeds.left, 1.5);
  EXPECT_EQ(speeds.right, 1.5);
  EXPECT_EQ(speeds.yaw_rate, 0.25);
}

TEST(RawlogTraps, ImpossibleRangesAreRefusedByReason) {
  auto ranges = rangesAt(stampToMrpt(at(0)), {0.0F, std::numeric_limits<float>::quiet_NaN(), 31.0F, 29.0F});
  ranges->maxSensorDistance = 30.0F;
  CObservationBeaconRanges::TMeasurement unknown;
  unknown.sensedDistance = 3.0F;
  ranges->sensedData.push_back(unknown);
  const auto log = readBack({ranges});
  ASSERT_EQ(log.measurements.size(), 1U);
  EXPECT_EQ(std::get<BeaconRange>(log.measurements[0].reading).anchor, 4);
  EXPECT_EQ(log.tally.refused.size(), 4U);
  EXPECT_EQ(log.tally.refused.at("range above the sensor's stated maximum"), 1U);
  EXPECT_EQ(log.tally.refused.at("range without an anchor's number"), 1U);
}

TEST(RawlogTraps, ALeftToRightScanTurnsClockwiseAndLongBeamsAreInvalid) {
  auto scan = scanAt(0);
  scan->aperture = 2.0F;
  scan->rightToLeft = false;
  scan->maxRange = 6.0F;
  scan->setScanRange(1, 7.0F);
  const auto log = readBack({scan});
  const auto& reading = std::get<Scan2D>(log.measurements.at(0).reading);
  EXPECT_DOUBLE_EQ(reading.angle_first, 1.0);
  EXPECT_DOUBLE_EQ(reading.angle_step, -1.0);
  EXPECT_EQ(reading.valid, (std::vector<std::uint8_t>{1, 0, 1}));
}

TEST(RawlogTraps, GpsHeightIsAboveTheEllipsoidAndQualityIsTranslated) {
  auto gps = observed<CObservationGPS>(0, "rtk");
  gnss::Message_NMEA_GGA gga;
  gga.fields.latitude_degrees = 45.0;
  gga.fields.longitude_degrees = -3.0;
  gga.fields.altitude_meters = 100.0;
  gga.fields.geoidal_distance = 48.5;
  gga.fields.fix_quality = 4;
  gga.fields.HDOP = 2.0F;
  gga.fields.thereis_HDOP = true;
  gps->setMsg(gga);
  const auto log = readBack({gps, observed<CObservationGPS>(1, "rtk")});
  const auto& fix = std::get<GnssFix>(log.measurements.at(0).reading);
  EXPECT_NEAR(fix.latitude, 0.25 * kPi, 1e-15);
  EXPECT_EQ(fix.altitude, 148.5);
  EXPECT_EQ(fix.quality, GnssFix::Quality::RtkFixed);
  EXPECT_NEAR(fix.covariance_enu(0, 0), 0.03 * 0.03, 1e-12);
  EXPECT_EQ(log.tally.skipped.at("mrpt::obs::CObservationGPS without a GGA message"), 1U);
}

TEST(RawlogTraps, ObservationsWithoutMeasurementAreCountedByClass) {
  const auto log = readBack({observed<CObservationBearingRange>(0), observed<CObservationBearingRange>(1)});
  EXPECT_TRUE(log.measurements.empty());
  EXPECT_EQ(log.tally.skipped.at("mrpt::obs::CObservationBearingRange"), 2U);
}

TEST(RawlogTraps, CorruptClassNamesArePrintedSafely) {
  EXPECT_EQ(messageOf("==== MRPT exception ====\nMessage:  class 'C\xC3\x1B[2J' is bad\nLocation: x.cpp"),
            "class 'C??[2J' is bad");
  EXPECT_EQ(sanitised(std::string(500, 'a'), 10), "aaaaaaaaaa...");
}

}  // namespace
}  // namespace pos::io
