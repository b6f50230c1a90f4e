// Roadways between their walls, lock intervals on them, and crossings on different levels.
#include <algorithm>
#include <array>
#include <cmath>

#include "plan_parts.hpp"

namespace pos::report::plan {
namespace {

constexpr const char* kWall = "#3b4652";
constexpr const char* kFloor = "#eef1f4";

/// Light tints that stay apart in grey print; neighbours in order differ most.
constexpr std::array<const char*, 8> kTints{"#8ec5e8", "#f6c177", "#a8d8a0", "#e3a8cf",
                                            "#f3e08a", "#b7b3ea", "#f2a491", "#9fded8"};

struct Piece {
  std::size_t interval = 0;
  double from = 0.0;
  double to = 0.0;
  map::Lane lane = map::Lane::Both;
  std::size_t slot = 0;  // beside others that overlap it
  std::size_t slots = 1;
};

/// The spans of one lane cut where another begins or ends; those that overlap get places side by side.
std::vector<Piece> arranged(const std::vector<Piece>& spans) {
  std::vector<double> cuts;
  for (const Piece& span : spans) cuts.insert(cuts.end(), {span.from, span.to});
  std::sort(cuts.begin(), cuts.end());
  std::vector<Piece> pieces;
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    if (cuts[k + 1] - cuts[k] < 1e-6) continue;
    const std::size_t first = pieces.size();
    for (const Piece& span : spans) {
      if (span.from > cuts[k] + 1e-9 || span.to < cuts[k + 1] - 1e-9) continue;
      pieces.push_back({span.interval, cuts[k], cuts[k + 1], span.lane, pieces.size() - first, 1});
    }
    for (std::size_t i = first; i < pieces.size(); ++i) pieces[i].slots = pieces.size() - first;
  }
  return pieces;
}

std::vector<Piece> piecesOn(const Sheet& sheet, map::RoadwayIndex roadway) {
  std::array<std::vector<Piece>, 3> lanes;
  for (std::size_t i = 0; i < sheet.options.intervals.size(); ++i) {
    for (const map::IntervalSpan& span : sheet.options.intervals[i].spans) {
      if (span.roadway != roadway) continue;
      lanes[static_cast<std::size_t>(span.lane)].push_back(
          {i, std::min(span.from, span.to), std::max(span.from, span.to), span.lane});
    }
  }
  std::vector<Piece> all;
  for (auto& lane : lanes) {
    const auto pieces = arranged(lane);
    all.insert(all.end(), pieces.begin(), pieces.end());
  }
  return all;
}

struct Offsets {
  double left = 0.0;
  double right = 0.0;
};

/// Inside the walls, on the lane's own half, in its slot.
Offsets offsetsOf(const Sheet& sheet, map::RoadwayIndex roadway, const Piece& piece) {
  const double half = 0.86 * sheet.halfWidth(roadway);
  double low = -half;
  double high = half;
  if (piece.lane != map::Lane::Both) {
    const bool forward = piece.lane == map::Lane::Forward;
    const bool right = forward == (sheet.map.driving_side == map::Side::Right);
    low = right ? -half : 0.04 * half;
    high = right ? -0.04 * half : half;
  }
  const double step = (high - low) / static_cast<double>(piece.slots);
  const double top = high - step * static_cast<double>(piece.slot);
  return {top, top - (piece.slots > 1 ? 0.9 : 1.0) * step};
}

void drawWalls(Sheet& sheet, map::RoadwayIndex i, double from, double to) {
  const double half = sheet.halfWidth(i);
  const auto polygon =
      sheet.pixels(map::strip(sheet.centrelines[i], from, to, half, -half, sheet.tolerance()));
  sheet.drawing.add(DrawnPolygon{polygon, {.stroke = kWall, .stroke_width = 2.6}});
}

void drawFloor(Sheet& sheet, map::RoadwayIndex i, double from, double to) {
  const double half = sheet.halfWidth(i);
  const auto polygon =
      sheet.pixels(map::strip(sheet.centrelines[i], from, to, half, -half, sheet.tolerance()));
  sheet.drawing.add(DrawnPolygon{polygon, {.fill = kFloor}});
}

void drawLaneLine(Sheet& sheet, map::RoadwayIndex i, double from, double to) {
  if (sheet.map.roadways[i].lanes != 2) return;
  const auto chainages = map::sampleChainages(sheet.centrelines[i], from, to, sheet.tolerance());
  sheet.drawing.add(DrawnLine{sheet.pixels(map::offsetLine(sheet.centrelines[i], chainages, 0.0)),
                              {.stroke = "#6b7683", .stroke_width = 0.8, .dash = {7.0, 5.0}}});
}

/// Chevrons along a one-way roadway, every 160 px.
void drawOneWay(Sheet& sheet, map::RoadwayIndex i) {
  const map::Traffic traffic = sheet.map.roadways[i].traffic;
  if (traffic == map::Traffic::BothWays) return;
  const double sign = traffic == map::Traffic::ForwardOnly ? 1.0 : -1.0;
  const double step = 160.0 * sheet.metres_per_pixel;
  const map::Centreline& line = sheet.centrelines[i];
  for (double chainage = line.chainageStart() + 0.5 * std::min(step, line.length());
       chainage < line.chainageEnd(); chainage += step) {
    const Sheet::Spot s = sheet.spot(i, chainage);
    const double arm = std::clamp(0.5 * sheet.halfWidth(i) / sheet.metres_per_pixel, 3.0, 9.0);
    const Pixel tip{s.at.x + sign * arm * s.along.x, s.at.y + sign * arm * s.along.y};
    const Pixel back{s.at.x - sign * arm * s.along.x, s.at.y - sign * arm * s.along.y};
    sheet.drawing.add(DrawnLine{{{back.x + arm * s.left.x, back.y + arm * s.left.y},
                                 tip,
                                 {back.x - arm * s.left.x, back.y - arm * s.left.y}},
                                {.stroke = kWall, .stroke_width = 1.4}});
  }
}

void nameRoadway(Sheet& sheet, map::RoadwayIndex i) {
  const map::Roadway& roadway = sheet.map.roadways[i];
  const map::Centreline& line = sheet.centrelines[i];
  const std::string text = roadway.name.empty() ? roadway.id : roadway.id + " " + roadway.name;
  const Sheet::Spot s = sheet.spot(i, line.chainageStart() + 0.38 * line.length(), sheet.halfWidth(i));
  sheet.label({.at = s.at, .outward = s.left, .distance = 20.0, .text = text, .size = 14.0, .bold = true});
}

/// For each interval whose longest span is on this roadway, the longest piece of it.
std::vector<Piece> labelPieces(const Sheet& sheet, map::RoadwayIndex roadway) {
  std::vector<Piece> longest;
  for (const Piece& piece : piecesOn(sheet, roadway)) {
    const auto& spans = sheet.options.intervals[piece.interval].spans;
    const auto main = std::max_element(spans.begin(), spans.end(),
                                       [](const auto& a, const auto& b) { return a.length() < b.length(); });
    if (main->roadway != roadway) continue;
    const auto same = std::find_if(longest.begin(), longest.end(),
                                   [&](const Piece& p) { return p.interval == piece.interval; });
    if (same == longest.end()) {
      longest.push_back(piece);
    } else if (piece.to - piece.from > same->to - same->from) {
      *same = piece;
    }
  }
  return longest;
}

void labelInterval(Sheet& sheet, map::RoadwayIndex roadway, const Piece& piece) {
  const Offsets offsets = offsetsOf(sheet, roadway, piece);
  const Sheet::Spot s =
      sheet.spot(roadway, 0.5 * (piece.from + piece.to), 0.5 * (offsets.left + offsets.right));
  const bool left = offsets.left + offsets.right > 0.0;
  sheet.label({.at = s.at,
               .outward = left ? s.left : Pixel{-s.left.x, -s.left.y},
               .distance = sheet.halfWidth(roadway) / sheet.metres_per_pixel + 5.0,
               .text = sheet.options.intervals[piece.interval].label(),
               .size = 11.0,
               .colour = "#223344",
               .inside = (offsets.left - offsets.right) / sheet.metres_per_pixel > 13.0});
}

}  // namespace

