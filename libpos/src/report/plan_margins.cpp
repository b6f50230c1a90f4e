// The frame with its coordinates, the title, the north arrow and the scale bar.
#include <algorithm>
#include <cmath>

#include "plan_parts.hpp"
#include "pos/core/angle.hpp"
#include "pos/report/axes.hpp"
#include "pos/report/text.hpp"

namespace pos::report::plan {
namespace {

constexpr const char* kInk = "#1c2530";
constexpr const char* kMuted = "#5b6876";

/// True north where the map is tied to the Earth, else the mine grid's, else the map's y axis.
struct North {
  double angle = 0.5 * kPi;  // rad in the map, counter-clockwise from x
  std::string label = "map N";
};
North northOf(const map::TunnelMap& map) {
  if (map.origin) return {0.5 * kPi - map.origin->grid_rotation, "N"};
  if (map.mine_grid) return {0.5 * kPi - map.mine_grid->rotation, "grid N"};
  return {};
}

void drawNorth(Drawing& drawing, const North& north, Pixel centre) {
  const Pixel up{std::cos(north.angle), -std::sin(north.angle)};
  const Pixel side{-up.y, up.x};
  const auto at = [&](double along, double across) {
    return Pixel{centre.x + along * up.x + across * side.x, centre.y + along * up.y + across * side.y};
  };
  drawing.add(DrawnPolygon{{at(20.0, 0.0), at(-12.0, 8.0), at(-6.0, 0.0)}, {.fill = kInk, .stroke = kInk}});
  drawing.add(
      DrawnPolygon{{at(20.0, 0.0), at(-12.0, -8.0), at(-6.0, 0.0)}, {.fill = "#ffffff", .stroke = kInk}});
  drawing.add(DrawnText{.at = {centre.x, centre.y + 34.0},
                        .text = north.label,
                        .size = 12.5,
                        .anchor = TextAnchor::Middle,
                        .bold = true});
}

void drawScaleBar(Drawing& drawing, Pixel left, double metres_per_pixel) {
  const double length = roundLength(220.0 * metres_per_pixel);
  const double pixels = length / metres_per_pixel;
  for (int k = 0; k < 4; ++k) {
    const double x = left.x + 0.25 * pixels * k;
    drawing.add(DrawnPolygon{
        {{x, left.y}, {x + 0.25 * pixels, left.y}, {x + 0.25 * pixels, left.y + 6.0}, {x, left.y + 6.0}},
        {.fill = k % 2 == 0 ? kInk : "#ffffff", .stroke = kInk, .stroke_width = 1.0}});
  }
  for (const double f : {0.0, 0.5, 1.0}) {
    drawing.add(DrawnText{.at = {left.x + f * pixels, left.y - 5.0},
                          .text = tickText(f * length) + (f == 1.0 ? " m" : ""),
                          .size = 12.0,
                          .anchor = TextAnchor::Middle});
  }
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// Those with a stretch on a roadway that is shown.
std::size_t intervalsDrawn(const Sheet& sheet) {
  const auto& intervals = sheet.options.intervals;
  return static_cast<std::size_t>(
      std::count_if(intervals.begin(), intervals.end(), [&](const map::LockInterval& interval) {
        return std::any_of(interval.spans.begin(), interval.spans.end(),
                           [&](const map::IntervalSpan& span) { return sheet.shown[span.roadway]; });
      }));
}

std::string subtitle(const Sheet& sheet) {
  const map::TunnelMap& map = sheet.map;
  double length = 0.0;
  std::size_t roadways = 0;
  for (std::size_t i = 0; i < sheet.centrelines.size(); ++i) {
    if (!sheet.shown[i]) continue;
    length += sheet.centrelines[i].length();
    ++roadways;
  }
  std::string text = counted(roadways, "roadway", "roadways") + ", " +
                     (length >= 2000.0 ? rounded(length / 1000.0) + " km" : rounded(length) + " m");
  if (!sheet.options.level.empty()) text += " on level " + sheet.options.level;
  if (sheet.chambers_drawn > 0) text += ", " + counted(sheet.chambers_drawn, "chamber", "chambers");
  if (sheet.anchors_drawn > 0) text += ", " + counted(sheet.anchors_drawn, "anchor", "anchors");
  if (const std::size_t drawn = intervalsDrawn(sheet); drawn > 0)
    text += ", " + counted(drawn, "lock interval", "lock intervals");
  text += "; coordinates in m in the map frame";
  if (map.mine_grid && !map.mine_grid->name.empty()) {
    text += ", its origin at E " + fixed(map.mine_grid->easting, 3) + " N " +
            fixed(map.mine_grid->northing, 3) + " (" + map.mine_grid->name + ")";
  }
  return text;
}

std::string remarks(const Sheet& sheet) {
  std::string text;
  if (sheet.widened)
    text += "Narrow roadways are drawn " + fixed(kNarrowest, 0) + " px wide, wider than true to scale. ";
  if (sheet.labels_left_out > 0) {
    text += counted(sheet.labels_left_out, "label was", "labels were") +
            " left out for lack of room; a wider sheet shows more.";
  }
  return text;
}

struct Scaling {
  Pixel origin;
  double factor;

  Pixel operator()(const Pixel& p) const { return {origin.x + factor * p.x, origin.y + factor * p.y}; }
  void scale(std::vector<Pixel>& points, Paint& paint) const {
    for (Pixel& p : points) p = (*this)(p);
    paint.stroke_width *= factor;
    for (double& length : paint.dash) length *= factor;
  }
};

/// A part drawn around its own origin, enlarged.
void addScaled(Drawing& drawing, Drawing part, Pixel origin, double factor) {
  const Scaling scaling{origin, factor};
  for (Shape& shape : part.shapes) {
    if (auto* polygon = std::get_if<DrawnPolygon>(&shape)) scaling.scale(polygon->points, polygon->paint);
    if (auto* line = std::get_if<DrawnLine>(&shape)) scaling.scale(line->points, line->paint);
    if (auto* circle = std::get_if<DrawnCircle>(&shape)) {
      circle->centre = scaling(circle->centre);
      circle->radius *= factor;
      circle->paint.stroke_width *= factor;
    }
    if (auto* text = std::get_if<DrawnText>(&shape)) {
      text->at = scaling(text->at);
      text->size *= factor;
    }
    drawing.add(std::move(shape));
  }
}

}  // namespace

double titleHeight(double width) {
  return 64.0 * Sheet::marginScale(width);
}

void drawFrame(Sheet& sheet) {
  const Box& frame = sheet.frame;
  const Eigen::Vector2d low = sheet.mapPoint({frame.left, frame.bottom()});
  const Eigen::Vector2d high = sheet.mapPoint({frame.right(), frame.top});
  const double scale = sheet.marginScale();
  const double step = 2.0 * roundLength(90.0 * scale * sheet.metres_per_pixel);
  for (double x = step * std::ceil(low.x() / step); x <= high.x(); x += step) {
    const double px = sheet.pixel({x, 0.0}).x;
    sheet.drawing.add(
        DrawnLine{{{px, frame.top}, {px, frame.bottom()}}, {.stroke = "#e6eaee", .stroke_width = 1.0}});
    if (px < frame.left + 16.0 || px > frame.right() - 16.0) continue;
    sheet.drawing.add(DrawnText{.at = {px, frame.bottom() + 15.0 * scale},
                                .text = fixed(x, step < 1.0 ? 1 : 0),
                                .size = 11.0 * scale,
                                .colour = kMuted,
                                .anchor = TextAnchor::Middle});
  }
  for (double y = step * std::ceil(low.y() / step); y <= high.y(); y += step) {
    const double py = sheet.pixel({0.0, y}).y;
    sheet.drawing.add(
        DrawnLine{{{frame.left, py}, {frame.right(), py}}, {.stroke = "#e6eaee", .stroke_width = 1.0}});
    if (py < frame.top + 12.0 || py > frame.bottom() - 6.0) continue;
    const std::string text = fixed(y, step < 1.0 ? 1 : 0);
    sheet.drawing.add(DrawnText{.at = {frame.left + 4.0, py - 3.0},
                                .text = text,
                                .size = 11.0 * scale,
                                .colour = kMuted,
                                .halo = "#ffffff"});
    sheet.room().mark({frame.left, py - 14.0 * scale, textWidth(text, 11.0 * scale) + 6.0, 14.0 * scale},
                      Room::Mark::Hard);
  }
}

void drawMargins(Sheet& sheet) {
  const Box& frame = sheet.frame;
  sheet.drawing.add(DrawnPolygon{{{frame.left, frame.top},
                                  {frame.right(), frame.top},
                                  {frame.right(), frame.bottom()},
                                  {frame.left, frame.bottom()}},
                                 {.stroke = "#8b97a4", .stroke_width = 1.2}});
  const double scale = sheet.marginScale();
  const double width = frame.width / scale;
  Drawing title;
  title.add(
      DrawnText{.at = {0.0, 34.0}, .text = sheet.drawing.title, .size = 22.0, .colour = kInk, .bold = true});
  title.add(DrawnText{.at = {0.0, 54.0}, .text = subtitle(sheet), .size = 12.5, .colour = kMuted});
  Drawing below;
  const double top = 26.0;
  drawLegend(below, sheet, width, top);
  drawScaleBar(below, {width - 300.0, top + 22.0}, sheet.metres_per_pixel * scale);
  drawNorth(below, northOf(sheet.map), {width - 28.0, top + 24.0});
  below.add(DrawnText{.at = {0.0, legendHeight(sheet.map, sheet.options, frame.width) / scale - 12.0},
                      .text = remarks(sheet),
                      .size = 11.5,
                      .colour = kMuted});
  addScaled(sheet.drawing, std::move(title), {frame.left, 0.0}, scale);
  addScaled(sheet.drawing, std::move(below), {frame.left, frame.bottom()}, scale);
}

}  // namespace pos::report::plan
