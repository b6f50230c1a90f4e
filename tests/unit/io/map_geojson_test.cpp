#include "pos/io/map_geojson.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "scratch_folder.hpp"
#include "support/map_samples.hpp"

namespace pos::io {
namespace {

using ::testing::HasSubstr;

MapFile small() {
  return {.map = map::samples::smallMine(), .grid = {}};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string complaint(const std::string& text) {
  return complaintOf<ConfigError>([&] { parsedGeoJson(text, "mine.geojson"); });
}

TEST(MapGeoJson, TheSmallMineComesBackByteForByte) {
  const std::string yaml = mapText(small());
  const GeoJsonImport import = parsedGeoJson(mapGeoJson(parsedMap(yaml, "a.yaml")), "mine.geojson");
  EXPECT_EQ(mapText(import.file), yaml);
  EXPECT_EQ(import.file.map, parsedMap(yaml, "a.yaml").map);
  EXPECT_TRUE(import.remarks.empty()) << import.remarks.front();
}

TEST(MapGeoJson, RandomMapsComeBackByteForByte) {
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    RandomStream random(seed, 12);
    const MapFile file{.map = map::samples::randomMine(random), .grid = {}};
    const std::string yaml = mapText(file);
    const std::string json = mapGeoJson(file);
    const GeoJsonImport import = parsedGeoJson(json, "mine.geojson");
    ASSERT_EQ(mapText(import.file), yaml) << seed;
    ASSERT_EQ(import.file.map, file.map) << seed;
    ASSERT_EQ(mapGeoJson(import.file), json) << seed;
    EXPECT_TRUE(import.remarks.empty()) << seed << ": " << import.remarks.front();
  }
}

TEST(MapGeoJson, TheGridsFileAndTheBackgroundAreKept) {
  MapFile file = small();
  file.grid = GridReference{"cells.gridmap.gz", {1.0, 2.0, 0.1}};
  file.map.background =
      map::BackgroundImage{"scan.png", {{0, 0, -5, 100}, {800.5, 0, 75, 100}, {0, 600, -5, 40}}};
  const GeoJsonImport import = parsedGeoJson(mapGeoJson(file), "mine.geojson");
  EXPECT_EQ(import.file, file);
}

TEST(MapGeoJson, MinusZeroKeepsItsSign) {
  MapFile file = small();
  file.map.anchors[0].p_map.x() = -0.0;
  const GeoJsonImport import = parsedGeoJson(mapGeoJson(file), "mine.geojson");
  EXPECT_EQ(mapText(import.file), mapText(file));
}

TEST(MapGeoJson, RoadwaysAreLinesThroughTheirSurveyedPoints) {
  const std::string json = mapGeoJson(small());
  EXPECT_THAT(json,
              HasSubstr("\"coordinates\": [[0, 0, 0], [120, 0, -2.4], [140, 20, -2.7], [140, 100, -4.3]]"));
  EXPECT_THAT(json, HasSubstr("\"arc_deg\": [null, 90, null, null]"));
  EXPECT_THAT(json, HasSubstr("\"station_m\": [0, 120, null, 231.5]"));
}

TEST(MapGeoJson, APointWithoutChainageGetsThatOfItsPlace) {
  std::string json = mapGeoJson(small());
  json = replaced(json, "\"roadway\": \"R1\", \"chainage_m\": 30, ", "\"roadway\": \"R1\", ");
  const GeoJsonImport import = parsedGeoJson(json, "mine.geojson");
  EXPECT_NEAR(import.file.map.chambers[0].place.chainage, 30.0, 2e-3);
  ASSERT_EQ(import.remarks.size(), 1U);
  EXPECT_THAT(import.remarks[0], HasSubstr("(chamber C1)"));
}

TEST(MapGeoJson, AMovedPointIsToldAndTheChainageCounts) {
  std::string json = mapGeoJson(small());
  const std::size_t light = json.find("\"object\": \"light\"");
  const std::size_t open = json.rfind("\"coordinates\": [", light) + 16;
  json.replace(open, json.find(',', open) - open, "55");
  const GeoJsonImport import = parsedGeoJson(json, "mine.geojson");
  EXPECT_DOUBLE_EQ(import.file.map.lights[0].place.chainage, 50.0);
  ASSERT_EQ(import.remarks.size(), 1U);
  EXPECT_THAT(import.remarks[0], HasSubstr("(light L1): its point is 5.0"));
}

TEST(MapGeoJson, WhatAnEditorAddsIsTaken) {
  std::string json = mapGeoJson(small());
  json = replaced(json, "\"features\": [",
                  "\"name\": \"layer\", \"crs\": {\"type\": \"name\"}, \"features\": [");
  json = replaced(json, "\"object\": \"junction\", ", "\"object\": \"junction\", \"width_m\": null, ");
  const GeoJsonImport import = parsedGeoJson(json, "mine.geojson");
  EXPECT_EQ(import.file.map, small().map);
  EXPECT_THAT(import.remarks.at(0), HasSubstr("coordinate system"));
}

TEST(MapGeoJson, ComplaintsNameFeaturePropertyAndLine) {
  const std::string json = mapGeoJson(small());
  const std::string width = complaint(replaced(json, "\"width_m\": 6.4", "\"width_m\": -6.4"));
  EXPECT_THAT(width, HasSubstr("features[1] (roadway R1).width_m"));
  EXPECT_THAT(width, HasSubstr("mine.geojson:3:"));
  EXPECT_THAT(complaint(replaced(json, "\"detection_sigma_m\"", "\"detection_sgma_m\"")),
              HasSubstr("did you mean detection_sigma_m"));
  EXPECT_THAT(complaint(replaced(json, "\"object\": \"chamber\"", "\"object\": \"chambre\"")),
              HasSubstr("no object of a map"));
  EXPECT_THAT(complaint(replaced(json, "\"object\": \"portal\", \"id\": \"P1\", \"roadway\": \"R1\"",
                                 "\"object\": \"portal\", \"id\": \"P1\", \"roadway\": \"R9\"")),
              HasSubstr("(portal P1).roadway"));
  EXPECT_THAT(complaint(replaced(json, "[120, 0, -2.4]", "[120, \"0\", -2.4]")),
              HasSubstr("a coordinate is no number"));
  EXPECT_THAT(complaint(replaced(json, "[120, 0, -2.4]", "[120, 0]")), HasSubstr("without height"));
  EXPECT_THAT(complaint(replaced(json, "[null, 90, null, null]", "[null, 90]")), HasSubstr("a list of 4"));
  EXPECT_THAT(complaint(replaced(json, "\"object\": \"map\"", "\"object\": \"zone\"")),
              HasSubstr("map as a whole is missing"));
}

TEST(MapGeoJson, TextThatIsNoJsonIsToldWithItsPlace) {
  EXPECT_THAT(complaint("{\"type\": \"FeatureCollection\",\n \"features\": [}"),
              HasSubstr("mine.geojson:2:"));
  EXPECT_THAT(complaint("{\"type\": \"FeatureCollection\", \"type\": 1}"), HasSubstr("given twice"));
  EXPECT_THAT(complaint("[]"), HasSubstr("no JSON object"));
  EXPECT_THAT(complaint(std::string(1000, '[')), HasSubstr("nested too deep"));
  EXPECT_THAT(complaint(""), HasSubstr("no JSON"));
}

}  // namespace
}  // namespace pos::io
