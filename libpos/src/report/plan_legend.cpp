// What the signs of a plan mean.
#include <algorithm>
#include <cmath>
#include <functional>

#include "plan_parts.hpp"

namespace pos::report::plan {
namespace {

constexpr const char* kInk = "#1c2530";
constexpr double kEntry = 200.0;       // px a column of the legend
constexpr double kRow = 24.0;          // px a row
constexpr double kRightBlock = 330.0;  // px for scale bar and north arrow

struct Entry {
  std::string text;
  std::function<void(Drawing&, Pixel)> sign;  // 30 px wide, around the point
};

void band(Drawing& drawing, Pixel at, double height, const Paint& paint) {
  drawing.add(DrawnPolygon{{{at.x - 15.0, at.y - height},
                            {at.x + 15.0, at.y - height},
                            {at.x + 15.0, at.y + height},
                            {at.x - 15.0, at.y + height}},
                           paint});
}

template <class T, class Test>
bool any(const std::vector<T>& list, Test test) {
  return std::any_of(list.begin(), list.end(), test);
}

void addRoadEntries(std::vector<Entry>& entries, const map::TunnelMap& map, const PlanOptions& options) {
  if (!map.roadways.empty()) {
    entries.push_back({"roadway", [](Drawing& d, Pixel p) {
                         band(d, p, 5.0, {.fill = "#eef1f4", .stroke = "#3b4652", .stroke_width = 1.3});
                       }});
    entries.push_back({"chainage (m)", [](Drawing& d, Pixel p) {
                         for (const double x : {-10.0, 0.0, 10.0}) {
                           d.add(DrawnLine{{{p.x + x, p.y - 4.0}, {p.x + x, p.y + 4.0}},
                                           {.stroke = "#4a5663", .stroke_width = 1.2}});
                         }
                       }});
  }
  if (any(map.roadways, [](const map::Roadway& r) { return r.lanes == 2; })) {
    entries.push_back({"two lanes", [](Drawing& d, Pixel p) {
                         d.add(DrawnLine{{{p.x - 15.0, p.y}, {p.x + 15.0, p.y}},
                                         {.stroke = "#6b7683", .stroke_width = 1.0, .dash = {7.0, 5.0}}});
                       }});
  }
  if (any(map.roadways, [](const map::Roadway& r) { return r.traffic != map::Traffic::BothWays; })) {
    entries.push_back({"one way", [](Drawing& d, Pixel p) {
                         d.add(DrawnLine{{{p.x - 5.0, p.y - 6.0}, {p.x + 5.0, p.y}, {p.x - 5.0, p.y + 6.0}},
                                         {.stroke = "#3b4652", .stroke_width = 1.5}});
                       }});
  }
  if (!options.intervals.empty()) {
    entries.push_back({"lock intervals", [](Drawing& d, Pixel p) {
                         for (int k = 0; k < 3; ++k) {
                           d.add(DrawnPolygon{{{p.x - 15.0 + 10.0 * k, p.y - 5.0},
                                               {p.x - 6.0 + 10.0 * k, p.y - 5.0},
                                               {p.x - 6.0 + 10.0 * k, p.y + 5.0},
                                               {p.x - 15.0 + 10.0 * k, p.y + 5.0}},
                                              {.fill = intervalColour(static_cast<std::size_t>(k))}});
                         }
                       }});
  }
}

void addPlaceEntries(std::vector<Entry>& entries, const map::TunnelMap& map) {
  if (!map.junctions.empty()) {
    entries.push_back({"junction", [](Drawing& d, Pixel p) {
                         d.add(DrawnCircle{p, 5.0, {.fill = "#ffffff", .stroke = kInk, .stroke_width = 1.8}});
                       }});
  }
  if (!map.portals.empty()) {
    entries.push_back({"portal, GNSS zone", [](Drawing& d, Pixel p) {
                         d.add(DrawnLine{{{p.x - 10.0, p.y - 8.0}, {p.x - 10.0, p.y + 8.0}},
                                         {.stroke = "#0b8f8f", .stroke_width = 4.0}});
                         d.add(DrawnLine{{{p.x - 6.0, p.y}, {p.x + 15.0, p.y}},
                                         {.stroke = "#0b8f8f", .stroke_width = 2.2, .dash = {3.0, 3.0}}});
                       }});
  }
  if (!map.zones.empty()) {
    entries.push_back({"restricted zone", [](Drawing& d, Pixel p) {
                         band(d, p, 6.0, {.stroke = "#c62828", .stroke_width = 1.8, .dash = {6.0, 3.0}});
                       }});
  }
}

void addThingEntries(std::vector<Entry>& entries, const map::TunnelMap& map) {
  using Kind = map::Chamber::Kind;
  if (any(map.chambers, [](const map::Chamber& c) { return c.kind == Kind::Passing; })) {
    entries.push_back({"passing chamber", [](Drawing& d, Pixel p) {
                         band(d, p, 5.0, {.fill = "#bfe6cf", .stroke = "#1c7a4c", .stroke_width = 1.3});
                       }});
  }
  if (any(map.chambers, [](const map::Chamber& c) { return c.kind == Kind::Refuge; })) {
    entries.push_back({"refuge chamber", [](Drawing& d, Pixel p) {
                         band(d, p, 5.0, {.fill = "#fbdca6", .stroke = "#a76b00", .stroke_width = 1.3});
                       }});
  }
  if (!map.anchors.empty()) {
    entries.push_back({"anchor with its id", [](Drawing& d, Pixel p) {
                         d.add(
                             DrawnPolygon{{{p.x, p.y - 5.0}, {p.x + 5.0, p.y + 4.0}, {p.x - 5.0, p.y + 4.0}},
                                          {.fill = "#1f5fbf"}});
                       }});
  }
  if (!map.lights.empty()) {
    entries.push_back({"light", [](Drawing& d, Pixel p) {
                         d.add(DrawnCircle{p, 3.6, {.fill = "#e23b3b", .stroke = kInk, .stroke_width = 1.0}});
                       }});
  }
  if (!map.stop_lines.empty()) {
    entries.push_back(
        {"stop line", [](Drawing& d, Pixel p) {
           d.add(DrawnLine{{{p.x, p.y - 7.0}, {p.x, p.y + 7.0}}, {.stroke = "#b71c1c", .stroke_width = 2.4}});
         }});
  }
}

std::vector<Entry> legendEntries(const map::TunnelMap& map, const PlanOptions& options) {
  std::vector<Entry> entries;
  addRoadEntries(entries, map, options);
  addPlaceEntries(entries, map);
  addThingEntries(entries, map);
  return entries;
}

std::size_t columnsOf(double width) {
  return static_cast<std::size_t>(std::max(1.0, std::floor((width - kRightBlock) / kEntry)));
}

}  // namespace

void drawLegend(Drawing& drawing, const Sheet& sheet, double width, double top) {
  const auto entries = legendEntries(sheet.map, sheet.options);
  const std::size_t columns = columnsOf(width);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const Pixel at{20.0 + kEntry * static_cast<double>(k % columns),
                   top + kRow * (static_cast<double>(k / columns) + 0.5)};
    entries[k].sign(drawing, at);
    drawing.add(
        DrawnText{.at = {at.x + 24.0, at.y + 4.5}, .text = entries[k].text, .size = 12.5, .colour = kInk});
  }
}

double legendHeight(const map::TunnelMap& map, const PlanOptions& options, double width) {
  const double scale = Sheet::marginScale(width);
  const std::size_t columns = columnsOf(width / scale);
  const std::size_t rows = (legendEntries(map, options).size() + columns - 1) / columns;
  return scale * (std::max(78.0, kRow * static_cast<double>(rows) + 22.0) + 44.0);
}

}  // namespace pos::report::plan
