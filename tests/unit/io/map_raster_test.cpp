#include "pos/io/map_raster.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CBeaconMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>

#include "pos/core/error.hpp"
#include "pos/estimation/mcl.hpp"
#include "pos/io/beacon_map_io.hpp"
#include "pos/io/grid_io.hpp"
#include "pos/map/centreline.hpp"
#include "scratch_folder.hpp"
#include "support/map_samples.hpp"
#include "support/mcl_scene.hpp"

namespace pos::io {
namespace {

using ::testing::HasSubstr;

map::TunnelMap straight() {
  map::TunnelMap mine;
  mine.roadways = {
      map::samples::roadway("R", {{.p_map = {0.0, 0.0, 0.0}}, {.p_map = {20.0, 0.0, 0.0}}}, 4.0)};
  return mine;
}

TEST(MapRaster, ACellIsFreeWhenItsMiddleIsInARoadway) {
  const map::TunnelMap mine = straight();
  const map::OccupancyGrid grid = rasterised(mine, {.resolution = 0.5, .margin = 1.0});
  EXPECT_DOUBLE_EQ(grid.x_min, -1.0);
  EXPECT_DOUBLE_EQ(grid.y_min, -3.0);
  ASSERT_EQ(grid.columns, 44);
  ASSERT_EQ(grid.rows, 12);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const double x = grid.x_min + 0.5 * (column + 0.5);
      const double y = grid.y_min + 0.5 * (row + 0.5);
      const bool inside = x > 0.0 && x < 20.0 && std::abs(y) < 2.0;
      EXPECT_EQ(grid.at(column, row), inside ? 0 : 100) << x << ", " << y;
    }
  }
}

TEST(MapRaster, AgreesWithTheDistanceToTheCentrelineOnABend) {
  map::TunnelMap mine;
  mine.roadways = {map::samples::roadway("R",
                                         {{.p_map = {0.0, 0.0, 0.0}},
                                          {.p_map = {30.0, 0.0, 0.0}, .arc = kPi / 2.0},
                                          {.p_map = {40.0, 10.0, 0.0}}},
                                         5.0)};
  const map::OccupancyGrid grid = rasterised(mine, {.resolution = 0.2, .margin = 1.0});
  const map::Centreline line(mine.roadways[0]);
  int wrong = 0, free = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Eigen::Vector3d p(grid.x_min + 0.2 * (column + 0.5), grid.y_min + 0.2 * (row + 0.5), 0.0);
      const map::Centreline::Foot foot = line.foot(p);
      const double depth = foot.beyond > 0.0 ? foot.beyond : std::abs(foot.offset) - 2.5;
      if (std::abs(depth) < 0.03) continue;  // the outline keeps to the arc within 0.02 m
      free += depth < 0.0 ? 1 : 0;
      wrong += (grid.at(column, row) == 0) != (depth < 0.0) ? 1 : 0;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(free, 4000);
}

TEST(MapRaster, ATightBendAndAChamberAreOpen) {
  map::TunnelMap mine;
  mine.roadways = {map::samples::roadway(  // radius 2 m, narrower than half the width
      "R",
      {{.p_map = {0.0, 0.0, 0.0}},
       {.p_map = {10.0, 0.0, 0.0}, .arc = kPi / 2.0},
       {.p_map = {12.0, 2.0, 0.0}},
       {.p_map = {12.0, 12.0, 0.0}}},
      6.0)};
  mine.chambers = {{.id = "C", .place = {"R", 4.0}, .side = map::Side::Right, .length = 3.0, .depth = 2.0}};
  const map::OccupancyGrid grid = rasterised(mine, {.resolution = 0.1});
  const auto at = [&](double x, double y) {
    return grid.at(static_cast<int>((x - grid.x_min) / 0.1), static_cast<int>((y - grid.y_min) / 0.1));
  };
  for (double y = -4.95; y < 2.9; y += 0.1) EXPECT_EQ(at(4.0, y), 0) << y;
  EXPECT_EQ(at(4.0, -5.15), 100);
  EXPECT_EQ(at(6.0, -4.0), 100);
  for (double s = -2.5; s < 2.5; s += 0.1) EXPECT_EQ(at(11.4 + 0.7 * s, 0.6 - 0.7 * s), 0) << s;
}

TEST(MapRaster, LimitsAndEmptyMapsAreExplained) {
  EXPECT_THAT(complaintOf<ConfigError>([] { rasterised(map::TunnelMap{}, {}); }), HasSubstr("no roadways"));
  EXPECT_THAT(complaintOf<ConfigError>([] { rasterised(map::samples::longMine(), {.resolution = 0.1}); }),
              HasSubstr("use cells of 0."));
  EXPECT_THROW(rasterised(straight(), {.resolution = 0.0}), ConfigError);
  EXPECT_THAT(complaintOf<ConfigError>([] { rasterised(straight(), {.level = "7"}); }), HasSubstr("level"));
}

