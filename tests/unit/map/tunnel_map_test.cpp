#include "pos/map/tunnel_map.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "pos/core/error.hpp"

namespace pos::map {
namespace {

TunnelMap threeAnchors() {
  return {.name = "drift", .anchors = {{.id = 7}, {.id = -2}, {.id = 100}}, .grid = {}};
}

OccupancyGrid grid2x3() {
  return {.columns = 2, .rows = 3, .occupancy = {0, 1, 10, 11, 100, OccupancyGrid::kUnknown}};
}

/// The complaint of a map that must be refused.
Complaint refusal(const TunnelMap& map) {
  try {
    validated(map);
  } catch (const ConfigError& error) {
    return error.complaint();
  }
  return {.what = "nothing was thrown"};
}

}  // namespace

TEST(TunnelMap, FindsAnAnchorByItsIdAndNoOther) {
  const TunnelMap map = threeAnchors();
  EXPECT_EQ(map.findAnchor(-2), &map.anchors[1]);
  EXPECT_EQ(map.findAnchor(100), &map.anchors[2]);
  EXPECT_EQ(map.findAnchor(8), nullptr);
  EXPECT_EQ(TunnelMap{}.findAnchor(0), nullptr);
}

TEST(TunnelMap, SoundMapComesBackAsItIs) {
  TunnelMap map = threeAnchors();
  map.grid = grid2x3();
  const TunnelMap same = validated(map);
  EXPECT_EQ(same.name, "drift");
  EXPECT_EQ(same.anchors.size(), 3U);
  ASSERT_TRUE(same.grid.has_value());
  EXPECT_EQ(same.grid->occupancy, map.grid->occupancy);
}

TEST(TunnelMap, TwoAnchorsOfOneIdAreRefused) {
  TunnelMap map = threeAnchors();
  map.anchors[2].id = 7;
  EXPECT_EQ(refusal(map).what, "two anchors have the same id");
  EXPECT_EQ(refusal(map).got, "id 7");
}

TEST(TunnelMap, AnchorWithoutANumberIsRefusedByName) {
  TunnelMap map = threeAnchors();
  map.anchors[1].p_map.z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(map).what, "anchor has a coordinate that is no number");
  EXPECT_EQ(refusal(map).key, "anchors[1]");
}

TEST(TunnelMap, BadSurveySigmaIsRefused) {
  for (const double bad :
       {-0.01, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    TunnelMap map = threeAnchors();
    map.anchors[0].survey_sigma = bad;
    EXPECT_EQ(refusal(map).what, "anchor 7: the value must not be negative");
    EXPECT_EQ(refusal(map).key, "anchors[0].survey_sigma_m");
  }
}

TEST(TunnelMap, GridWhoseCellsDoNotMatchItsSizeIsRefused) {
  for (const auto spoil :
       {+[](OccupancyGrid& g) { g.occupancy.pop_back(); }, +[](OccupancyGrid& g) { g.resolution = 0.0; },
        +[](OccupancyGrid& g) { g.columns = 0; }, +[](OccupancyGrid& g) { g.rows = -3; },
        +[](OccupancyGrid& g) { g.columns = g.rows = 0, g.occupancy.clear(); }}) {
    TunnelMap map = threeAnchors();
    map.grid = grid2x3();
    spoil(*map.grid);
    EXPECT_EQ(refusal(map).what, "the grid's cells do not match its size");
  }
}

TEST(OccupancyGrid, CellsAreRowMajorFromTheLowestRow) {
  const OccupancyGrid grid = grid2x3();
  EXPECT_EQ(grid.at(1, 0), 1);
  EXPECT_EQ(grid.at(0, 1), 10);
  EXPECT_EQ(grid.at(1, 2), OccupancyGrid::kUnknown);
}

}  // namespace pos::map
