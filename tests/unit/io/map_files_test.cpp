/// The maps of the project itself: those in maps/ are in order, and each of the broken ones is found out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "complaint.hpp"
#include "pos/io/files.hpp"
#include "pos/io/map_diff.hpp"
#include "pos/io/map_yaml.hpp"
#include "pos/map/checks.hpp"
#include "pos/map/lock_intervals.hpp"

namespace pos::io {
namespace {

namespace fs = std::filesystem;
using pos::test::complaintOf;

const fs::path kRoot = POS_SOURCE_DIR;

map::Network networkOf(const MapFile& file) {
  return map::Network(std::make_shared<const map::TunnelMap>(file.map));
}

std::vector<fs::path> siteMaps() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(kRoot / "maps")) {
    if (fs::exists(entry.path() / "map.yaml")) files.push_back(entry.path() / "map.yaml");
  }
  return files;
}

/// First line of a broken map: "# finds: gap at 50 1.5 0".
struct Expected {
  std::string check;
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
};
Expected expectedOf(const std::string& text) {
  Expected expected;
  std::string word;
  std::istringstream line(text.substr(0, text.find('\n')));
  line >> word >> word >> expected.check >> word >> expected.p_map.x() >> expected.p_map.y() >>
      expected.p_map.z();
  return expected;
}

constexpr const char* kEverything = R"(schema: 2
name: everything
mine_grid: {name: "zone 38", easting_m: 38512345.678, northing_m: 4123456.789, elevation_m: 800, rotation_deg: 12.5}
origin: {latitude_deg: 34.27, longitude_deg: 117.19, altitude_m: 35, grid_rotation_deg: 1.5, x_m: 10, y_m: 20, z_m: -1}
driving_side: left
roadways:
  - id: R1
    name: main
    level: "-320"
    width_m: 5.5
    height_m: 4
    section: arch
    lanes: 2
    speed_limit_m_per_s: 6.94
    locked: true
    chainage_start_m: 100
    centreline:
      - {x_m: 0, y_m: 0, z_m: 0, station_m: 100}
      - {x_m: 60, y_m: 0, z_m: -1, arc_deg: 33.3}
      - {x_m: 100, y_m: 10, z_m: -2}
  - id: R2
    width_m: 4
    height_m: 3
    traffic: backward_only
    centreline:
      - {x_m: 30, y_m: 0, z_m: -0.5}
      - {x_m: 30, y_m: 50, z_m: -0.5}
junctions:
  - id: J1
    name: first
    places:
      - {roadway: R1, chainage_m: 130}
      - {roadway: R2, chainage_m: 0}
crossings:
  - id: X1
    upper: {roadway: R1, chainage_m: 140}
    lower: {roadway: R2, chainage_m: 10}
bends:
  - {id: B1, name: bend, roadway: R1, from_m: 160, to_m: 200}
chambers:
  - {id: C1, roadway: R1, chainage_m: 120, name: one, side: left, kind: refuge, length_m: 6, depth_m: 3, capacity: 4, detection_sigma_m: 0.5}
anchors:
  - {id: 5, name: A5, x_m: 1.25, y_m: 2.75, z_m: 2.1, survey_sigma_m: 0.01, range_bias_m: 0.15, wall: left, survey_date: "2024-05-01", antenna_delay_s: 5.14e-07}
portals:
  - {id: P1, roadway: R1, chainage_m: 100, handover_from_m: 100, handover_to_m: 125}
lights:
  - {id: L1, roadway: R2, chainage_m: 4, side: left, controls: forward}
stop_lines:
  - {id: S1, roadway: R2, chainage_m: 3, controls: forward, light: L1}
zones:
  - {id: Z1, roadway: R1, from_m: 110, to_m: 115, kind: speed_limit, speed_limit_m_per_s: 2}
routes:
  - id: T1
    name: home
    legs:
      - {roadway: R1, from_m: 100, to_m: 130}
      - {roadway: R2, from_m: 0, to_m: 40}
requirements:
  anchors_visible: 2
  range_limit_m: 90
  vehicles:
    - {id: V1, width_m: 1.9, height_m: 1.6, length_m: 5}
background:
  file: plan.png
  control_points:
    - {column: 10, row: 20, x_m: 0, y_m: 0}
    - {column: 110, row: 20, x_m: 50, y_m: 0}
    - {column: 10, row: 220, x_m: 0, y_m: -100}
)";

}  // namespace

TEST(MapFiles, EverySiteIsInOrder) {
  const auto files = siteMaps();
  ASSERT_GE(files.size(), 8U);
  for (const fs::path& file : files) {
    for (const map::Finding& finding : map::findings(networkOf(readMapFile(file)), {})) {
      ADD_FAILURE() << file << ": " << name(finding.severity) << " " << name(finding.check) << ": "
                    << finding.what << " at " << finding.p_map.transpose();
    }
  }
}