TEST(MapRaster, RosFilesComeBack) {
  const ScratchFolder folder;
  const map::OccupancyGrid grid = rasterised(map::samples::smallMine(), {.resolution = 0.25, .margin = 1.5});
  saveRosGrid(grid, folder.path() / "mine.yaml");
  const map::OccupancyGrid back = loadGrid(folder.path() / "mine.yaml");
  EXPECT_EQ(back.occupancy, grid.occupancy);
  EXPECT_DOUBLE_EQ(back.T_map_grid.x, grid.x_min);
  EXPECT_DOUBLE_EQ(back.T_map_grid.y, grid.y_min);
  EXPECT_DOUBLE_EQ(back.resolution, 0.25);
}

TEST(MapRaster, MrptsOwnClassesLoadGridAndBeacons) {
  const ScratchFolder folder;
  const map::TunnelMap mine = map::samples::smallMine();
  const map::OccupancyGrid grid = rasterised(mine, {.resolution = 0.25});
  saveMrptGrid(grid, folder.path() / "mine.gridmap.gz");
  saveBeaconMap(mine, folder.path() / "mine.beaconmap");
  mrpt::maps::COccupancyGridMap2D loaded;
  {
    mrpt::io::CFileGZInputStream stream((folder.path() / "mine.gridmap.gz").string());
    auto archive = mrpt::serialization::archiveFrom(stream);
    archive >> loaded;
  }
  ASSERT_EQ(static_cast<int>(loaded.getSizeX()), grid.columns);
  ASSERT_EQ(static_cast<int>(loaded.getSizeY()), grid.rows);
  EXPECT_GT(loaded.getPos(50.0F, 0.0F), 0.9F);   // on the centreline: free
  EXPECT_LT(loaded.getPos(50.0F, 10.0F), 0.1F);  // in the rock
  mrpt::maps::CBeaconMap beacons;
  mrpt::io::CFileGZInputStream stream((folder.path() / "mine.beaconmap").string());
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive >> beacons;
  ASSERT_EQ(beacons.size(), mine.anchors.size());
  EXPECT_EQ(beacons[1].m_ID, 12);
  EXPECT_FLOAT_EQ(static_cast<float>(beacons[1].m_locationGauss.mean.x()), 55.5F);
}

/// A drive through the exported maps: grid and anchors are what came back from MRPT's files.
TEST(MapRaster, ExportedGridAndBeaconsDriveTheParticleFilter) {
  const ScratchFolder folder;
  map::TunnelMap mine = map::samples::smallMine();
  mine.anchors.clear();
  for (int k = 0; k < 6; ++k)
    mine.anchors.push_back(
        {.id = k + 1, .p_map = {20.0 * k, k % 2 == 0 ? 3.1 : -3.1, 1.1}, .survey_sigma = 0.02});
  const map::OccupancyGrid rock = rasterised(mine, {.resolution = 0.1});
  saveMrptGrid(rock, folder.path() / "m.gridmap.gz");
  saveBeaconMap(mine, folder.path() / "m.beaconmap");
  map::TunnelMap loaded;
  loaded.grid = loadMrptGrid(folder.path() / "m.gridmap.gz");
  loaded.anchors = loadBeaconMap(folder.path() / "m.beaconmap");

  namespace scene = estimation::scene;
  Pose2 truth{8.0, 0.5, 0.0};
  estimation::MclConfig config;
  config.start = {
      .mode = estimation::StartMode::Known, .pose = truth, .position_sigma = 0.5, .yaw_sigma = 0.1};
  config.range.sigma = 0.15;
  config.range.range_max = 60.0;
  config.particles = {.min = 1000, .max = 3000};
  estimation::Mcl mcl(config, std::make_shared<const map::TunnelMap>(loaded));
  RandomStream random(3, 5);
  Stamp stamp = stampFromSeconds(10.0);
  const Pose2 step{0.5, 0.0, 0.0};
  const estimation::OdometryNoise noise;
  double worst = 0.0;
  for (int k = 0; k < 160; ++k) {
    stamp += durationFromSeconds(0.25);
    truth = truth * step;
    (void)mcl.ingest({stamp, "odometry", scene::noisyOdometry(step, noise, 0.25, random)});
    for (const map::Anchor& anchor : loaded.anchors) {
      const BeaconRange range = scene::rangeTo(anchor, truth, random.normal(0.0, 0.15));
      if (range.range < 60.0) (void)mcl.ingest({stamp, "uwb", range});
    }
    if (k % 4 == 0) (void)mcl.ingest({stamp, "scan", scene::scanFrom(rock, truth, 0.03, random)});
    const auto estimate = mcl.estimateAt(stamp);
    ASSERT_TRUE(estimate.has_value());
    if (k > 20)
      worst = std::max(worst, (estimate->T_map_body.planar().translation() - truth.translation()).norm());
  }
  EXPECT_LT(worst, 0.4);
}

}  // namespace
}  // namespace pos::io
