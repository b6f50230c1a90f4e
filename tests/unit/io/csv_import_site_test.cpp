// Truth and anchors of an import.
#include <gmock/gmock.h>

#include "csv_import_samples.hpp"
#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"

namespace pos::io {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kTiny = 1e-12;

const std::string kSomeStream =
    mappingOf("wheel_ticks", stampColumn() + "left: {value: 1}, right: {value: 1}");
ImportResult importedTruth(const std::string& columns, const std::string& table) {
  const ScratchFolder folder;
  folder.write("a.csv", "t\n0\n");
  folder.write("truth.csv", table);
  return importCsv(
      parseImportMapping(kSomeStream + "truth: {file: truth.csv, columns: {" + stampColumn() +
                             "x: {column: x, unit: m}, y: {column: y, unit: m}" + columns + "}}\n",
                         "m.yaml"),
      folder.path());
}

TEST(CsvImport, TruthSaysWhatItDoesNotHave) {
  const Truth flat = *importedTruth("", "t,x,y\n0,1,2\n1,3,4\n").truth;
  EXPECT_FALSE(flat.has_z || flat.has_yaw);
  EXPECT_EQ(flat.poses.at(1).T_map_body.translation, Eigen::Vector3d(3, 4, 0));
  const Truth full =
      *importedTruth(", z: {column: z, unit: cm}, yaw: {column: h, unit: deg}", "t,x,y,z,h\n0,1,2,300,-244\n")
           .truth;
  EXPECT_TRUE(full.has_z && full.has_yaw);
  EXPECT_NEAR(full.poses.at(0).T_map_body.yaw(), radians(116.0), kTiny);
  EXPECT_NEAR(full.poses.at(0).T_map_body.translation.z(), 3.0, kTiny);
}

TEST(CsvImport, TruthTakesAQuaternion) {
  const std::string columns = ", qw: {column: w}, qx: {column: a}, qy: {column: b}, qz: {column: c}";
  const Truth truth = *importedTruth(columns, "t,x,y,w,a,b,c\n0,1,2,0.7071,0,0,0.7071\n").truth;
  EXPECT_NEAR(truth.poses.at(0).T_map_body.yaw(), 0.5 * kPi, 1e-9);
  EXPECT_THAT(complaintOf<DataError>([&] { importedTruth(columns, "t,x,y,w,a,b,c\n0,1,2,0.5,0,0,0\n"); }),
              HasSubstr("the quaternion does not have length 1"));
}

TEST(CsvImport, TruthThatDoesNotIncreaseIsRefused) {
  EXPECT_THAT(complaintOf<DataError>([] { importedTruth("", "t,x,y\n0,1,2\n0,3,4\n"); }),
              AllOf(HasSubstr("truth.csv:3:1"), HasSubstr("do not increase")));
}

TEST(CsvImport, AnchorsComeFromATableOrAList) {
  const ScratchFolder folder;
  folder.write("a.csv", "t\n0\n");
  folder.write("anchors.csv", "n,x,y,b\n5,1,2,30\n6,3,4,0\n");
  const auto table = importCsv(
      parseImportMapping(
          kSomeStream + "anchors: {file: anchors.csv, columns: {id: {column: n}, x: {column: x, unit: m}, "
                        "y: {column: y, unit: m}, z: {value: 150, unit: cm}, range_bias: {column: b, "
                        "unit: cm}}}\n",
          "m.yaml"),
      folder.path());
  ASSERT_EQ(table.map.anchors.size(), 2U);
  EXPECT_EQ(table.map.findAnchor(6)->p_map, Eigen::Vector3d(3, 4, 1.5));
  EXPECT_NEAR(table.map.findAnchor(5)->range_bias, 0.3, kTiny);
  const auto list =
      importCsv(parseImportMapping(kSomeStream + "anchors:\n  - {id: 5, x_m: 1, y_m: 2, z_m: 3}\n", "m.yaml"),
                folder.path());
  EXPECT_EQ(list.map.findAnchor(5)->p_map, Eigen::Vector3d(1, 2, 3));
}

TEST(CsvImport, TwoAnchorsOrTagsOfOneIdAreRefused) {
  const std::string two = ":\n  - {id: 5, x_m: 1, y_m: 2, z_m: 3}\n  - {id: 5, x_m: 1, y_m: 2, z_m: 3}\n";
  EXPECT_THAT(complaintOf<ConfigError>([&] { imported(kSomeStream + "anchors" + two, "t\n0\n"); }),
              HasSubstr("same id"));
  EXPECT_THAT(complaintOf<DataError>([&] { imported(kSomeStream + "tags" + two, "t\n0\n"); }),
              HasSubstr("two tags"));
}

TEST(CsvImport, AFolderInTheFormatOfEurocIsReadAsItIs) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.path() / "imu0");
  std::filesystem::create_directories(folder.path() / "state_groundtruth_estimate0");
  folder.write("imu0/data.csv",
               "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
               "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\r\n"
               "1403636579758555392,-0.099,0.147,0.028,8.17,-0.37,-2.43\r\n");
  folder.write("state_groundtruth_estimate0/data.csv",
               "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
               "q_RS_z []\n1403636580838555648,4.688,-1.786,0.783,0.6,0,-0.8,0\n");
  const auto mapping = readImportMapping(POS_SOURCE_DIR "/configs/import/euroc.yaml");
  const auto result = importCsv(mapping, folder.path());
  const auto imu = only<ImuSample>(result);
  EXPECT_EQ(imu.angular, Eigen::Vector3d(-0.099, 0.147, 0.028));
  EXPECT_EQ(imu.linear, Eigen::Vector3d(8.17, -0.37, -2.43));
  EXPECT_EQ(result.measurements[0].stamp.time_since_epoch().count(), 1403636579758555392);
  ASSERT_TRUE(result.truth);
  EXPECT_EQ(result.truth->poses[0].T_map_body.translation, Eigen::Vector3d(4.688, -1.786, 0.783));
  EXPECT_NEAR(result.truth->poses[0].T_map_body.rotation.y(), -0.8, 1e-12);
}

TEST(CsvImport, ACommentedHeaderHasToBeOne) {
  EXPECT_THAT(complaintOf<DataError>([] {
                imported(
                    "name: test\norigin_s: 0\nstreams:\n  - kind: odometry\n    file: a.csv\n"
                    "    header: commented\n    columns: {" +
                        stampColumn() + "distance: {column: d, unit: m}, heading: {column: h, unit: rad}}\n",
                    "t,d,h\n0,1,0\n");
              }),
              ::testing::HasSubstr("does not start with '#'"));
}

}  // namespace
}  // namespace pos::io
