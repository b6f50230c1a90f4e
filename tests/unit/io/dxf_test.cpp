#include "pos/io/dxf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "dxf_samples.hpp"
#include "pos/core/error.hpp"
#include "scratch_folder.hpp"

namespace pos::io {
namespace {

using ::testing::HasSubstr;
using Kind = DxfEntity::Kind;

DxfDrawing parsed(const std::string& text) {
  return parseDxf(text, "plan.dxf");
}

std::string reasonsOf(const DxfDrawing& drawing) {
  std::string all;
  for (const DxfSkipped& skip : drawing.skipped)
    all += std::to_string(skip.count) + " " + skip.type + " " + skip.layer + ": " + skip.reason + "\n";
  return all;
}

TEST(Dxf, ALineIsAPathOfTwoPoints) {
  const DxfDrawing drawing = parsed(dxf::file(dxf::line("DRIFT", 1, 2, 3, 4)));
  ASSERT_EQ(drawing.entities.size(), 1U);
  EXPECT_EQ(drawing.entities[0].layer, "DRIFT");
  EXPECT_EQ(drawing.entities[0].vertices[1].p, Eigen::Vector3d(3, 4, 0));
  EXPECT_TRUE(drawing.complete);
}

TEST(Dxf, AnArcPassesThroughItsMiddle) {
  // radius 10 around (5, 5), from 0 to 90 degrees
  const DxfDrawing drawing = parsed(dxf::file("0\nARC\n8\nA\n10\n5\n20\n5\n40\n10\n50\n0\n51\n90\n"));
  ASSERT_EQ(drawing.entities.size(), 1U);
  const auto& v = drawing.entities[0].vertices;
  ASSERT_EQ(v.size(), 3U);
  const double half = 10.0 * std::sqrt(0.5);
  EXPECT_NEAR((v[0].p - Eigen::Vector3d(15, 5, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((v[1].p - Eigen::Vector3d(5 + half, 5 + half, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((v[2].p - Eigen::Vector3d(5, 15, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(v[0].bulge, std::tan(M_PI / 16.0), 1e-15);  // counter-clockwise, 45 degrees each
}

TEST(Dxf, AnArcAcrossZeroDegreesGoesTheShortWay) {
  const DxfDrawing drawing = parsed(dxf::file("0\nARC\n8\nA\n10\n0\n20\n0\n40\n1\n50\n350\n51\n10\n"));
  EXPECT_NEAR(drawing.entities[0].vertices[1].p.x(), 1.0, 1e-12);
}

TEST(Dxf, PolylinesOfBothKindsKeepBulgeElevationAndClosure) {
  const std::string light =
      "0\nLWPOLYLINE\n8\nA\n90\n2\n70\n1\n38\n-7.5\n10\n0\n20\n0\n42\n0.5\n10\n4\n20\n0\n";
  const std::string heavy =
      "0\nPOLYLINE\n8\nA\n66\n1\n70\n0\n30\n-7.5\n0\nVERTEX\n8\nA\n10\n0\n20\n0\n42\n0."
      "5\n0\nVERTEX\n8\nA\n10\n4\n20\n0\n"
      "0\nSEQEND\n";
  for (const std::string& text : {light, heavy}) {
    const DxfDrawing drawing = parsed(dxf::file(text));
    ASSERT_EQ(drawing.entities.size(), 1U);
    EXPECT_EQ(drawing.entities[0].vertices.size(), 2U);
    EXPECT_DOUBLE_EQ(drawing.entities[0].vertices[0].bulge, 0.5);
    EXPECT_DOUBLE_EQ(drawing.entities[0].vertices[1].p.z(), -7.5);
    EXPECT_EQ(drawing.entities[0].closed, text == light);
  }
}

TEST(Dxf, SplineControlPointsAreNotOnTheCurve) {
  const DxfDrawing drawing =
      parsed(dxf::file("0\nPOLYLINE\n8\nA\n70\n4\n0\nVERTEX\n8\nA\n10\n9\n20\n9\n70\n16\n0\nVERTEX\n8\nA\n10"
                       "\n0\n20\n0\n70\n8\n0\nVERTEX\n"
                       "8\nA\n10\n4\n20\n0\n70\n8\n0\nSEQEND\n"));
  EXPECT_EQ(drawing.entities[0].vertices.size(), 2U);
}

TEST(Dxf, SeenFromBelowXIsMirroredAndArcsTurnRound) {
  const DxfDrawing drawing =
      parsed(dxf::file("0\nLWPOLYLINE\n8\nA\n90\n2\n10\n1\n20\n2\n42\n0.5\n10\n3\n20\n4\n230\n-1\n"));
  EXPECT_EQ(drawing.entities[0].vertices[0].p, Eigen::Vector3d(-1, 2, 0));
  EXPECT_DOUBLE_EQ(drawing.entities[0].vertices[0].bulge, -0.5);
}

TEST(Dxf, BlocksAreDrawnWhereTheyAreInserted) {
  // a block with base (1, 0) that holds a line from (1, 0) to (2, 0); inserted at (10, 10), doubled, turned
  // left
  const std::string blocks = dxf::block("B", 1, 0, dxf::line("0", 1, 0, 2, 0) + dxf::line("OWN", 1, 0, 1, 1));
  const DxfDrawing drawing =
      parsed(dxf::file("0\nINSERT\n8\nDRIFT\n2\nB\n10\n10\n20\n10\n41\n2\n42\n2\n50\n90\n", blocks));
  ASSERT_EQ(drawing.entities.size(), 3U);
  EXPECT_EQ(drawing.entities[0].kind, Kind::Symbol);
  EXPECT_NEAR((drawing.entities[0].vertices[0].p - Eigen::Vector3d(10, 10, 0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(drawing.entities[1].layer, "DRIFT");  // layer 0 takes the insertion's
  EXPECT_EQ(drawing.entities[2].layer, "OWN");
  EXPECT_NEAR((drawing.entities[1].vertices[1].p - Eigen::Vector3d(10, 12, 0)).norm(), 0.0, 1e-12);
  EXPECT_TRUE(drawing.entities[1].block_part);
}

TEST(Dxf, AMirroredBlockTurnsItsArcsRound) {
  const std::string blocks =
      dxf::block("B", 0, 0, "0\nLWPOLYLINE\n8\n0\n90\n2\n10\n0\n20\n0\n42\n0.3\n10\n1\n20\n0\n");
  const DxfDrawing drawing = parsed(dxf::file("0\nINSERT\n8\nA\n2\nB\n10\n0\n20\n0\n42\n-1\n", blocks));
  ASSERT_EQ(drawing.entities.size(), 2U);
  EXPECT_DOUBLE_EQ(drawing.entities[1].vertices[0].bulge, -0.3);
}

TEST(Dxf, AStretchedArcAndATiltedShapeAreCountedAsLeftOut) {
  const std::string blocks =
      dxf::block("B", 0, 0, "0\nLWPOLYLINE\n8\n0\n90\n2\n10\n0\n20\n0\n42\n0.3\n10\n1\n20\n0\n");
  const DxfDrawing drawing = parsed(dxf::file(
      "0\nINSERT\n8\nA\n2\nB\n10\n0\n20\n0\n41\n3\n0\nCIRCLE\n8\nA\n10\n0\n20\n0\n40\n1\n210\n1\n230\n0\n",
      blocks));
  EXPECT_EQ(drawing.entities.size(), 1U);  // the symbol
  EXPECT_THAT(reasonsOf(drawing), HasSubstr("1 LWPOLYLINE A: an arc in a block that is stretched"));
  EXPECT_THAT(reasonsOf(drawing), HasSubstr("1 CIRCLE A: drawn on a tilted plane"));
}

TEST(Dxf, WhatIsNotReadIsCountedByTypeAndLayer) {
  const DxfDrawing drawing =
      parsed(dxf::file("0\nHATCH\n8\nA\n0\nHATCH\n8\nA\n0\nHATCH\n8\nB\n0\nLINE\n8\nA\n10\n1\n20\nx\n11\n1\n2"
                       "1\n1\n0\nLINE\n8\nA\n10\n1\n"
                       "0\nINSERT\n8\nA\n2\nNOT_THERE\n10\n0\n20\n0\n0\nPOINT\n8\nA\n67\n1\n10\n1\n20\n1\n"));
  EXPECT_TRUE(drawing.entities.empty());
  const std::string reasons = reasonsOf(drawing);
  EXPECT_THAT(reasons, HasSubstr("2 HATCH A: not read"));
  EXPECT_THAT(reasons, HasSubstr("1 HATCH B: not read"));
  EXPECT_THAT(reasons, HasSubstr("1 LINE A: damaged: group 20 is no number"));
  EXPECT_THAT(reasons, HasSubstr("1 LINE A: damaged: group 20 is missing"));
  EXPECT_THAT(reasons, HasSubstr("1 INSERT A: of a block that is not there"));
  EXPECT_THAT(reasons, HasSubstr("1 POINT A: on a layout sheet"));
}

TEST(Dxf, ABlockInItselfAndBlocksThatMultiplyEnd) {
  const std::string own = dxf::block("B", 0, 0, "0\nINSERT\n8\n0\n2\nB\n10\n1\n20\n0\n");
  EXPECT_THAT(reasonsOf(parsed(dxf::file("0\nINSERT\n8\nA\n2\nB\n10\n0\n20\n0\n", own))),
              HasSubstr("nested too deep"));
  std::string bomb = dxf::block("B0", 0, 0, dxf::line("0", 0, 0, 1, 1));
  for (int k = 1; k < 12; ++k) {
    std::string inside;
    for (int n = 0; n < 10; ++n)
      inside += "0\nINSERT\n8\n0\n2\nB" + std::to_string(k - 1) + "\n10\n1\n20\n0\n";
    bomb += dxf::block("B" + std::to_string(k), 0, 0, inside);
  }
  EXPECT_THAT(
      complaintOf<DataError>([&] { parsed(dxf::file("0\nINSERT\n8\nA\n2\nB11\n10\n0\n20\n0\n", bomb)); }),
      HasSubstr("multiply"));
}

TEST(Dxf, UnitsVersionAndCommentsAreRead) {
  const std::string header =
      "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n";
  const DxfDrawing drawing = parsed(header + dxf::file(dxf::line("A", 0, 0, 1, 1)));
  EXPECT_EQ(drawing.version, "AC1015");
  EXPECT_EQ(drawing.metres_per_unit, 1e-3);
  EXPECT_FALSE(parsed(dxf::file("")).metres_per_unit.has_value());
}

TEST(Dxf, TextsAreReadableUtf8) {
  const DxfDrawing drawing =
      parsed(dxf::file("0\nTEXT\n8\nA\n10\n0\n20\n0\n1\nSch\\U+00E4chte %%d\xff\x01 \xe7\x85\xa4\n"));
  EXPECT_EQ(drawing.entities[0].text, "Sch\u00e4chte \u00b0? \u7164");
}

TEST(Dxf, WindowsLinesAndACutEndAreRead) {
  std::string text = dxf::file(dxf::line("A", 0, 0, 1, 1));
  text = text.substr(0, text.rfind("0\nEOF"));
  std::string windows;
  for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const DxfDrawing drawing = parsed(windows);
  EXPECT_EQ(drawing.entities.size(), 1U);
  EXPECT_FALSE(drawing.complete);
}

TEST(Dxf, OtherFilesAreRefusedWithTheirLine) {
  EXPECT_THAT(complaintOf<DataError>([] { parsed("AutoCAD Binary DXF\r\n\x1a"); }), HasSubstr("ASCII"));
  EXPECT_THAT(complaintOf<DataError>([] { parsed("<svg>\n<g/>\n"); }), HasSubstr("plan.dxf:1"));
  EXPECT_THAT(complaintOf<DataError>([] { parsed("0\nSECTION\nhello\nthere\n"); }), HasSubstr("plan.dxf:3"));
  EXPECT_THAT(complaintOf<DataError>([] { parsed(""); }), HasSubstr("empty"));
  EXPECT_THAT(complaintOf<DataError>([] { parsed("0\nEOF\n"); }), HasSubstr("no sections"));
}

}  // namespace
}  // namespace pos::io
