#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "complaint.hpp"
#include "pos/core/angle.hpp"
#include "pos/io/map_yaml.hpp"

namespace pos::io {
namespace {

using pos::test::complaintOf;
using testing::HasSubstr;

class MapYaml : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("MapYaml") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    file_ = folder_ / "map.yaml";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& text) { std::ofstream(file_) << text; }

  /// A loader that gives two cells and remembers what it was asked for.
  GridLoader loader() {
    return [this](const std::filesystem::path& path) {
      asked_ = path;
      return map::OccupancyGrid{.T_map_grid = {1.0, 0.0, 0.0},
                                .x_min = 0.0,
                                .y_min = 0.0,
                                .resolution = 0.5,
                                .columns = 2,
                                .rows = 1,
                                .occupancy = {0, 100}};
    };
  }
  map::TunnelMap load(const std::string& text) {
    write(text);
    return loadMap(file_, folder_ / "share", loader());
  }
  Complaint refusal(const std::string& text) {
    return complaintOf([&] { return load(text); });
  }

  std::filesystem::path folder_;
  std::filesystem::path file_;
  std::filesystem::path asked_;
};

TEST_F(MapYaml, EveryKeyReachesItsMember) {
  const map::TunnelMap map = load(
      "schema: 1\nname: mine\norigin: {latitude_deg: 50, longitude_deg: -8.5, altitude_m: 200, "
      "grid_rotation_deg: 2}\nanchors:\n  - {id: 3, name: A3, x_m: 1, y_m: 2, z_m: -3, survey_sigma_m: 0.05, "
      "range_bias_m: 0.2}\n  - {id: -1, x_m: 0, y_m: 0, z_m: 0}\n");
  EXPECT_EQ(map.name, "mine");
  EXPECT_DOUBLE_EQ(map.origin->latitude, radians(50.0));
  EXPECT_DOUBLE_EQ(map.origin->longitude, radians(-8.5));
  EXPECT_EQ(map.origin->altitude, 200.0);
  EXPECT_DOUBLE_EQ(map.origin->grid_rotation, radians(2.0));
  ASSERT_EQ(map.anchors.size(), 2u);
  EXPECT_EQ(map.anchors[0], (map::Anchor{3, "A3", {1.0, 2.0, -3.0}, 0.05, 0.2}));
  EXPECT_EQ(map.anchors[1].id, -1);
  EXPECT_FALSE(map.grid);
}

TEST_F(MapYaml, GridIsLoadedFromTheMapsFolderAndPlaced) {
  std::ofstream(folder_ / "cells.yaml") << "x";
  const map::TunnelMap map =
      load("schema: 1\nname: m\ngrid: {file: cells.yaml, x_m: 2, y_m: 4, yaw_deg: 90}\n");
  EXPECT_EQ(asked_, folder_ / "cells.yaml");
  ASSERT_TRUE(map.grid);
  EXPECT_NEAR(map.grid->T_map_grid.x, 2.0, 1e-12) << "the grid's own (1, 0), turned by 90 deg, is (0, 1)";
  EXPECT_NEAR(map.grid->T_map_grid.y, 5.0, 1e-12);
  EXPECT_DOUBLE_EQ(map.grid->T_map_grid.yaw, kPi / 2);
}

TEST_F(MapYaml, GridMayComeFromTheShare) {
  std::filesystem::create_directories(folder_ / "share" / "datasets");
  std::ofstream(folder_ / "share" / "datasets" / "g.gz") << "x";
  load("schema: 1\nname: m\ngrid: {file: 'mrpt-common:datasets/g.gz'}\n");
  EXPECT_EQ(asked_, folder_ / "share" / "datasets" / "g.gz");
}

