#include "pos/core/measurement.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace pos {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string fault(const Reading& reading) {
  return defect({Stamp{}, "sensor", reading}).value_or("none");
}

const Matrix<3, 3> kNotSymmetric = (Matrix<3, 3>() << 1, 0.5, 0, 0, 1, 0, 0, 0, 1).finished();
const Matrix<3, 3> kNegative = Vector<3>(1.0, 1.0, -0.1).asDiagonal();
const Matrix<3, 3> kGood = Vector<3>(0.01, 0.0, 0.04).asDiagonal();

Scan2D goodScan() {
  return {.angle_first = -1.0, .angle_step = 0.5, .range_max = 80.0, .ranges = {1.0F, 2.0F}, .valid = {1, 1}};
}

}  // namespace

TEST(Reading, NamesFollowTheVariant) {
  ASSERT_EQ(readingNames().size(), std::variant_size_v<Reading>);
  EXPECT_EQ(readingName(OdometryIncrement{}), "odometry");
  EXPECT_EQ(readingName(WheelSpeeds{}), "wheel_speeds");
  EXPECT_EQ(readingName(WheelTicks{}), "wheel_ticks");
  EXPECT_EQ(readingName(ImuSample{}), "imu");
  EXPECT_EQ(readingName(BeaconRange{}), "range");
  EXPECT_EQ(readingName(GnssFix{}), "gnss");
  EXPECT_EQ(readingName(Scan2D{}), "scan");
  EXPECT_EQ(readingName(PoseTruth{}), "truth");
  EXPECT_EQ(readingName(PassageFix{}), "passage");
}

TEST(Defect, SoundReadingsOfEveryKindHaveNone) {
  EXPECT_EQ(fault(OdometryIncrement{{0.1, 0.0, 0.01}, durationFromSeconds(0.1), kGood}), "none");
  EXPECT_EQ(fault(OdometryIncrement{}), "none");
  EXPECT_EQ(fault(WheelSpeeds{1.0, -1.0, 0.2}), "none");
  EXPECT_EQ(fault(WheelTicks{-5, 7}), "none");
  EXPECT_EQ(fault(ImuSample{}), "none");
  EXPECT_EQ(fault(ImuSample{.kind = ImuSample::Kind::Increments, .interval = durationFromSeconds(0.01)}),
            "none");
  EXPECT_EQ(fault(BeaconRange{.range = 12.0, .sigma = 0.1, .tag_body = Eigen::Vector3d(0.2, 0, 1)}), "none");
  EXPECT_EQ(fault(GnssFix{.latitude = 0.6, .longitude = -1.9, .altitude = 120.0, .covariance_enu = kGood}),
            "none");
  EXPECT_EQ(fault(goodScan()), "none");
  EXPECT_EQ(fault(PoseTruth{}), "none");
  EXPECT_EQ(fault(PassageFix{.place = "chamber 3", .covariance = kGood, .yaw = 1.0}), "none");
}

TEST(Defect, OdometryThatIsNoNumberOrHasABadCovariance) {
  EXPECT_EQ(fault(OdometryIncrement{.increment = {kNaN, 0.0, 0.0}}),
            "odometry increment is not a finite number");
  EXPECT_EQ(fault(OdometryIncrement{.increment = {0.0, kInfinity, 0.0}}),
            "odometry increment is not a finite number");
  EXPECT_EQ(fault(OdometryIncrement{.increment = {0.0, 0.0, kNaN}}),
            "odometry increment is not a finite number");
  for (const Matrix<3, 3>& bad : {kNotSymmetric, kNegative, Matrix<3, 3>((kNaN * kGood).eval())}) {
    EXPECT_EQ(fault(OdometryIncrement{.covariance = bad}),
              "odometry covariance is not positive semi-definite");
  }
}

TEST(Defect, WheelSpeedOrYawRateThatIsNoNumber) {
  EXPECT_EQ(fault(WheelSpeeds{kNaN, 0.0, {}}), "wheel speed is not a finite number");
  EXPECT_EQ(fault(WheelSpeeds{0.0, kInfinity, {}}), "wheel speed is not a finite number");
  EXPECT_EQ(fault(WheelSpeeds{0.0, 0.0, kNaN}), "yaw rate is not a finite number");
}

