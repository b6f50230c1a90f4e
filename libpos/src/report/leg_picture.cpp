#include "pos/report/leg_picture.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/report/text.hpp"

namespace pos::report {
namespace {

constexpr double kWidth = 1200.0;  // px
constexpr double kMargin = 40.0;
constexpr double kLegend = 56.0;
constexpr double kEllipse = 10.0;  // ellipses are drawn so many times too large
const Colour kInk = "#1c2530";
const Colour kGrey = "#8a94a0";
const Colour kReturn = "#2f6fd0";
const Colour kUsed = "#d1495b";
const Colour kSeen = "#2a7f62";

/// Metres to pixels, one scale, y up.
struct Sheet {
  Eigen::Vector2d low = Eigen::Vector2d(-1.0, -1.0);
  Eigen::Vector2d high = Eigen::Vector2d(1.0, 1.0);

  void add(const Eigen::Vector2d& p) {
    if (!p.allFinite()) return;
    low = low.cwiseMin(p - Eigen::Vector2d::Constant(0.8));
    high = high.cwiseMax(p + Eigen::Vector2d::Constant(0.8));
  }
  double scale() const { return (kWidth - 2.0 * kMargin) / (high.x() - low.x()); }
  double height() const { return scale() * (high.y() - low.y()) + 2.0 * kMargin + kLegend; }
  Pixel operator()(const Eigen::Vector2d& p) const {
    return {kMargin + scale() * (p.x() - low.x()), kMargin + scale() * (high.y() - p.y())};
  }
};

Sheet sheetOf(const LegPicture& picture) {
  Sheet sheet;
  for (const Eigen::Vector2d& p : picture.returns) sheet.add(p);
  for (const LegPicture::Expected& leg : picture.expected) sheet.add(leg.p);
  for (const LegPicture::Found& leg : picture.found) sheet.add(leg.p);
  return sheet;
}

void drawExpected(Drawing& drawing, const Sheet& sheet, const LegPicture& picture) {
  for (const LegPicture::Expected& leg : picture.expected) {
    const Colour colour = leg.moved ? kGrey : kInk;
    const Pixel at = sheet(leg.p);
    drawing.add(DrawnCircle{
        at, sheet.scale() * picture.gate, {.stroke = kGrey, .stroke_width = 0.7, .dash = {3, 4}}});
    drawing.add(
        DrawnCircle{at,
                    sheet.scale() * picture.radius,
                    {.stroke = colour, .dash = leg.moved ? std::vector{2.0, 2.0} : std::vector<double>{}}});
    drawing.add(DrawnText{.at = {at.x, at.y - sheet.scale() * picture.gate - 4.0},
                          .text = std::to_string(leg.support),
                          .size = 11.0,
                          .colour = colour,
                          .anchor = TextAnchor::Middle});
  }
}

/// 3 sigma, drawn too large by kEllipse.
std::vector<Pixel> ellipse(const Sheet& sheet, const LegPicture::Found& leg) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(leg.covariance);
  const Eigen::Vector2d half = 3.0 * kEllipse * axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  std::vector<Pixel> points;
  for (int i = 0; i <= 36; ++i) {
    const double angle = 2.0 * kPi * i / 36.0;
    points.push_back(sheet(leg.p + axes.eigenvectors() * Eigen::Vector2d(half.x() * std::cos(angle),
                                                                         half.y() * std::sin(angle))));
  }
  return points;
}

void drawFound(Drawing& drawing, const Sheet& sheet, const LegPicture& picture) {
  for (const LegPicture::Found& leg : picture.found) {
    const Colour colour = leg.used ? kUsed : leg.support ? kSeen : kGrey;
    const Pixel at = sheet(leg.p);
    drawing.add(DrawnLine{{{at.x - 4.0, at.y}, {at.x + 4.0, at.y}}, {.stroke = colour, .stroke_width = 1.5}});
    drawing.add(DrawnLine{{{at.x, at.y - 4.0}, {at.x, at.y + 4.0}}, {.stroke = colour, .stroke_width = 1.5}});
    if (leg.covariance.allFinite())
      drawing.add(DrawnLine{ellipse(sheet, leg), {.stroke = colour, .stroke_width = 1.2}});
    const auto taken_for =
        std::find_if(picture.expected.begin(), picture.expected.end(),
                     [&leg](const auto& e) { return leg.support && e.support == *leg.support; });
    if (taken_for == picture.expected.end()) continue;
    drawing.add(DrawnLine{{at, sheet(taken_for->p)}, {.stroke = colour, .stroke_width = 1.5}});
    drawing.add(DrawnText{.at = {at.x, at.y + sheet.scale() * picture.gate + 14.0},
                          .text = fixed(100.0 * (leg.p - taken_for->p).norm(), 1) + " cm",
                          .size = 10.0,
                          .colour = colour,
                          .anchor = TextAnchor::Middle});
  }
}

void drawScanner(Drawing& drawing, const Sheet& sheet) {
  const Pixel at = sheet(Eigen::Vector2d::Zero());
  drawing.add(DrawnPolygon{{{at.x + 10.0, at.y}, {at.x - 6.0, at.y - 6.0}, {at.x - 6.0, at.y + 6.0}},
                           {.fill = kInk}});
  drawing.add(
      DrawnText{.at = {at.x + 14.0, at.y + 4.0}, .text = "scanner, looks along the face", .size = 11.0});
}

void drawLegend(Drawing& drawing, const LegPicture& picture) {
  const auto taken = std::count_if(picture.found.begin(), picture.found.end(),
                                   [](const auto& leg) { return leg.support.has_value(); });
  const auto used =
      std::count_if(picture.found.begin(), picture.found.end(), [](const auto& leg) { return leg.used; });
  const double y = drawing.height - kLegend + 20.0;
  drawing.add(DrawnText{
      .at = {kMargin, y},
      .text = std::to_string(picture.returns.size()) + " returns (dots), " +
              std::to_string(picture.found.size()) + " legs found (crosses), " + std::to_string(taken) +
              " taken for a support (green), " + std::to_string(used) + " used by the filter (red), " +
              std::to_string(picture.found.size() - static_cast<std::size_t>(taken)) + " dropped (grey)"});
  drawing.add(DrawnText{
      .at = {kMargin, y + 18.0},
      .text = "rings: expected legs with their numbers, dashed where the support moves in this cycle; "
              "around them the gate; ellipses of 3 sigma, drawn 10 times too large",
      .size = 11.0,
      .colour = kGrey});
}

}  // namespace

Drawing legDrawing(const LegPicture& picture) {
  const Sheet sheet = sheetOf(picture);
  Drawing drawing{.width = kWidth,
                  .height = sheet.height(),
                  .title = picture.title,
                  .description = "Sweep of the laser scanner with the supports' legs found in it"};
  drawing.add(DrawnText{.at = {kMargin, 24.0}, .text = picture.title, .size = 15.0, .bold = true});
  drawExpected(drawing, sheet, picture);
  for (const Eigen::Vector2d& p : picture.returns) {
    if (p.allFinite()) drawing.add(DrawnCircle{sheet(p), 1.3, {.fill = kReturn}});
  }
  drawFound(drawing, sheet, picture);
  drawScanner(drawing, sheet);
  drawLegend(drawing, picture);
  return drawing;
}

}  // namespace pos::report