Colour intervalColour(std::size_t interval) {
  return kTints[interval % kTints.size()];
}

void drawIntervalStrips(Sheet& sheet, map::RoadwayIndex roadway, double from, double to) {
  const double gap = 0.5 * sheet.metres_per_pixel;
  for (const Piece& piece : piecesOn(sheet, roadway)) {
    const double low = std::max(piece.from + gap, from);
    const double high = std::min(piece.to - gap, to);
    if (high <= low) continue;
    const Offsets offsets = offsetsOf(sheet, roadway, piece);
    const auto polygon = sheet.pixels(
        map::strip(sheet.centrelines[roadway], low, high, offsets.left, offsets.right, sheet.tolerance()));
    sheet.drawing.add(DrawnPolygon{polygon, {.fill = intervalColour(piece.interval)}});
  }
}

void drawRoadways(Sheet& sheet) {
  for (std::size_t i = 0; i < sheet.centrelines.size(); ++i) {
    if (!sheet.shown[i]) continue;
    const map::Centreline& line = sheet.centrelines[i];
    sheet.widened = sheet.widened || sheet.map.roadways[i].width < kNarrowest * sheet.metres_per_pixel;
    drawWalls(sheet, i, line.chainageStart(), line.chainageEnd());
    const auto chainages =
        map::sampleChainages(line, line.chainageStart(), line.chainageEnd(), sheet.tolerance());
    sheet.room().markLine(sheet.pixels(map::offsetLine(line, chainages, 0.0)),
                          2.0 * sheet.halfWidth(i) / sheet.metres_per_pixel, Room::Mark::Soft);
  }
  // Floors after all walls: where roadways meet, the way is open.
  for (std::size_t i = 0; i < sheet.centrelines.size(); ++i) {
    if (!sheet.shown[i]) continue;
    drawFloor(sheet, i, sheet.centrelines[i].chainageStart(), sheet.centrelines[i].chainageEnd());
    nameRoadway(sheet, i);
  }
}