TEST_F(MapYaml, MissingGridFileIsReportedAtItsKey) {
  std::ofstream(folder_ / "cells.yaml") << "x";
  const Complaint complaint = refusal("schema: 1\nname: m\ngrid:\n  file: cels.yaml\n");
  EXPECT_EQ(complaint.what, "the file does not exist");
  EXPECT_EQ(complaint.key, "grid.file");
  EXPECT_EQ(toString(complaint.place), file_.string() + ":4:9");
  EXPECT_EQ(complaint.suggestion, "did you mean cells.yaml?");
}

TEST_F(MapYaml, DuplicateAnchorNamesBothLines) {
  const Complaint complaint = refusal(
      "schema: 1\nname: m\nanchors:\n  - {id: 1, x_m: 0, y_m: 0, z_m: 0}\n  - {id: 2, x_m: 0, y_m: 0, z_m: "
      "0}\n"
      "  - {id: 1, x_m: 9, y_m: 0, z_m: 0}\n");
  EXPECT_EQ(complaint.what, "two anchors have the same id");
  EXPECT_EQ(complaint.key, "anchors[2].id");
  EXPECT_EQ(toString(complaint.place), file_.string() + ":6:10");
  EXPECT_EQ(complaint.suggestion,
            "the first is at " + file_.string() + ":4:10; give one of the two its own id");
}

TEST_F(MapYaml, BadKeysAreRefused) {
  EXPECT_EQ(refusal("schema: 1\nname: m\nanchors: [{id: 1, x_cm: 0, y_m: 0, z_m: 0}]\n").suggestion,
            "wrong unit: use x_m");
  EXPECT_EQ(refusal("schema: 1\nname: m\nanchors: [{id: 1, x_m: 0, y_m: 0}]\n").key, "anchors[0].z_m");
  EXPECT_EQ(refusal("schema: 1\nname: m\nanchor: []\n").suggestion, "did you mean anchors?");
  EXPECT_EQ(
      refusal("schema: 1\nname: m\norigin: {latitude_deg: 95, longitude_deg: 0, altitude_m: 0}\n").expected,
      "a number in deg, -90 to 90");
}

TEST_F(MapYaml, SavedMapLoadsBackEqual) {
  std::ofstream(folder_ / "cells.yaml") << "x";
  const map::TunnelMap map = load(
      "schema: 1\nname: 'north field'\norigin: {latitude_deg: 50.123456789, longitude_deg: 8, altitude_m: "
      "200}\n"
      "anchors: [{id: 1, name: '12', x_m: 0.1, y_m: 1e-9, z_m: 123456.789}, {id: 2, x_m: 0, y_m: 0, z_m: "
      "0}]\n");
  saveMap(map, file_);
  const map::TunnelMap back = loadMap(file_, "", loader());
  EXPECT_EQ(back.name, map.name);
  EXPECT_EQ(back.origin, map.origin);
  EXPECT_EQ(back.anchors, map.anchors);
}

TEST_F(MapYaml, MapWithGridNeedsTheGridsFile) {
  map::TunnelMap map{.name = "m", .origin = {}, .anchors = {}, .grid = loader()("x")};
  map.grid->T_map_grid = {3.0, 4.0, 0.5};
  EXPECT_EQ(complaintOf([&] { return mapYaml(map); }).what,
            "the map has a grid, but no file is named for it");
  const YamlDocument document = parseYaml(mapYaml(map, "cells.yaml"), "map.yaml");
  const MapFile file = readOptions(document, mapOptions());
  EXPECT_EQ(file.grid, (GridReference{"cells.yaml", {3.0, 4.0, 0.5}}));
  map.grid.reset();
  EXPECT_EQ(complaintOf([&] { return mapYaml(map, "cells.yaml"); }).what,
            "a grid file is named for a map without grid");
}

TEST_F(MapYaml, UnwritableFileIsReported) {
  const map::TunnelMap map{.name = "m", .origin = {}, .anchors = {}, .grid = {}};
  EXPECT_EQ(complaintOf([&] { return (saveMap(map, folder_ / "no" / "map.yaml"), 0); }).what,
            "the map cannot be written");
}

}  // namespace
}  // namespace pos::io