TEST(MapFiles, EverySiteGoesThroughTheCanonicalFormUnchanged) {
  for (const fs::path& file : siteMaps()) {
    const MapFile read = readMapFile(file);
    const std::string canonical = mapText(read);
    const MapFile back = parsedMap(canonical, file);
    EXPECT_EQ(back, read) << file;
    EXPECT_EQ(mapText(back), canonical) << file;
  }
}

TEST(MapFiles, ShiftMineIsAsLargeAsItSays) {
  const map::Network network = networkOf(readMapFile(kRoot / "maps/shift_mine/map.yaml"));
  double length = 0.0;
  for (map::RoadwayIndex r = 0; r < 3; ++r) length += network.centreline(r).length();
  EXPECT_NEAR(length, 6335.0, 1.0);
  EXPECT_EQ(network.map().anchors.size(), 120U);
  EXPECT_EQ(network.map().chambers.size(), 41U);
  EXPECT_EQ(network.map().junctions.size(), 3U);
}

TEST(MapFiles, EveryBrokenMapIsFoundAtItsPlace) {
  std::set<std::string> found;
  for (const auto& entry : fs::directory_iterator(kRoot / "tests/data/broken_maps")) {
    const Expected expected = expectedOf(fileText(entry.path()));
    const auto all = map::findings(networkOf(readMapFile(entry.path())), {});
    bool there = false;
    for (const map::Finding& finding : all) {
      there =
          there || (name(finding.check) == expected.check && (finding.p_map - expected.p_map).norm() < 0.02);
      EXPECT_FALSE(finding.what.empty() || finding.remedy.empty() || finding.objects.empty());
    }
    EXPECT_TRUE(there) << entry.path() << " " << all.size()
                       << " findings, first: " << (all.empty() ? "" : all[0].what) << " at "
                       << (all.empty() ? Eigen::Vector3d::Zero() : all[0].p_map).transpose();
    EXPECT_EQ(entry.path().stem(), expected.check);
    found.insert(expected.check);
  }
  for (int check = 0; check <= static_cast<int>(map::Check::TooLow); ++check) {
    EXPECT_EQ(found.count(std::string(name(static_cast<map::Check>(check)))), 1U)
        << name(static_cast<map::Check>(check)) << " has no broken map";
  }
}

TEST(MapFiles, BrokenMapsAreBrokenInOneWayOnly) {
  for (const auto& entry : fs::directory_iterator(kRoot / "tests/data/broken_maps")) {
    const Expected expected = expectedOf(fileText(entry.path()));
    for (const map::Finding& finding : map::findings(networkOf(readMapFile(entry.path())), {})) {
      // A crossing declared upside down is also one that is not declared; reversed stations do not fit
      // either.
      const bool follows =
          (expected.check == "crossing_not_there" && finding.check == map::Check::UndeclaredCrossing) ||
          (expected.check == "reversed_chainage" && finding.check == map::Check::StationMismatch);
      EXPECT_TRUE(name(finding.check) == expected.check || follows) << entry.path() << ": " << finding.what;
    }
  }
}

TEST(MapFiles, CanonicalTextWithEveryKeyComesBackByteForByte) {
  const MapFile file = parsedMap(kEverything, "everything.yaml");
  EXPECT_EQ(mapText(file), kEverything);
  EXPECT_EQ(parsedMap(mapText(file), "again.yaml"), file);
}

TEST(MapFiles, SchemaOneIsReadAndHasNoRoadways) {
  const MapFile old =
      parsedMap("schema: 1\nname: old\nanchors: [{id: 1, x_m: 1, y_m: 2, z_m: 3}]\n", "m.yaml");
  EXPECT_EQ(old.map.anchors.size(), 1U);
  EXPECT_EQ(mapText(old), "schema: 2\nname: old\nanchors:\n  - {id: 1, x_m: 1, y_m: 2, z_m: 3}\n");
  const Complaint complaint =
      complaintOf([] { return parsedMap("schema: 1\nname: old\nroadways: []\n", "m.yaml"); });
  EXPECT_EQ(toString(complaint.place), "m.yaml:3:1");
  EXPECT_EQ(complaint.suggestion, "write schema: 2");
}

