#include "pos/io/map_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"
#include "scratch_folder.hpp"

namespace pos::io {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kMapping = R"(name: north
mine_grid: {name: g7, easting_m: 388000, northing_m: 4512000, elevation_m: 800}
stations:
  file: stations.csv
  roadway: drift
  x: {column: E, unit: m}
  y: {column: N, unit: m}
  z: {column: H, unit: cm}
  station: {column: ch, unit: m}
  arc: {column: arc, unit: deg}
  width: {value: 5.2, unit: m}
anchors:
  file: anchors.csv
  id: node
  x: {column: E, unit: m}
  y: {column: N, unit: m}
  z: {column: H, unit: m}
  survey_sigma: {column: s, unit: mm}
)";
constexpr const char* kStations =
    "drift,E,N,H,ch,arc\nA,388000,4512000,80000,100,\nA,388100,4512000,79900,200,90\n"
    "B,388050,4512000,79950,,\nA,388120,4512020,79880,,\nB,388050,4512040,79950,,\n";
constexpr const char* kAnchors = "node,E,N,H,s\n7,388010,4512002,801.5,20\n";

TEST(MapTables, StationsBecomeRoadwaysInTheMinesGrid) {
  const ScratchFolder folder;
  folder.write("stations.csv", kStations);
  folder.write("anchors.csv", kAnchors);
  const TableMap read = mapFromTables(parseTableMapping(kMapping, "m.yaml"), folder.path());
  EXPECT_EQ(read.stations, 5U);
  ASSERT_EQ(read.map.roadways.size(), 2U);
  const map::Roadway& a = read.map.roadways[0];
  EXPECT_EQ(a.id, "A");
  EXPECT_DOUBLE_EQ(a.width, 5.2);
  EXPECT_DOUBLE_EQ(a.chainage_start, 100.0);
  ASSERT_EQ(a.centreline.size(), 3U);
  EXPECT_NEAR((a.centreline[1].p_map - Eigen::Vector3d(100, 0, -1)).norm(), 0.0, 1e-9);
  EXPECT_DOUBLE_EQ(a.centreline[1].arc, radians(90.0));
  EXPECT_EQ(a.centreline[1].station, 200.0);
  EXPECT_FALSE(a.centreline[2].station.has_value());
  ASSERT_EQ(read.map.anchors.size(), 1U);
  EXPECT_EQ(read.map.anchors[0].id, 7);
  EXPECT_NEAR((read.map.anchors[0].p_map - Eigen::Vector3d(10, 2, 1.5)).norm(), 0.0, 1e-9);
  EXPECT_DOUBLE_EQ(read.map.anchors[0].survey_sigma, 0.02);
  ASSERT_EQ(read.map.junctions.size(), 1U);
  EXPECT_EQ(read.map.junctions[0].places[0].roadway, "B");
}

TEST(MapTables, BadCellsAndKeysAreToldWithTheirPlace) {
  const ScratchFolder folder;
  folder.write("anchors.csv", kAnchors);
  std::string bad = kStations;
  bad.replace(bad.find("388100"), 6, "38x100");
  folder.write("stations.csv", bad);
  const TableMapImport mapping = parseTableMapping(kMapping, "m.yaml");
  EXPECT_THAT(complaintOf<DataError>([&] { mapFromTables(mapping, folder.path()); }),
              HasSubstr("stations.csv:3:3"));
  const auto refused = [](const std::string& from, const std::string& to) {
    std::string text = kMapping;
    text.replace(text.find(from), from.size(), to);
    return complaintOf<ConfigError>([&] { parseTableMapping(text, "m.yaml"); });
  };
  EXPECT_THAT(refused("unit: cm", "unit: deg"), HasSubstr("stations.z.unit"));
  EXPECT_THAT(refused("roadway: drift", "raodway: drift"), HasSubstr("did you mean roadway"));
  EXPECT_THAT(refused("{value: 5.2, unit: m}", "{unit: m}"), HasSubstr("either a column or a value"));
}

TEST(MapTables, GridCoordinatesWithoutAGridAreRefusedWithAnOrigin) {
  const ScratchFolder folder;
  folder.write("stations.csv", kStations);
  folder.write("anchors.csv", kAnchors);
  TableMapImport mapping = parseTableMapping(kMapping, "m.yaml");
  mapping.mine_grid.reset();
  EXPECT_THAT(complaintOf<ConfigError>([&] { mapFromTables(mapping, folder.path()); }),
              HasSubstr("388000,4512000"));
}

TEST(MapTables, ARoadwayOfOneStationIsRefused) {
  const ScratchFolder folder;
  folder.write("stations.csv", std::string(kStations) + "C,388000,4512000,80000,1,\n");
  folder.write("anchors.csv", kAnchors);
  EXPECT_THAT(
      complaintOf<ConfigError>([&] { mapFromTables(parseTableMapping(kMapping, "m.yaml"), folder.path()); }),
      AllOf(HasSubstr("roadway C"), HasSubstr("stations.csv:7:1")));
}

TEST(MapTables, WhatMapFilesRefuseIsToldWithItsRow) {
  const ScratchFolder folder;
  const auto refused = [&](const std::string& stations, const std::string& anchors) {
    folder.write("stations.csv", stations);
    folder.write("anchors.csv", anchors);
    return complaintOf<ConfigError>(
        [&] { mapFromTables(parseTableMapping(kMapping, "m.yaml"), folder.path()); });
  };
  EXPECT_THAT(refused(std::string(kStations) + "B,388050,4512040,79950,,\n", kAnchors),
              AllOf(HasSubstr("two points at the same place"), HasSubstr("stations.csv:7:1")));
  EXPECT_THAT(
      refused(kStations, std::string(kAnchors) + "8,388020,4512002,801.5,20\n7,388030,4512002,801.5,20\n"),
      AllOf(HasSubstr("two anchors have the same id"), HasSubstr("anchors.csv:4:1")));
  EXPECT_THAT(refused(kStations, std::string(kAnchors) + "8,388020,4512002,801.5,2e6\n"),
              AllOf(HasSubstr("survey_sigma_m"), HasSubstr("anchors.csv:3:1")));
}

}  // namespace
}  // namespace pos::io
