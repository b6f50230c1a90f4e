#include "pos/report/map_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pos/core/error.hpp"
#include "support/map_samples.hpp"

namespace pos::report {
namespace {

using ::testing::HasSubstr;

/// All shapes of one type.
template <class T>
std::vector<T> all(const Drawing& drawing) {
  std::vector<T> found;
  for (const Shape& shape : drawing.shapes) {
    if (const T* one = std::get_if<T>(&shape)) found.push_back(*one);
  }
  return found;
}

std::vector<DrawnText> texts(const Drawing& drawing, const std::string& text) {
  std::vector<DrawnText> found = all<DrawnText>(drawing);
  std::erase_if(found, [&](const DrawnText& each) { return each.text != text; });
  return found;
}

Box boxOf(const DrawnText& text) {
  const double width = textWidth(text.text, text.size, text.bold);
  const double left = text.anchor == TextAnchor::Middle ? text.at.x - 0.5 * width : text.at.x;
  return {left, text.at.y - 0.8 * text.size, width, 0.9 * text.size};
}

bool overlap(const Box& a, const Box& b) {
  return a.left < b.right() && b.left < a.right() && a.top < b.bottom() && b.top < a.bottom();
}

PlanOptions withIntervals(const map::TunnelMap& map) {
  PlanOptions options;
  for (std::size_t k = 0; k < map.roadways.size(); ++k) {
    const map::Centreline line(map.roadways[k]);
    for (int i = 0; i < 3; ++i) {
      map::LockInterval interval;
      interval.leg = std::string(1, static_cast<char>('i' + k));
      interval.index = i;
      const double third = line.length() / 3.0;
      interval.spans = {
          {k, line.chainageStart() + third * i, line.chainageStart() + third * (i + 1), map::Lane::Both}};
      options.intervals.push_back(interval);
    }
  }
  return options;
}

TEST(MapPlan, BothAxesHaveOneScaleAndRoadwaysTheirTrueWidth) {
  map::TunnelMap mine;
  mine.roadways = {
      map::samples::roadway("R", {{.p_map = {0.0, 0.0, 0.0}}, {.p_map = {100.0, 0.0, 0.0}}}, 5.0)};
  const MapPlan plan = mapPlan(mine, {});
  double width = 0.0, height = 0.0;
  for (const DrawnPolygon& polygon : all<DrawnPolygon>(plan.drawing)) {
    if (polygon.paint.fill != "#eef1f4" || polygon.points.size() != 4) continue;
    const auto [left, right] = std::minmax_element(polygon.points.begin(), polygon.points.end(),
                                                   [](const Pixel& a, const Pixel& b) { return a.x < b.x; });
    const auto [top, bottom] = std::minmax_element(polygon.points.begin(), polygon.points.end(),
                                                   [](const Pixel& a, const Pixel& b) { return a.y < b.y; });
    width = std::max(width, right->x - left->x);
    height = std::max(height, bottom->y - top->y);
  }
  EXPECT_NEAR(width * plan.metres_per_pixel, 100.0, 1e-6);
  EXPECT_NEAR(height * plan.metres_per_pixel, 5.0, 1e-6);
  EXPECT_FALSE(plan.widened);
}

TEST(MapPlan, NorthIsUpAndEastIsRight) {
  map::TunnelMap mine = map::samples::smallMine();
  mine.anchors = {{.id = 71, .p_map = {0.0, 0.0, 0.0}}, {.id = 72, .p_map = {100.0, 40.0, 0.0}}};
  const MapPlan plan = mapPlan(mine, {});
  std::vector<Pixel> tips;
  for (const DrawnPolygon& polygon : all<DrawnPolygon>(plan.drawing)) {
    if (polygon.paint.fill == "#1f5fbf" && polygon.paint.stroke == "#ffffff")
      tips.push_back(polygon.points.front());
  }
  ASSERT_EQ(tips.size(), 2U);
  EXPECT_NEAR((tips[1].x - tips[0].x) * plan.metres_per_pixel, 100.0, 1e-6);
  EXPECT_NEAR((tips[0].y - tips[1].y) * plan.metres_per_pixel, 40.0, 1e-6);
}

TEST(MapPlan, LabelsDoNotOverlapOnSmallAndLongMaps) {
  map::TunnelMap longer = map::samples::longMine();
  for (std::size_t i = 0; i < longer.roadways.size(); ++i) {
    const map::Centreline line(longer.roadways[i]);
    for (double s = 20.0; s < line.length(); s += 60.0)
      longer.anchors.push_back(
          {.id = static_cast<AnchorId>(longer.anchors.size() + 1), .p_map = line.at(s).p_map});
  }
  for (const map::TunnelMap& mine : {map::samples::smallMine(), longer}) {
    const MapPlan plan = mapPlan(mine, withIntervals(mine));
    EXPECT_EQ(plan.labels_left_out, 0U) << mine.name;
    std::vector<DrawnText> labels = all<DrawnText>(plan.drawing);
    std::erase_if(labels,
                  [](const DrawnText& text) { return text.halo.empty() || text.colour == "#5b6876"; });
    EXPECT_GT(labels.size(), 20U);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      for (std::size_t j = i + 1; j < labels.size(); ++j)
        EXPECT_FALSE(overlap(boxOf(labels[i]), boxOf(labels[j])))
            << labels[i].text << " and " << labels[j].text;
      EXPECT_GE(boxOf(labels[i]).left, 0.0);
      EXPECT_LE(boxOf(labels[i]).right(), plan.drawing.width);
    }
  }
}

TEST(MapPlan, EveryObjectOfTheMapIsNamed) {
  const map::TunnelMap mine = map::samples::smallMine();
  const MapPlan plan = mapPlan(mine, withIntervals(mine));
  for (const char* word :
       {"R1 main \"intake\" <1>", "R2", "R3", "J1 fork", "north portal", "C1", "C2", "1", "12", "40000", "L1",
        "slow", "i_0", "j_2", "Plan of small mine", "lock intervals", "N"}) {
    EXPECT_FALSE(texts(plan.drawing, word).empty()) << word;
  }
  EXPECT_THAT(drawingSvg(plan.drawing), HasSubstr("R1 main &quot;intake&quot; &lt;1&gt;"));
}

TEST(MapPlan, ANarrowSheetSaysWhatItLeavesOut) {
  const map::TunnelMap mine = map::samples::longMine();
  PlanOptions options = withIntervals(mine);
  options.width = 500.0;
  const MapPlan plan = mapPlan(mine, options);
  EXPECT_NEAR(plan.drawing.width, 500.0, 1.0);
  EXPECT_TRUE(plan.widened);
  EXPECT_GT(plan.labels_left_out, 0U);
  EXPECT_THAT(drawingSvg(plan.drawing), HasSubstr("left out for lack of room"));
  EXPECT_THAT(drawingSvg(plan.drawing), HasSubstr("wider than true to scale"));
}

TEST(MapPlan, OneLevelShowsOnlyItsRoadways) {
  const map::TunnelMap mine = map::samples::smallMine();
  const MapPlan plan = mapPlan(mine, {.level = "lower"});
  EXPECT_FALSE(texts(plan.drawing, "R3").empty());
  EXPECT_TRUE(texts(plan.drawing, "R2").empty());
  EXPECT_TRUE(texts(plan.drawing, "C1").empty());
  std::vector<DrawnText> subtitles = all<DrawnText>(plan.drawing);
  std::erase_if(subtitles,
                [](const DrawnText& text) { return text.text.find("on level lower") == text.text.npos; });
  ASSERT_EQ(subtitles.size(), 1U);
  EXPECT_EQ(subtitles[0].text.find("chamber"), std::string::npos) << "those of another level do not count";
  EXPECT_THROW(mapPlan(mine, {.level = "middle"}), ConfigError);
  EXPECT_THROW(mapPlan(map::TunnelMap{}, {}), ConfigError);
  EXPECT_THROW(mapPlan(mine, {.width = 20.0}), ConfigError);
}

TEST(MapPlan, ABackgroundLandsOnItsControlPoints) {
  map::TunnelMap mine = map::samples::smallMine();
  PlanBackground picture;
  picture.bytes = drawingPng({.width = 10, .height = 10});
  picture.columns = picture.rows = 10;
  picture.T_map_pixel << 2.0, 0.0, 5.0, 0.0, -2.0, 30.0;
  mine.anchors = {{.id = 9, .p_map = {5.0, 30.0, 0.0}}};
  const MapPlan plan = mapPlan(mine, {.background = picture});
  const auto images = all<DrawnImage>(plan.drawing);
  ASSERT_EQ(images.size(), 1U);
  EXPECT_NEAR(images[0].along_u.x * plan.metres_per_pixel, 2.0, 1e-9);
  EXPECT_NEAR(images[0].along_v.y * plan.metres_per_pixel, 2.0, 1e-9);
}

TEST(MapPlan, TheSamePlanGivesTheSameBytesAndAPngOfItsSize) {
  const map::TunnelMap mine = map::samples::smallMine();
  const MapPlan plan = mapPlan(mine, withIntervals(mine));
  EXPECT_EQ(drawingSvg(plan.drawing), drawingSvg(mapPlan(mine, withIntervals(mine)).drawing));
  const std::string png = drawingPng(plan.drawing, 0.5);
  ASSERT_GT(png.size(), 100U);
  const auto word = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t k = 0; k < 4; ++k) value = value * 256U + static_cast<unsigned char>(png[at + k]);
    return value;
  };
  EXPECT_NEAR(word(16), 0.5 * plan.drawing.width, 1.0);
  EXPECT_NEAR(word(20), 0.5 * plan.drawing.height, 1.0);
  EXPECT_THROW(drawingPng({.width = 1e6, .height = 1e6}), ConfigError);
}

TEST(MapPlan, ADashedLineAMillionSheetsLongIsDrawnAsItsPartOnTheSheet) {
  const auto png = [](double from, double to) {
    Drawing drawing{.width = 100, .height = 20};
    drawing.add(DrawnLine{{{from, 10.0}, {to, 10.0}}, {.stroke = "#000000", .dash = {6.0, 3.0}}});
    return drawingPng(drawing);
  };
  EXPECT_EQ(png(-1e9, 1e9), png(-1.0, 200.0)) << "1e9 = 1 modulo 9, the dashes' period";
  EXPECT_NE(png(-1e9, 1e9), png(-2.0, 200.0));
}

TEST(MapPlan, RandomMapsCanBeDrawn) {
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    RandomStream random(seed, 13);
    const map::TunnelMap mine = map::samples::randomMine(random);
    const std::string svg = drawingSvg(mapPlan(mine, withIntervals(mine)).drawing);
    EXPECT_EQ(svg.find("nan"), std::string::npos) << seed;
    EXPECT_EQ(svg.find("inf"), std::string::npos) << seed;
  }
}

}  // namespace
}  // namespace pos::report