TEST(MapFiles, WhatAMapCannotBeIsRefusedAtItsLine) {
  const std::string head =
      "schema: 2\nname: m\nroadways:\n  - id: R\n    width_m: 4\n    height_m: 3\n    centreline:\n";
  const std::string line = "      - {x_m: 0, y_m: 0, z_m: 0}\n      - {x_m: 9, y_m: 0, z_m: 0}\n";
  const auto refusal = [&](const std::string& text) {
    return complaintOf([&] { return parsedMap(text, "m.yaml"); });
  };
  const Complaint twice = refusal(head + line + "      - {x_m: 9, y_m: 0, z_m: 5}\n");
  EXPECT_EQ(twice.what, "roadway R has two points at the same place in plan");
  EXPECT_EQ(toString(twice.place), "m.yaml:10:9");
  const Complaint unknown =
      refusal(head + line + "chambers:\n  - {id: C, roadway: Q, chainage_m: 3, side: left, length_m: 5}\n");
  EXPECT_EQ(unknown.what, "there is no such roadway");
  EXPECT_EQ(unknown.key, "chambers[0].roadway");
  EXPECT_EQ(toString(unknown.place), "m.yaml:11:13");
  const Complaint light = refusal(
      head + line + "stop_lines:\n  - {id: S, roadway: R, chainage_m: 3, controls: forward, light: L}\n");
  EXPECT_EQ(light.what, "there is no such light");
  const Complaint same = refusal(head + line +
                                 "lights:\n  - {id: L, roadway: R, chainage_m: 3, controls: forward}\n"
                                 "  - {id: L, roadway: R, chainage_m: 4, controls: forward}\n");
  EXPECT_EQ(same.what, "two objects of one kind have the same id");
  EXPECT_EQ(same.place.line, 12);
  EXPECT_EQ(
      refusal(head + line + "anchors: [{id: 1, x_m: 0, y_m: 0, z_m: 0, survey_date: 2024-13-01}]\n").what,
      "anchor has a survey date that is none");
}

TEST(MapFiles, PathsFollowTheMapIntoAnotherFolder) {
  const MapFile file{.map = {.name = "m", .background = map::BackgroundImage{.file = "scans/plan.png"}},
                     .grid = GridReference{"cells.gridmap.gz", {}}};
  const MapFile there = moved(file, "/site/maps", "/site/out/new");
  EXPECT_EQ(there.grid->file, "../../maps/cells.gridmap.gz");
  EXPECT_EQ(there.map.background->file, "../../maps/scans/plan.png");
  EXPECT_EQ(moved(there, "/site/out/new", "/site/maps"), file);
  EXPECT_EQ(moved(file, "", "."), file) << "one folder by two names";
  for (const char* fixed : {"/abs/cells.gridmap.gz", "mrpt-common:datasets/cells.gridmap.gz"}) {
    const MapFile same{.map = {.name = "m"}, .grid = GridReference{fixed, {}}};
    EXPECT_EQ(moved(same, "/site/maps", "/elsewhere"), same);
  }
}

TEST(MapFiles, WhatCouldNotBeReadBackIsNotWritten) {
  MapFile file{.map = {.name = "m"}, .grid = {}};
  map::Roadway roadway;
  roadway.id = "No";
  roadway.centreline = {{.p_map = {0, 0, 0}}, {.p_map = {10, 0, 0}}};
  file.map.roadways = {roadway};
  EXPECT_THAT(checkedMapText(file), ::testing::HasSubstr("id: \"No\""))
      << "a word that other YAML readers take for false";
  file.map.roadways[0].width = 0.3;
  try {
    (void)checkedMapText(file);
    FAIL() << "map files have no roadway 0.3 m wide";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.complaint().key, "roadways[0].width_m");
    EXPECT_EQ(error.complaint().place.line, 0);
  }
}

TEST(MapDiff, EqualMapsDifferInNothing) {
  const MapFile file = parsedMap(kEverything, "a.yaml");
  EXPECT_TRUE(mapChanges(file, file).empty());
}

TEST(MapDiff, SaysWhatChangedInWords) {
  const MapFile before = parsedMap(kEverything, "a.yaml");
  MapFile after = before;
  after.map.anchors[0].p_map += Eigen::Vector3d(0.3, -0.4, 0.0);
  after.map.roadways[0].width = 5.0;
  after.map.chambers.clear();
  after.map.bends.push_back({.id = "B2", .stretch = {"R2", 1.0, 2.0}});
  after.map.mine_grid->elevation = 801.0;
  after.map.roadways[1].centreline[1].p_map.y() = 51.0;
  std::vector<std::string> words;
  for (const MapChange& change : mapChanges(before, after)) {
    if (!change.words.empty()) words.push_back(change.words);
  }
  EXPECT_THAT(words, testing::UnorderedElementsAre(
                         "anchor 5 moved by 0.500 m (+0.300, -0.400, +0.000)", "roadway R1: width_m 5.5 -> 5",
                         "chamber C1 is gone", "bend B2 is new", "mine_grid: elevation_m 800 -> 801",
                         "roadway R2: centreline: 2 entries as before, different from number 2 on"));
}

TEST(MapDiff, OrderOfObjectsDoesNotMatter) {
  const MapFile before = parsedMap(kEverything, "a.yaml");
  MapFile after = before;
  std::swap(after.map.roadways[0], after.map.roadways[1]);
  EXPECT_TRUE(mapChanges(before, after).empty());
}

}  // namespace pos::io
