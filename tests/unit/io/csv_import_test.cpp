#include "pos/io/csv_import.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "csv_import_samples.hpp"
#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"

namespace pos::io {
namespace {

using ::testing::AllOf;
using ::testing::DoubleNear;
using ::testing::HasSubstr;

constexpr double kTiny = 1e-12;

TEST(CsvImport, OdometryIsAnArcInSi) {
  const auto result = imported(mappingOf("odometry",
                                         "stamp: {column: t, unit: ms}, distance: {column: d, unit: cm}, "
                                         "heading: {column: h, unit: deg}"),
                               "t,d,h\n1500,200,90\n");
  const auto odometry = only<OdometryIncrement>(result);
  const double radius = 2.0 / (0.5 * kPi);  // quarter circle to the left
  EXPECT_NEAR(odometry.increment.x, radius, kTiny);
  EXPECT_NEAR(odometry.increment.y, radius, kTiny);
  EXPECT_NEAR(odometry.increment.yaw, 0.5 * kPi, kTiny);
  EXPECT_FALSE(odometry.interval);
  EXPECT_EQ(result.measurements[0].stamp, stampFromSeconds(1.5));
  EXPECT_EQ(result.measurements[0].sensor, "odometry");
}

TEST(CsvImport, StraightOdometryHasNoSidewaysPart) {
  const auto odometry = only<OdometryIncrement>(
      imported(mappingOf("odometry", stampColumn() +
                                         "distance: {column: d, unit: mm}, heading: {column: h, unit: mrad}, "
                                         "interval: {value: 200, unit: ms}"),
               "t,d,h\n0,-500,0\n"));
  EXPECT_DOUBLE_EQ(odometry.increment.x, -0.5);
  EXPECT_EQ(odometry.increment.y, 0.0);
  EXPECT_EQ(odometry.interval, durationFromSeconds(0.2));
}

TEST(CsvImport, OdometryPoseIsTakenAsItIs) {
  const auto odometry = only<OdometryIncrement>(imported(
      mappingOf("odometry_pose", stampColumn() + "dx: {column: x, unit: km}, dy: {column: y, unit: m}, "
                                                 "dyaw: {column: a, unit: deg}"),
      "t,x,y,a\n0,0.001,-2,-180\n"));
  EXPECT_THAT(odometry.increment.x, DoubleNear(1.0, kTiny));
  EXPECT_EQ(odometry.increment.y, -2.0);
  EXPECT_THAT(odometry.increment.yaw, DoubleNear(-kPi, kTiny));
}

TEST(CsvImport, WheelSpeedsAndTicksAreConverted) {
  const auto speeds = only<WheelSpeeds>(
      imported(mappingOf("wheel_speeds", stampColumn() +
                                             "left: {column: l, unit: km/h}, right: {column: r, unit: mm/s}, "
                                             "yaw_rate: {column: w, unit: deg/s}"),
               "t,l,r,w\n0,36,1500,180\n"));
  EXPECT_NEAR(speeds.left, 10.0, kTiny);
  EXPECT_NEAR(speeds.right, 1.5, kTiny);
  EXPECT_NEAR(*speeds.yaw_rate, kPi, kTiny);
  const auto ticks = only<WheelTicks>(
      imported(mappingOf("wheel_ticks", stampColumn() + "left: {column: l}, right: {column: r}"),
               "t,l,r\n0,-5,4294967296\n"));
  EXPECT_EQ(ticks.left, -5);
  EXPECT_EQ(ticks.right, 4294967296);
}

TEST(CsvImport, ImuRatesAndIncrementsAreConverted) {
  const auto rates = only<ImuSample>(imported(
      mappingOf("imu",
                stampColumn() +
                    "wx: {column: a, unit: deg/s}, wy: {column: b, unit: deg/h}, wz: {column: c, unit: "
                    "rad/s}, ax: {column: d, unit: g}, ay: {column: e, unit: mg}, az: {column: f, unit: "
                    "m/s^2}"),
      "t,a,b,c,d,e,f\n0,180,3600,0.5,1,1000,9.5\n"));
  EXPECT_EQ(rates.kind, ImuSample::Kind::Rates);
  EXPECT_TRUE(rates.angular.isApprox(Eigen::Vector3d(kPi, radians(1.0), 0.5), kTiny));
  EXPECT_TRUE(rates.linear.isApprox(Eigen::Vector3d(9.80665, 9.80665, 9.5), kTiny));
  const auto increments = only<ImuSample>(imported(
      mappingOf("imu_increments", stampColumn() +
                                      "dax: {column: a, unit: mrad}, day: {value: 0, unit: rad}, daz: "
                                      "{value: 0, unit: rad}, dvx: {column: b, unit: cm/s}, dvy: {value: "
                                      "0, unit: m/s}, dvz: {value: 0, unit: m/s}, interval: {column: i, "
                                      "unit: us}"),
      "t,a,b,i\n0,2,3,5000\n"));
  EXPECT_EQ(increments.kind, ImuSample::Kind::Increments);
  EXPECT_NEAR(increments.angular.x(), 0.002, kTiny);
  EXPECT_NEAR(increments.linear.x(), 0.03, kTiny);
  EXPECT_EQ(increments.interval, durationFromSeconds(0.005));
}

const std::string kRangeColumns =
    stampColumn() + "tag: {column: tag}, anchor: {column: anchor}, range: {column: r, unit: m}";

TEST(CsvImport, RangesTakeOptionalCellsAndTagPlaces) {
  const auto result = imported(
      mappingOf("ranges", kRangeColumns + ", sigma: {column: s, unit: cm}, rx_power: {column: p, unit: dBm}",
                "tags:\n  - {id: 3, x_m: 1, y_m: -0.5, z_m: 2}\n"),
      "t,tag,anchor,r,s,p\n0,3,7,4.5,10,-80\n1,3,7,5.5,,\n");
  ASSERT_EQ(result.measurements.size(), 2U);
  const auto& first = std::get<BeaconRange>(result.measurements[0].reading);
  EXPECT_EQ(first.tag, 3);
  EXPECT_EQ(first.anchor, 7);
  EXPECT_DOUBLE_EQ(first.range, 4.5);
  EXPECT_NEAR(*first.sigma, 0.1, kTiny);
  EXPECT_EQ(first.rx_power_dbm, -80.0);
  EXPECT_FALSE(first.first_path_power_dbm);
  EXPECT_EQ(*first.tag_body, Eigen::Vector3d(1, -0.5, 2));
  const auto& second = std::get<BeaconRange>(result.measurements[1].reading);
  EXPECT_FALSE(second.sigma || second.rx_power_dbm);
  EXPECT_EQ(result.counts.ranges_to_unknown_anchors, 2U);
}

TEST(CsvImport, RangeOfAnUnknownTagIsRefusedOnlyWhenTagsAreListed) {
  const std::string table = "t,tag,anchor,r\n0,4,7,4.5\n";
  EXPECT_FALSE(only<BeaconRange>(imported(mappingOf("ranges", kRangeColumns), table)).tag_body);
  const std::string tags = "tags:\n  - {id: 3, x_m: 1, y_m: 0, z_m: 2}\n";
  const std::string what =
      complaintOf<DataError>([&] { imported(mappingOf("ranges", kRangeColumns, tags), table); });
  EXPECT_THAT(what, AllOf(HasSubstr("a.csv:2:3"), HasSubstr("one of 3")));
}

const std::string kGnssColumns =
    stampColumn() +
    "latitude: {column: lat, unit: deg}, longitude: {column: lon, unit: deg}, altitude: {column: h, unit: "
    "m}, "
    "sigma_east: {column: s, unit: m}, sigma_north: {column: s, unit: m}, sigma_up: {value: 30, unit: cm}";

TEST(CsvImport, GnssHasRadiansCovarianceAndQuality) {
  const std::string mapping =
      "name: test\norigin_s: 0\nstreams:\n  - kind: gnss\n    file: a.csv\n    fix_codes: {-1: "
      "none, 4: rtk_fixed}\n    columns: {" +
      kGnssColumns + ", fix_status: {column: q}}\n";
  const auto fix = only<GnssFix>(imported(mapping, "t,lat,lon,h,s,q\n0,45,-90,100,0.2,4\n"));
  EXPECT_NEAR(fix.latitude, 0.25 * kPi, kTiny);
  EXPECT_NEAR(fix.longitude, -0.5 * kPi, kTiny);
  EXPECT_NEAR(fix.covariance_enu(0, 0), 0.04, kTiny);
  EXPECT_NEAR(fix.covariance_enu(2, 2), 0.09, kTiny);
  EXPECT_EQ(fix.quality, GnssFix::Quality::RtkFixed);
  const std::string what =
      complaintOf<DataError>([&] { imported(mapping, "t,lat,lon,h,s,q\n0,45,-90,100,0.2,2\n"); });
  EXPECT_THAT(what, AllOf(HasSubstr("a.csv:2:18"), HasSubstr("one of -1, 4")));
}

TEST(CsvImport, StreamsAreMergedStablyByStamp) {
  const ScratchFolder folder;
  folder.write("a.csv", "t,tag,anchor,r\n2,0,1,1\n1,0,2,1\n1,0,3,1\n");
  folder.write("b.csv", "t,l,r\n1,5,5\n0,6,6\n");
  const std::string second = "  - {kind: wheel_ticks, file: b.csv, sensor: encoder, columns: {" +
                             stampColumn() + "left: {column: l}, right: {column: r}}}\n";
  const auto result =
      importCsv(parseImportMapping(mappingOf("ranges", kRangeColumns, second), "m.yaml"), folder.path());
  std::vector<std::string> order;
  for (const Measurement& m : result.measurements) {
    const auto* range = std::get_if<BeaconRange>(&m.reading);
    order.push_back(range != nullptr ? "range " + std::to_string(range->anchor) : m.sensor);
  }
  EXPECT_THAT(order, ::testing::ElementsAre("encoder", "range 2", "range 3", "encoder", "range 1"));
  EXPECT_EQ(result.counts.tables.at(1).file, "b.csv");
  EXPECT_EQ(result.counts.tables.at(1).rows, 2U);
}

TEST(CsvImport, OriginAndShiftMoveStamps) {
  const std::string mapping =
      "name: test\norigin_s: 1700000000.25\nstreams:\n  - kind: wheel_ticks\n    file: a.csv\n"
      "    stamp_shift_s: -0.2\n    columns: {" +
      stampColumn() + "left: {column: l}, right: {column: l}}\n";
  const auto result = imported(mapping, "t,l\n0.000000001,1\n");
  EXPECT_EQ(result.measurements[0].stamp.time_since_epoch().count(), 1700000000050000001);
  EXPECT_EQ(ImportMapping{}.origin, stampFromSeconds(1.6e9));
}

TEST(CsvImport, MissingColumnListsTheColumnsFound) {
  const std::string what = complaintOf<DataError>(
      [] { imported(mappingOf("ranges", kRangeColumns), "t,tag,anchors,r\n0,1,2,3\n"); });
  EXPECT_THAT(what, AllOf(HasSubstr("a.csv"), HasSubstr("no column 'anchor'"),
                          HasSubstr("t, tag, anchors, r"), HasSubstr("did you mean 'anchors'?")));
}

TEST(CsvImport, UnusableRowIsRefusedOrSkippedAndCounted) {
  const std::string table = "t,tag,anchor,r\n0,0,1,5\n1,0,1,0\n2,0,1,nan\n3,0,1,6\n";
  EXPECT_THAT(
      complaintOf<DataError>([&] { imported(mappingOf("ranges", kRangeColumns), table); }),
      AllOf(HasSubstr("a.csv:3"), HasSubstr("range is zero or negative"), HasSubstr("bad_rows: skip")));
  const auto result = imported(mappingOf("ranges", kRangeColumns, "    bad_rows: skip\n"), table);
  EXPECT_EQ(result.measurements.size(), 2U);
  EXPECT_EQ(result.counts.tables.at(0).skipped, 2U);
  EXPECT_THAT(result.counts.tables.at(0).first_skipped, HasSubstr("a.csv:3"));
}

TEST(CsvImport, IdsThatAreNoWholeNumbersAreRefused) {
  EXPECT_THAT(complaintOf<DataError>(
                  [] { imported(mappingOf("ranges", kRangeColumns), "t,tag,anchor,r\n0,1.5,2,3\n"); }),
              AllOf(HasSubstr("a.csv:2:3"), HasSubstr("whole number")));
  EXPECT_THAT(complaintOf<DataError>([] {
                imported(mappingOf("ranges", kRangeColumns), "t,tag,anchor,r\n0,1,99999999999,3\n");
              }),
              HasSubstr("too large for an id"));
}

}  // namespace
}  // namespace pos::io
