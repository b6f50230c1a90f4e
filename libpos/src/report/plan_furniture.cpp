// What stands in and along the roadways, and the chainage.
#include <algorithm>
#include <cmath>

#include "plan_parts.hpp"
#include "pos/report/axes.hpp"
#include "pos/report/text.hpp"

namespace pos::report::plan {
namespace {

Pixel moved(const Pixel& p, const Pixel& direction, double by) {
  return {p.x + by * direction.x, p.y + by * direction.y};
}
Pixel opposite(const Pixel& p) {
  return {-p.x, -p.y};
}
Box around(const Pixel& p, double half) {
  return {p.x - half, p.y - half, 2.0 * half, 2.0 * half};
}

void drawChamber(Sheet& sheet, const map::Chamber& chamber) {
  const auto i = sheet.shownIndex(chamber.place.roadway);
  if (!i) return;
  ++sheet.chambers_drawn;
  const bool refuge = chamber.kind == map::Chamber::Kind::Refuge;
  const double least = 6.0 * sheet.metres_per_pixel;
  const double half = sheet.halfWidth(*i);
  const double sign = chamber.side == map::Side::Left ? 1.0 : -1.0;
  const double half_length = 0.5 * std::max(chamber.length, least);
  const double depth = std::max(chamber.depth, least);
  const auto polygon = sheet.pixels(map::strip(sheet.centrelines[*i], chamber.place.chainage - half_length,
                                               chamber.place.chainage + half_length, sign * (half + depth),
                                               sign * half, sheet.tolerance()));
  sheet.drawing.add(DrawnPolygon{polygon,
                                 {.fill = refuge ? "#fbdca6" : "#bfe6cf",
                                  .stroke = refuge ? "#a76b00" : "#1c7a4c",
                                  .stroke_width = 1.3}});
  const double depth_px = depth / sheet.metres_per_pixel;
  const Sheet::Spot s = sheet.spot(*i, chamber.place.chainage, sign * (half + 0.5 * depth));
  sheet.room().markLine({moved(s.at, s.along, -half_length / sheet.metres_per_pixel),
                         moved(s.at, s.along, half_length / sheet.metres_per_pixel)},
                        depth_px, Room::Mark::Hard);
  sheet.label({.at = s.at,
               .outward = sign > 0.0 ? s.left : opposite(s.left),
               .distance = 0.5 * depth_px + 3.0,
               .text = chamber.id,
               .size = 10.5,
               .colour = refuge ? "#7a4e00" : "#115c37"});
}

void drawAnchor(Sheet& sheet, const map::Anchor& anchor) {
  const Pixel at = sheet.pixel(anchor.p_map.head<2>());
  Pixel outward{0.0, -1.0};
  double nearest = 1e300;
  for (std::size_t i = 0; i < sheet.centrelines.size(); ++i) {
    const map::Centreline::Foot foot = sheet.centrelines[i].foot(anchor.p_map);
    const double distance = std::hypot(foot.offset, foot.beyond) + std::abs(foot.height);
    if (distance >= nearest) continue;
    nearest = distance;
    const Sheet::Spot s = sheet.spot(i, foot.chainage);
    outward = foot.offset >= 0.0 ? s.left : opposite(s.left);
    if (!sheet.shown[i]) outward = {0.0, 0.0};
  }
  if (outward.x == 0.0 && outward.y == 0.0) return;  // it belongs to another level
  ++sheet.anchors_drawn;
  const double r = 4.6;
  sheet.drawing.add(DrawnPolygon{{{at.x, at.y - r}, {at.x + r, at.y + 0.8 * r}, {at.x - r, at.y + 0.8 * r}},
                                 {.fill = "#1f5fbf", .stroke = "#ffffff", .stroke_width = 0.9}});
  sheet.room().mark(around(at, r), Room::Mark::Hard);
  sheet.label({.at = at,
               .outward = outward,
               .distance = 6.0,
               .text = std::to_string(anchor.id),
               .size = 10.5,
               .colour = "#17478f"});
}

Eigen::Vector2d junctionPlace(const Sheet& sheet, const map::Junction& junction, int& found) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  found = 0;
  for (const map::RoadwayPlace& place : junction.places) {
    const auto i = sheet.shownIndex(place.roadway);
    if (!i) continue;
    sum += sheet.centrelines[*i].at(place.chainage).p_map.head<2>();
    ++found;
  }
  return found > 0 ? Eigen::Vector2d(sum / found) : sum;
}

void drawJunction(Sheet& sheet, const map::Junction& junction) {
  int found = 0;
  const Pixel at = sheet.pixel(junctionPlace(sheet, junction, found));
  if (found == 0) return;
  sheet.drawing.add(DrawnCircle{at, 5.0, {.fill = "#ffffff", .stroke = "#1c2530", .stroke_width = 1.8}});
  sheet.room().mark(around(at, 6.0), Room::Mark::Hard);
  sheet.label({.at = at,
               .outward = {0.7, -0.7},
               .distance = 12.0,
               .text = junction.name.empty() ? junction.id : junction.id + " " + junction.name,
               .size = 12.0,
               .bold = true});
}

void drawPortal(Sheet& sheet, const map::Portal& portal) {
  const auto i = sheet.shownIndex(portal.place.roadway);
  if (!i) return;
  const double half = sheet.halfWidth(*i);
  const auto zone =
      sheet.pixels(map::offsetLine(sheet.centrelines[*i],
                                   map::sampleChainages(sheet.centrelines[*i], portal.handover_from,
                                                        portal.handover_to, sheet.tolerance()),
                                   0.0));
  if (portal.handover_to > portal.handover_from)
    sheet.drawing.add(DrawnLine{zone, {.stroke = "#0b8f8f", .stroke_width = 2.2, .dash = {3.0, 3.0}}});
  const Sheet::Spot s = sheet.spot(*i, portal.place.chainage);
  const double arm = half / sheet.metres_per_pixel + 6.0;
  sheet.drawing.add(DrawnLine{{moved(s.at, s.left, -arm), moved(s.at, s.left, arm)},
                              {.stroke = "#0b8f8f", .stroke_width = 4.0}});
  sheet.room().markLine({moved(s.at, s.left, -arm), moved(s.at, s.left, arm)}, 5.0, Room::Mark::Hard);
  const map::Centreline& line = sheet.centrelines[*i];
  const bool at_start = portal.place.chainage < line.chainageStart() + 0.5 * line.length();
  sheet.label({.at = s.at,
               .outward = at_start ? opposite(s.along) : s.along,
               .distance = 8.0,
               .text = portal.name.empty() ? portal.id : portal.name,
               .size = 12.5,
               .colour = "#086b6b",
               .bold = true});
}

void drawLight(Sheet& sheet, const map::Light& light) {
  const auto i = sheet.shownIndex(light.place.roadway);
  if (!i) return;
  const double sign = light.side == map::Side::Left ? 1.0 : -1.0;
  const Sheet::Spot s = sheet.spot(*i, light.place.chainage, sign * sheet.halfWidth(*i));
  const Pixel at = moved(s.at, s.left, sign * 5.0);
  sheet.drawing.add(DrawnCircle{at, 3.6, {.fill = "#e23b3b", .stroke = "#1c2530", .stroke_width = 1.0}});
  sheet.room().mark(around(at, 4.5), Room::Mark::Hard);
  sheet.label({.at = at,
               .outward = sign > 0.0 ? s.left : opposite(s.left),
               .distance = 5.0,
               .text = light.id,
               .size = 10.0,
               .colour = "#8e1f1f"});
}

void drawStopLine(Sheet& sheet, const map::StopLine& stop) {
  const auto i = sheet.shownIndex(stop.place.roadway);
  if (!i) return;
  const double half = sheet.halfWidth(*i);
  const Sheet::Spot left = sheet.spot(*i, stop.place.chainage, half);
  const Sheet::Spot right = sheet.spot(*i, stop.place.chainage, -half);
  sheet.drawing.add(DrawnLine{{left.at, right.at}, {.stroke = "#b71c1c", .stroke_width = 2.4}});
}

void drawZone(Sheet& sheet, const map::RestrictedZone& zone) {
  const auto i = sheet.shownIndex(zone.stretch.roadway);
  if (!i) return;
  const double half = sheet.halfWidth(*i) + 3.0 * sheet.metres_per_pixel;
  const auto polygon = sheet.pixels(
      map::strip(sheet.centrelines[*i], zone.stretch.from, zone.stretch.to, half, -half, sheet.tolerance()));
  sheet.drawing.add(DrawnPolygon{polygon, {.stroke = "#c62828", .stroke_width = 1.8, .dash = {6.0, 3.0}}});
  const Sheet::Spot s = sheet.spot(*i, 0.5 * (zone.stretch.from + zone.stretch.to));
  sheet.label({.at = s.at,
               .outward = opposite(s.left),
               .distance = half / sheet.metres_per_pixel + 4.0,
               .text = zone.name.empty() ? zone.id : zone.name,
               .size = 11.0,
               .colour = "#a31515"});
}

/// Ticks stand on the right wall (seen along growing chainage) and point outwards, but not into another
/// roadway or a chamber.
void drawTicks(Sheet& sheet, map::RoadwayIndex i) {
  const map::Centreline& line = sheet.centrelines[i];
  const double major = roundStep(std::max(80.0 * sheet.metres_per_pixel, 1.0));
  const double minor = major / 5.0;
  const double half = sheet.halfWidth(i);
  for (double k = std::ceil(line.chainageStart() / minor - 1e-9); k * minor <= line.chainageEnd() + 1e-9;
       k += 1.0) {
    const double chainage = k * minor;
    const bool labelled = std::abs(std::remainder(chainage, major)) < 1e-6 * major;
    const Sheet::Spot s = sheet.spot(i, chainage, -half);
    const Pixel out = opposite(s.left);
    const Pixel tip = moved(s.at, out, labelled ? 8.0 : 4.0);
    const Pixel beyond = moved(s.at, out, 9.0);
    if (!sheet.room().fits({beyond.x - 1.0, beyond.y - 1.0, 2.0, 2.0}, Room::Mark::Free)) continue;
    sheet.drawing.add(DrawnLine{{s.at, tip}, {.stroke = "#4a5663", .stroke_width = labelled ? 1.3 : 0.8}});
    if (!labelled) continue;
    sheet.room().markLine({s.at, tip}, 2.0, Room::Mark::Hard);
    sheet.label({.at = tip,
                 .outward = out,
                 .distance = 2.0,
                 .text = tickText(chainage == 0.0 ? 0.0 : chainage),
                 .size = 10.0,
                 .colour = "#4a5663"});
  }
}

}  // namespace

void drawFurniture(Sheet& sheet) {
  for (const auto& zone : sheet.map.zones) drawZone(sheet, zone);
  for (const auto& chamber : sheet.map.chambers) drawChamber(sheet, chamber);
  for (const auto& stop : sheet.map.stop_lines) drawStopLine(sheet, stop);
  for (const auto& portal : sheet.map.portals) drawPortal(sheet, portal);
  for (const auto& junction : sheet.map.junctions) drawJunction(sheet, junction);
  for (const auto& light : sheet.map.lights) drawLight(sheet, light);
  for (const auto& anchor : sheet.map.anchors) drawAnchor(sheet, anchor);
}

void drawChainage(Sheet& sheet) {
  for (std::size_t i = 0; i < sheet.centrelines.size(); ++i) {
    if (sheet.shown[i]) drawTicks(sheet, i);
  }
}

}  // namespace pos::report::plan
