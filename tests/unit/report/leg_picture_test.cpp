#include "pos/report/leg_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pos::report {
namespace {

using ::testing::HasSubstr;

LegPicture twoLegs() {
  LegPicture picture{.title = "Sweep at 12.0 s"};
  picture.returns = {{1.5, 3.85}, {1.45, 3.86}, {-3.0, 3.9}};
  picture.expected = {{11, {1.4, 4.0}}, {8, {-3.1, 4.0}, true}};
  picture.found = {{{1.5, 4.0}, 1e-5 * Eigen::Matrix2d::Identity(), 11, true},
                   {{-2.0, 4.1}, 1e-5 * Eigen::Matrix2d::Identity(), {}, false}};
  return picture;
}

template <class Kind>
std::vector<Kind> all(const Drawing& drawing) {
  std::vector<Kind> found;
  for (const Shape& shape : drawing.shapes) {
    if (const auto* kind = std::get_if<Kind>(&shape)) found.push_back(*kind);
  }
  return found;
}

}  // namespace

TEST(LegDrawing, NamesTheSupportsAndCountsWhatWasSeen) {
  const std::string svg = drawingSvg(legDrawing(twoLegs()));
  EXPECT_THAT(svg, HasSubstr("Sweep at 12.0 s"));
  EXPECT_THAT(svg, HasSubstr(">11<"));
  EXPECT_THAT(svg, HasSubstr("10.0 cm"));
  EXPECT_THAT(svg,
              HasSubstr("3 returns (dots), 2 legs found (crosses), 1 taken for a support (green), 1 used"));
  EXPECT_THAT(svg, HasSubstr("1 dropped"));
}

TEST(LegDrawing, LeftOfTheScannerIsUpAndForwardIsRight) {
  LegPicture picture;
  picture.returns = {{5.0, 4.0}};
  const Drawing drawing = legDrawing(picture);
  const auto circles = all<DrawnCircle>(drawing);
  const auto scanner = all<DrawnPolygon>(drawing);
  ASSERT_EQ(circles.size(), 1U);
  ASSERT_EQ(scanner.size(), 1U);
  const Pixel origin{scanner[0].points[0].x - 10.0, scanner[0].points[0].y};
  EXPECT_NEAR((circles[0].centre.x - origin.x) / 5.0, (origin.y - circles[0].centre.y) / 4.0, 1e-9);
  EXPECT_GT(circles[0].centre.x, origin.x);
  EXPECT_LT(circles[0].centre.y, origin.y);
}

TEST(LegDrawing, EmptySweepIsDrawnAsOne) {
  const Drawing drawing = legDrawing({.title = "Dust"});
  EXPECT_GT(drawing.height, 0.0);
  EXPECT_THAT(drawingSvg(drawing), HasSubstr("0 returns (dots), 0 legs found"));
}

TEST(LegDrawing, NotANumberIsLeftOut) {
  LegPicture picture = twoLegs();
  picture.returns.emplace_back(std::nan(""), 1.0);
  EXPECT_EQ(drawingSvg(legDrawing(picture)).find("nan"), std::string::npos);
}

}  // namespace pos::report