TEST(Defect, ImuThatIsNoNumberOrLacksItsInterval) {
  EXPECT_EQ(fault(ImuSample{.angular = {0.0, kNaN, 0.0}}), "IMU reading is not a finite number");
  EXPECT_EQ(fault(ImuSample{.linear = {0.0, 0.0, kInfinity}}), "IMU reading is not a finite number");
  EXPECT_EQ(fault(ImuSample{.kind = ImuSample::Kind::Increments}), "IMU increments without their interval");
}

TEST(Defect, RangeThatIsNoNumberOrNotPositive) {
  EXPECT_EQ(fault(BeaconRange{.range = kNaN}), "range is not a finite number");
  EXPECT_EQ(fault(BeaconRange{.range = 0.0}), "range is zero or negative");
  EXPECT_EQ(fault(BeaconRange{.range = -1.0}), "range is zero or negative");
  for (const double bad : {0.0, -0.1, kNaN, kInfinity}) {
    EXPECT_EQ(fault(BeaconRange{.range = 1.0, .sigma = bad}), "range sigma is not a positive number") << bad;
  }
  EXPECT_EQ(fault(BeaconRange{.range = 1.0, .tag_body = Eigen::Vector3d(0, kNaN, 0)}),
            "tag position is not a finite number");
}

TEST(Defect, FixThatIsNoNumberOrNotOnTheEarth) {
  EXPECT_EQ(fault(GnssFix{.latitude = kNaN}), "fix is not a finite number");
  EXPECT_EQ(fault(GnssFix{.altitude = kInfinity}), "fix is not a finite number");
  EXPECT_EQ(fault(GnssFix{.latitude = 45.0}), "fix is not on the Earth");  // degrees given for radians
  EXPECT_EQ(fault(GnssFix{.latitude = -1.58}), "fix is not on the Earth");
  EXPECT_EQ(fault(GnssFix{.longitude = -7.0}), "fix is not on the Earth");
  EXPECT_EQ(fault(GnssFix{.covariance_enu = kNegative}), "fix covariance is not positive semi-definite");
}

TEST(Defect, ScanWithoutBeamsOrWithSizesThatDiffer) {
  EXPECT_EQ(fault(Scan2D{}), "scan has no beams");
  Scan2D scan = goodScan();
  scan.valid.pop_back();
  EXPECT_EQ(fault(scan), "scan has different numbers of ranges and validity marks");
}

TEST(Defect, ScanWithGeometryThatIsNoNumber) {
  for (const auto spoil :
       {+[](Scan2D& scan) { scan.angle_first = kNaN; }, +[](Scan2D& scan) { scan.angle_step = kInfinity; },
        +[](Scan2D& scan) { scan.T_body_sensor.translation.x() = kNaN; },
        +[](Scan2D& scan) { scan.T_body_sensor.rotation.x() = kNaN; }}) {
    Scan2D scan = goodScan();
    spoil(scan);
    EXPECT_EQ(fault(scan), "scan geometry is not finite");
  }
}

TEST(Defect, ScanWithABadRangeOnlyWhereItIsMarkedValid) {
  for (const float bad : {-1.0F, std::numeric_limits<float>::quiet_NaN()}) {
    Scan2D scan = goodScan();
    scan.ranges[1] = bad;
    EXPECT_EQ(fault(scan), "scan has a bad range marked valid");
    scan.valid[1] = 0;
    EXPECT_EQ(fault(scan), "none");
  }
}

TEST(Defect, TruthThatIsNoNumber) {
  EXPECT_EQ(fault(PoseTruth{{{0.0, kNaN, 0.0}, Eigen::Quaterniond::Identity()}}),
            "truth pose is not a finite number");
}

TEST(Defect, PassageThatIsNoNumberOrHasABadCovariance) {
  EXPECT_EQ(fault(PassageFix{.p_map = {kNaN, 0.0, 0.0}}), "passage position is not a finite number");
  EXPECT_EQ(fault(PassageFix{.p_body = {0.0, kNaN, 0.0}}), "passage mount is not a finite number");
  EXPECT_EQ(fault(PassageFix{.covariance = kNotSymmetric}),
            "passage covariance is not positive semi-definite");
  EXPECT_EQ(fault(PassageFix{.yaw = kNaN}), "passage heading is not a finite number");
}

}  // namespace pos
