#include "pos/io/dxf_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dxf_samples.hpp"
#include "pos/core/error.hpp"
#include "pos/map/centreline.hpp"
#include "scratch_folder.hpp"
#include "support/map_samples.hpp"

namespace pos::io {
namespace {

using ::testing::HasSubstr;
using Kind = DxfLayerKind;

DxfImport imported(const std::string& text, DxfImportRules rules) {
  if (!rules.metres_per_unit) rules.metres_per_unit = 1.0;
  return mapFromDxf(parseDxf(text, "plan.dxf"), rules);
}

std::string countsOf(const DxfImport& import) {
  std::string all;
  for (const DxfCount& count : import.counts)
    all += (count.used ? "+" : "-") + std::to_string(count.count) + " " + count.type + " " + count.layer +
           ": " + count.what + "\n";
  return all;
}

/// Largest distance between two centrelines at the same share of their length, m.
double apart(const map::Roadway& a, const map::Roadway& b) {
  const map::Centreline one(a), other(b);
  double most = 0.0;
  for (int k = 0; k <= 400; ++k) {
    const double f = k / 400.0;
    most = std::max(most, (one.at(one.chainageStart() + f * one.length()).p_map -
                           other.at(other.chainageStart() + f * other.length()).p_map)
                              .norm());
  }
  return most;
}

TEST(DxfMap, LooseLinesAreJoinedWhereTwoMeet) {
  const std::string text = dxf::file(dxf::line("D", 10, 0, 20, 0) + dxf::line("D", 10, 0, 0, 0) +
                                     dxf::line("D", 20, 0.005, 20, 30));
  const DxfImport import = imported(text, {.layers = {{"D", Kind::Roadway}}});
  ASSERT_EQ(import.map.roadways.size(), 1U);
  EXPECT_EQ(import.map.roadways[0].centreline.size(), 4U);
  EXPECT_NEAR(map::Centreline(import.map.roadways[0]).length(), 50.0, 0.01);
  EXPECT_THAT(countsOf(import), HasSubstr("+3 LINE D: roadway"));
}

TEST(DxfMap, WhereThreeLinesMeetThereIsAJunction) {
  const std::string text =
      dxf::file(dxf::line("D", 0, 0, 20, 0) + dxf::line("D", 20, 0, 40, 0) + dxf::line("D", 20, 0, 20, 30));
  const DxfImport import = imported(text, {.layers = {{"D", Kind::Roadway}}});
  ASSERT_EQ(import.map.roadways.size(), 3U);
  ASSERT_EQ(import.map.junctions.size(), 1U);
  EXPECT_EQ(import.map.junctions[0].places.size(), 3U);
}

TEST(DxfMap, ARoadwayThatEndsOnAnotherJoinsItThere) {
  const std::string text = dxf::file(dxf::line("D", 0, 0, 100, 0) + dxf::line("D", 40, 0.3, 40, 30));
  const DxfImport import = imported(text, {.layers = {{"D", Kind::Roadway}}});
  ASSERT_EQ(import.map.junctions.size(), 1U);
  const auto& places = import.map.junctions[0].places;
  ASSERT_EQ(places.size(), 2U);
  EXPECT_EQ(places[0].roadway, "R2");
  EXPECT_NEAR(places[1].chainage, 40.0, 1e-9);
}

TEST(DxfMap, ARingOfLinesIsOneRoadway) {
  const std::string text = dxf::file(dxf::line("D", 0, 0, 10, 0) + dxf::line("D", 10, 10, 10, 0) +
                                     dxf::line("D", 10, 10, 0, 10) + dxf::line("D", 0, 10, 0, 0));
  const DxfImport import = imported(text, {.layers = {{"D", Kind::Roadway}}});
  ASSERT_EQ(import.map.roadways.size(), 1U);
  EXPECT_EQ(import.map.roadways[0].centreline.size(), 5U);
}

TEST(DxfMap, TextsNameTheNearestObjectOfTheirKind) {
  const std::string text =
      dxf::file(dxf::line("D", 0, 0, 100, 0) + dxf::text("D", 50, 1, "Main drift") +
                dxf::text("D", 50, 60, "Title of the plan") + dxf::point("A", 10, 2, 1.5) +
                dxf::text("A", 11, 2, "UWB-017") + dxf::point("A", 90, 2));
  const DxfImport import = imported(text, {.layers = {{"D", Kind::Roadway}, {"A", Kind::Anchor}}});
  EXPECT_EQ(import.map.roadways[0].id, "Main_drift");
  EXPECT_EQ(import.map.roadways[0].name, "Main drift");
  ASSERT_EQ(import.map.anchors.size(), 2U);
  EXPECT_EQ(import.map.anchors[0].id, 17);
  EXPECT_EQ(import.map.anchors[0].name, "UWB-017");
  EXPECT_EQ(import.map.anchors[0].p_map, Eigen::Vector3d(10, 2, 1.5));
  EXPECT_EQ(import.map.anchors[1].id, 18);
  ASSERT_EQ(import.remarks.size(), 1U);
  EXPECT_THAT(import.remarks[0], HasSubstr("became id 18"));
  EXPECT_THAT(countsOf(import), HasSubstr("-1 TEXT D: a text with nothing near to name"));
}

TEST(DxfMap, AChamberDrawnAsAnOutlineHasItsLengthDepthAndSide) {
  const std::string outline =
      "0\nLWPOLYLINE\n8\nC\n90\n4\n70\n1\n10\n30\n20\n-2\n10\n42\n20\n-2\n10\n42\n20\n-5\n10\n30\n20\n-5\n";
  const std::string text = dxf::file(dxf::line("D", 0, 0, 100, 0) + outline + dxf::text("C", 36, -4, "N4"));
  const DxfImport import = imported(text, {.layers = {{"D", Kind::Roadway}, {"C", Kind::RefugeChamber}}});
  ASSERT_EQ(import.map.chambers.size(), 1U);
  const map::Chamber& chamber = import.map.chambers[0];
  EXPECT_EQ(chamber.id, "N4");
  EXPECT_EQ(chamber.kind, map::Chamber::Kind::Refuge);
  EXPECT_EQ(chamber.side, map::Side::Right);
  EXPECT_NEAR(chamber.place.chainage, 36.0, 1e-9);
  EXPECT_NEAR(chamber.length, 12.0, 1e-9);
  EXPECT_NEAR(chamber.depth, 3.0, 1e-9);
}

TEST(DxfMap, ASymbolIsOneAnchorWhateverItIsDrawnOf) {
  const std::string blocks =
      dxf::block("UWB", 0, 0, dxf::line("0", 0, 0, 1, 1) + "0\nCIRCLE\n8\n0\n10\n0\n20\n0\n40\n1\n");
  const std::string text = dxf::file(
      "0\nINSERT\n8\nA\n66\n1\n2\nUWB\n10\n7\n20\n8\n30\n2\n0\nATTRIB\n8\nA\n10\n7\n20\n8\n1\n42\n0\nSEQEND"
      "\n",
      blocks);
  const DxfImport import = imported(text, {.layers = {{"a", Kind::Anchor}}});
  ASSERT_EQ(import.map.anchors.size(), 1U);
  EXPECT_EQ(import.map.anchors[0].id, 42);
  EXPECT_EQ(import.map.anchors[0].p_map, Eigen::Vector3d(7, 8, 2));
  EXPECT_THAT(countsOf(import), HasSubstr("+1 CIRCLE A: part of a symbol"));
}

TEST(DxfMap, EveryEntityIsCountedOnce) {
  const std::string text =
      dxf::file(dxf::line("D", 0, 0, 100, 0) + dxf::line("D", 5, 5, 5, 5) + dxf::line("X", 0, 0, 1, 1) +
                dxf::text("X", 0, 0, "x") + dxf::point("D", 1, 1) + "0\nHATCH\n8\nX\n");
  const DxfImport import = imported(text, {.layers = {{"D", Kind::Roadway}}});
  std::size_t total = 0;
  for (const DxfCount& count : import.counts) total += count.count;
  EXPECT_EQ(total, 6U);
  EXPECT_THAT(countsOf(import), HasSubstr("-1 LINE D: without length in plan"));
  EXPECT_THAT(countsOf(import), HasSubstr("-1 LINE X: layer not mapped"));
}

TEST(DxfMap, ARoadwayDrawnTwiceIsTakenOnce) {
  const std::string bent = "0\nLWPOLYLINE\n8\nD\n90\n2\n10\n0\n20\n0\n42\n0.2\n10\n50\n20\n0\n";
  const std::string back = "0\nLWPOLYLINE\n8\nD\n90\n2\n10\n50\n20\n0\n42\n-0.2\n10\n0\n20\n0\n";
  const std::string other = "0\nLWPOLYLINE\n8\nD\n90\n2\n10\n50\n20\n0\n42\n0.2\n10\n0\n20\n0\n";
  const DxfImport import =
      imported(dxf::file(bent + back + bent + other), {.layers = {{"D", Kind::Roadway}}});
  EXPECT_EQ(import.map.roadways.size(), 2U);
  EXPECT_THAT(countsOf(import), HasSubstr("-2 LWPOLYLINE D: drawn twice"));
}

/// Coming to each roadway in turn would take minutes.
TEST(DxfMap, ManyRoadwaysAreReadInSeconds) {
  std::string entities;
  for (int k = 0; k < 4000; ++k) {
    const double x = 30.0 * (k % 60), y = 30.0 * (k / 60);
    entities += dxf::line("D", x, y, x + 30.0, y) + dxf::line("D", x, y, x, y + 30.0) +
                dxf::text("D", x + 15.0, y, "T");
  }
  const DxfImport import = imported(dxf::file(entities), {.layers = {{"D", Kind::Roadway}}});
  EXPECT_EQ(import.map.roadways.size(), 7998U);  // at two corners of the net exactly two lines meet
  EXPECT_GT(import.map.junctions.size(), 3900U);
}

TEST(DxfMap, UnitsAreNeverGuessed) {
  const std::string text = dxf::file(dxf::line("D", 0, 0, 100000, 0));
  const DxfDrawing drawing = parseDxf(text, "plan.dxf");
  EXPECT_THAT(complaintOf<ConfigError>([&] {
                mapFromDxf(drawing, {.layers = {{"D", Kind::Roadway}}});
              }),
              HasSubstr("--units"));
  const DxfImport import = imported(text, {.layers = {{"D", Kind::Roadway}}, .metres_per_unit = 1e-3});
  EXPECT_NEAR(map::Centreline(import.map.roadways[0]).length(), 100.0, 1e-9);
}

TEST(DxfMap, UnmappedAndMisspeltLayersAreToldWithThoseThereAre) {
  const std::string text = dxf::file(dxf::line("DRIFTS", 0, 0, 100, 0));
  EXPECT_THAT(complaintOf<ConfigError>([&] { imported(text, {}); }), HasSubstr("DRIFTS (1)"));
  EXPECT_THAT(complaintOf<ConfigError>([&] {
                imported(text, {.layers = {{"DRIFT", Kind::Roadway}}});
              }),
              HasSubstr("did you mean 'DRIFTS'"));
  EXPECT_NO_THROW(imported(text, {.layers = {{"dr*", Kind::Roadway}}}));
  EXPECT_THAT(complaintOf<UsageError>([] { dxfLayerRule("A=roadwy"); }), HasSubstr("roadway"));
}

TEST(DxfMap, GridCoordinatesNeedAnOriginAndGetOne) {
  const std::string text = dxf::file(dxf::line("D", 388100, 4512000, 388200, 4512000));
  EXPECT_THAT(complaintOf<ConfigError>([&] {
                imported(text, {.layers = {{"D", Kind::Roadway}}});
              }),
              HasSubstr("--grid-origin 388000,4512000,0"));
  const DxfImport import = imported(text, {.layers = {{"D", Kind::Roadway}},
                                           .mine_grid = map::MineGrid{"g", 388000.0, 4512000.0, 0.0, 0.0}});
  EXPECT_EQ(import.map.roadways[0].centreline[0].p_map, Eigen::Vector3d(100, 0, 0));
}

TEST(DxfMap, AnArcBeyondAHalfCircleBecomesTwo) {
  const std::string text = dxf::file("0\nLWPOLYLINE\n8\nD\n90\n2\n10\n0\n20\n0\n42\n2.0\n10\n10\n20\n0\n");
  const DxfImport import = imported(text, {.layers = {{"D", Kind::Roadway}}});
  const auto& points = import.map.roadways[0].centreline;
  ASSERT_EQ(points.size(), 3U);
  EXPECT_NEAR(points[1].p_map.x(), 5.0, 1e-12);
  EXPECT_NEAR(points[1].p_map.y(), -10.0, 1e-12);  // counter-clockwise: to the right of the chord
  EXPECT_NEAR(points[0].arc, 2.0 * std::atan(2.0), 1e-12);
}

TEST(DxfMap, OurOwnExportComesBack) {
  const map::TunnelMap mine = map::samples::smallMine();
  const DxfImport import = mapFromDxf(parseDxf(mapDxf(mine), "own.dxf"), {});
  ASSERT_EQ(import.map.roadways.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(import.map.roadways[i].id, mine.roadways[i].id);
    EXPECT_LT(apart(import.map.roadways[i], mine.roadways[i]), 1e-3);
  }
  ASSERT_EQ(import.map.anchors.size(), 3U);
  EXPECT_EQ(import.map.anchors[2].id, 40000);
  EXPECT_LT((import.map.anchors[2].p_map - mine.anchors[2].p_map).norm(), 1e-6);
  ASSERT_EQ(import.map.junctions.size(), 1U);
  ASSERT_EQ(import.map.chambers.size(), 2U);
  EXPECT_EQ(import.map.chambers[0].id, "C1");
  EXPECT_NEAR(import.map.chambers[0].place.chainage, 30.0, 1e-3);
  EXPECT_EQ(import.map.chambers[1].kind, map::Chamber::Kind::Refuge);
  EXPECT_EQ(import.map.portals.size(), 1U);
}

TEST(DxfMap, ExportsInTheMinesGridComeBackThroughIt) {
  const map::TunnelMap mine = map::samples::smallMine();
  const std::string text = mapDxf(mine, DxfFrame::MineGrid);
  const DxfImport import = mapFromDxf(parseDxf(text, "own.dxf"), {.mine_grid = mine.mine_grid});
  EXPECT_LT(apart(import.map.roadways[0], mine.roadways[0]), 1e-3);
  map::TunnelMap without = mine;
  without.mine_grid.reset();
  EXPECT_THROW(mapDxf(without, DxfFrame::MineGrid), ConfigError);
}

TEST(DxfMap, RandomCentrelinesComeBackWithinAMillimetre) {
  double most = 0.0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    RandomStream random(seed, 11);
    map::TunnelMap mine = map::samples::randomMine(random, seed % 2 == 0);
    const DxfImport import = mapFromDxf(parseDxf(mapDxf(mine), "own.dxf"), {.label_distance = 0.5});
    ASSERT_EQ(import.map.roadways.size(), mine.roadways.size()) << seed;
    for (std::size_t i = 0; i < mine.roadways.size(); ++i) {
      most = std::max(most, apart(import.map.roadways[i], mine.roadways[i]));
      if (seed % 2 == 0) {  // level roadways keep their points and arcs
        ASSERT_EQ(import.map.roadways[i].centreline.size(), mine.roadways[i].centreline.size());
      }
    }
    EXPECT_EQ(import.map.anchors.size(), mine.anchors.size());
  }
  EXPECT_LT(most, 1e-3);
  RecordProperty("largest_distance_mm", std::to_string(1e3 * most));
}

}  // namespace
}  // namespace pos::io