void drawIntervals(Sheet& sheet) {
  for (std::size_t i = 0; i < sheet.centrelines.size(); ++i) {
    if (!sheet.shown[i]) continue;
    const double start = sheet.centrelines[i].chainageStart();
    const double end = sheet.centrelines[i].chainageEnd();
    drawIntervalStrips(sheet, i, start, end);
    drawLaneLine(sheet, i, start, end);
    drawOneWay(sheet, i);
    for (const Piece& piece : labelPieces(sheet, i)) labelInterval(sheet, i, piece);
  }
}

void drawCrossings(Sheet& sheet) {
  for (const map::Crossing& crossing : sheet.map.crossings) {
    const auto upper = sheet.shownIndex(crossing.upper.roadway);
    const auto lower = sheet.shownIndex(crossing.lower.roadway);
    if (!upper || !lower) continue;
    const map::Centreline& line = sheet.centrelines[*upper];
    const double reach = 2.0 * sheet.halfWidth(*lower) + 8.0 * sheet.metres_per_pixel;
    const double from = std::max(line.chainageStart(), crossing.upper.chainage - reach);
    const double to = std::min(line.chainageEnd(), crossing.upper.chainage + reach);
    const double half = sheet.halfWidth(*upper);
    drawFloor(sheet, *upper, from, to);
    drawIntervalStrips(sheet, *upper, from, to);
    drawLaneLine(sheet, *upper, from, to);
    const auto chainages = map::sampleChainages(line, from, to, sheet.tolerance(), half);
    for (const double side : {half, -half}) {
      sheet.drawing.add(DrawnLine{sheet.pixels(map::offsetLine(line, chainages, side)),
                                  {.stroke = kWall, .stroke_width = 2.6}});
    }
  }
}

}  // namespace pos::report::plan
