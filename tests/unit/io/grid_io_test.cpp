#include "pos/io/grid_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "pos/io/beacon_map_io.hpp"
#include "rawlog_samples.hpp"

namespace pos::io {
namespace {

using map::OccupancyGrid;
constexpr auto kUnknown = OccupancyGrid::kUnknown;

OccupancyGrid smallGrid() {
  OccupancyGrid grid;
  grid.x_min = -2.0;
  grid.y_min = 1.0;
  grid.resolution = 0.5;
  grid.columns = 3;
  grid.rows = 2;
  grid.occupancy = {0, 100, kUnknown, 30, 70, 0};
  return grid;
}

template <typename Error>
std::string complaintOf(const std::string& path) {
  try {
    loadGrid(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no such complaint";
}

TEST(MrptGrid, ComesBackWithinTwoPercentAndUnknownStaysUnknown) {
  const ScratchFolder folder;
  saveMrptGrid(smallGrid(), folder.file("g.gridmap.gz"));
  const OccupancyGrid grid = loadGrid(folder.file("g.gridmap.gz"));
  EXPECT_DOUBLE_EQ(grid.x_min, -2.0);
  EXPECT_DOUBLE_EQ(grid.y_min, 1.0);
  EXPECT_DOUBLE_EQ(grid.resolution, 0.5);
  ASSERT_EQ(grid.columns, 3);
  ASSERT_EQ(grid.rows, 2);
  for (std::size_t i = 0; i < grid.occupancy.size(); ++i) {
    if (smallGrid().occupancy[i] == kUnknown) {
      EXPECT_EQ(grid.occupancy[i], kUnknown);
    } else {
      EXPECT_NEAR(grid.occupancy[i], smallGrid().occupancy[i], 2.5) << i;
    }
  }
}

TEST(MrptGrid, IsNotTurned) {
  const ScratchFolder folder;
  OccupancyGrid grid = smallGrid();
  grid.T_map_grid.yaw = 0.1;
  EXPECT_THROW(saveMrptGrid(grid, folder.file("g.gridmap.gz")), ConfigError);
}

TEST(MrptGrid, MissingForeignAndCutFilesAreExplained) {
  const ScratchFolder folder;
  EXPECT_THAT(complaintOf<DataError>(folder.file("no.gridmap")), ::testing::HasSubstr("no such file"));
  replaceContent(folder.file("t.gridmap"), "hello there");
  EXPECT_THAT(complaintOf<DataError>(folder.file("t.gridmap")), ::testing::HasSubstr("COccupancyGridMap2D"));
  map::TunnelMap anchors;
  anchors.anchors.push_back({.id = 1, .name = "a"});
  saveBeaconMap(anchors, folder.file("b.gridmap"));
  EXPECT_THAT(complaintOf<DataError>(folder.file("b.gridmap")), ::testing::HasSubstr("CBeaconMap"));
  saveMrptGrid(smallGrid(), folder.file("g.gridmap.gz"));
  const std::string whole = contentOf(folder.file("g.gridmap.gz"));
  replaceContent(folder.file("g.gridmap.gz"), whole.substr(0, whole.size() / 2));
  EXPECT_THAT(complaintOf<DataError>(folder.file("g.gridmap.gz")), ::testing::HasSubstr("cut short"));
  EXPECT_THAT(complaintOf<ConfigError>(folder.file("g.png")), ::testing::HasSubstr("ending"));
}

TEST(MrptGrid, TheUwbDemosMapLoads) {
  const std::string path = "/usr/share/mrpt/datasets/uwb_ro-localization_demo_map.gridmap.gz";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "install mrpt-common to run this test: no " << path;
  const OccupancyGrid grid = loadGrid(path);
  EXPECT_GT(grid.columns, 50);
  EXPECT_GT(grid.rows, 50);
  EXPECT_EQ(grid.occupancy.size(),
            static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
}

const std::string kRosYaml =
    "image: m.pgm\nresolution: 0.25\norigin: [-3.0, 4.0, 0.5]\nnegate: 0\noccupied_thresh: 0.65\n"
    "free_thresh: 0.196\n";

/// Top row: free, occupied; bottom row: grey, free.
const std::string kPgm = std::string("P5\n2 2\n255\n") + "\xFE" + std::string(1, '\0') + "\xCD" + "\xFF";

TEST(RosGrid, FirstImageRowIsTheTopOfTheMap) {
  const ScratchFolder folder;
  replaceContent(folder.file("m.yaml"), kRosYaml);
  replaceContent(folder.file("m.pgm"), kPgm);
  const OccupancyGrid grid = loadGrid(folder.file("m.yaml"));
  EXPECT_EQ(grid.occupancy, (std::vector<std::uint8_t>{kUnknown, 0, 0, 100}));
  EXPECT_DOUBLE_EQ(grid.T_map_grid.x, -3.0);
  EXPECT_DOUBLE_EQ(grid.T_map_grid.y, 4.0);
  EXPECT_DOUBLE_EQ(grid.T_map_grid.yaw, 0.5);
  EXPECT_DOUBLE_EQ(grid.resolution, 0.25);
}

TEST(RosGrid, WrongKeysAreNamedWithTheirPlace) {
  const ScratchFolder folder;
  const std::string path = folder.file("m.yaml");
  replaceContent(path, kRosYaml + "resolutoin: 1\n");
  EXPECT_THAT(complaintOf<ConfigError>(path), ::testing::HasSubstr("m.yaml:7:1"));
  replaceContent(path, "image: m.pgm\n");
  EXPECT_THAT(complaintOf<ConfigError>(path), ::testing::HasSubstr("resolution"));
  std::string bad = kRosYaml;
  bad.replace(bad.find("0.25"), 4, "-0.25");
  replaceContent(path, bad);
  EXPECT_THAT(complaintOf<ConfigError>(path), ::testing::HasSubstr("positive"));
  replaceContent(path, "a: [1, 2\n");
  EXPECT_THAT(complaintOf<ConfigError>(path), ::testing::HasSubstr("no YAML"));
}

TEST(RosGrid, AMissingImageIsNamed) {
  const ScratchFolder folder;
  replaceContent(folder.file("m.yaml"), kRosYaml);
  EXPECT_THAT(complaintOf<DataError>(folder.file("m.yaml")), ::testing::HasSubstr("m.pgm"));
}

TEST(BeaconMap, AnchorsComeBack) {
  const ScratchFolder folder;
  map::TunnelMap map;
  map.anchors.push_back({.id = 7, .name = "A7", .p_map = {1.5, -2.5, 3.25}, .survey_sigma = 0.05});
  map.anchors.push_back({.id = -3, .name = "", .p_map = {1e4, 2e4, -500.0}, .survey_sigma = 0.0});
  saveBeaconMap(map, folder.file("m.beaconmap"));
  const auto anchors = loadBeaconMap(folder.file("m.beaconmap"));
  ASSERT_EQ(anchors.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(anchors[i].id, map.anchors[i].id);
    EXPECT_LT((anchors[i].p_map - map.anchors[i].p_map).norm(), 1e-3);
    EXPECT_NEAR(anchors[i].survey_sigma, map.anchors[i].survey_sigma, 1e-9);
  }
}

TEST(BeaconMap, NothingToWriteAndNowhereToWriteAreExplained) {
  const ScratchFolder folder;
  EXPECT_THROW(saveBeaconMap({}, folder.file("m.beaconmap")), ConfigError);
  map::TunnelMap map;
  map.anchors.push_back({.id = 7, .name = "A7"});
  EXPECT_THROW(saveBeaconMap(map, folder.file("no/such/m.beaconmap")), DataError);
  EXPECT_THROW(loadBeaconMap(folder.file("none.beaconmap")), DataError);
}

}  // namespace
}  // namespace pos::io
