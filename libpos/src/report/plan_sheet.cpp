#include <algorithm>
#include <cmath>

#include "plan_parts.hpp"
#include "pos/core/error.hpp"
#include "pos/report/text.hpp"

namespace pos::report::plan {
namespace {

constexpr double kMargin = 30.0;       // px around the frame
constexpr double kMostFrame = 3540.0;  // px
constexpr double kLeastFrame = 940.0;

struct Extent {
  Eigen::Vector2d low{1e300, 1e300};
  Eigen::Vector2d high{-1e300, -1e300};
  void add(const Eigen::Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

Extent extentOf(const map::TunnelMap& map, const std::vector<map::Centreline>& centrelines,
                const std::vector<bool>& shown) {
  Extent extent;
  for (std::size_t i = 0; i < centrelines.size(); ++i) {
    if (!shown[i]) continue;
    const double half = 0.5 * map.roadways[i].width;
    for (const auto& p : map::strip(centrelines[i], centrelines[i].chainageStart(),
                                    centrelines[i].chainageEnd(), half, -half, 0.1))
      extent.add(p);
  }
  const bool anchors_only = map.roadways.empty();
  if (anchors_only && map.grid) {
    const map::OccupancyGrid& grid = *map.grid;
    for (const double x : {0.0, grid.resolution * grid.columns}) {
      for (const double y : {0.0, grid.resolution * grid.rows})
        extent.add(grid.T_map_grid * Eigen::Vector2d(grid.x_min + x, grid.y_min + y));
    }
  }
  for (const map::Anchor& anchor : map.anchors) {
    if (anchors_only) extent.add(anchor.p_map.head<2>());
  }
  return extent;
}

/// m a pixel: roadways 7 px wide if the sheet allows it, never wider than 110 px.
double chosenScale(const map::TunnelMap& map, const Eigen::Vector2d& size, double frame_width) {
  std::vector<double> widths;
  for (const map::Roadway& roadway : map.roadways) widths.push_back(roadway.width);
  std::sort(widths.begin(), widths.end());
  const double width = widths.empty() ? 4.0 : widths[widths.size() / 2];
  if (frame_width > 0.0) return size.x() / frame_width;
  const double wanted =
      std::clamp(width / 7.0, size.x() / kMostFrame, std::max(size.x() / kLeastFrame, size.x() / kMostFrame));
  return std::max({wanted, width / 110.0, size.y() / 2400.0});
}

void requireUsable(const map::TunnelMap& map, const PlanOptions& options) {
  if (map.roadways.empty() && map.anchors.empty() && !map.grid) {
    throw ConfigError(Complaint{.what = "the map has nothing to draw",
                                .expected = "roadways or anchors",
                                .suggestion = "add roadways to the map"});
  }
  if (options.width != 0.0 && !(options.width >= 400.0 && options.width <= 20000.0)) {
    throw ConfigError(Complaint{.what = "the sheet cannot have this width",
                                .key = "width",
                                .got = fixed(options.width, 0) + " px",
                                .expected = "400 to 20000 px"});
  }
}

std::vector<bool> shownRoadways(const map::TunnelMap& map, const std::string& level) {
  std::vector<bool> shown;
  std::string levels;
  for (const map::Roadway& roadway : map.roadways) {
    shown.push_back(level.empty() || roadway.level == level);
    if (!roadway.level.empty() && levels.find("'" + roadway.level + "'") == std::string::npos)
      levels += (levels.empty() ? "'" : ", '") + roadway.level + "'";
  }
  if (!level.empty() && std::find(shown.begin(), shown.end(), true) == shown.end()) {
    throw ConfigError(Complaint{.what = "no roadway is on this level",
                                .key = "level",
                                .got = level,
                                .expected = levels.empty() ? "no level: the roadways name none" : levels});
  }
  return shown;
}

}  // namespace

Room::Room(double width, double height)
    : columns_(static_cast<int>(width / kCell) + 2),
      rows_(static_cast<int>(height / kCell) + 2),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0),
      limits_{0.0, 0.0, width, height} {}

void Room::mark(const Box& box, Mark with) {
  const int left = std::clamp(static_cast<int>(box.left / kCell), 0, columns_ - 1);
  const int right = std::clamp(static_cast<int>(box.right() / kCell), 0, columns_ - 1);
  const int top = std::clamp(static_cast<int>(box.top / kCell), 0, rows_ - 1);
  const int bottom = std::clamp(static_cast<int>(box.bottom() / kCell), 0, rows_ - 1);
  for (int row = top; row <= bottom; ++row) {
    for (int column = left; column <= right; ++column) {
      auto& cell = cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                          static_cast<std::size_t>(column)];
      cell = std::max(cell, static_cast<std::uint8_t>(with));
    }
  }
}

void Room::markLine(const std::vector<Pixel>& line, double width, Mark with) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double length = std::hypot(line[i + 1].x - line[i].x, line[i + 1].y - line[i].y);
    const int steps = static_cast<int>(length / kCell) + 1;
    for (int k = 0; k <= steps; ++k) {
      const double f = static_cast<double>(k) / steps;
      const Pixel p{line[i].x + f * (line[i + 1].x - line[i].x), line[i].y + f * (line[i + 1].y - line[i].y)};
      mark({p.x - 0.5 * width, p.y - 0.5 * width, width, width}, with);
    }
  }
}

bool Room::fits(const Box& box, Mark tolerated) const {
  if (box.left < limits_.left || box.right() > limits_.right() || box.top < limits_.top ||
      box.bottom() > limits_.bottom())
    return false;
  for (int row = static_cast<int>(box.top / kCell); row <= static_cast<int>(box.bottom() / kCell); ++row) {
    for (int column = static_cast<int>(box.left / kCell); column <= static_cast<int>(box.right() / kCell);
         ++column) {
      const auto cell = cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                               static_cast<std::size_t>(column)];
      if (cell > static_cast<std::uint8_t>(tolerated)) return false;
    }
  }
  return true;
}

Sheet::Sheet(const map::TunnelMap& drawn, const PlanOptions& wanted) : map(drawn), options(wanted) {
  requireUsable(map, options);
  shown = shownRoadways(map, options.level);
  for (const map::Roadway& roadway : map.roadways) centrelines.emplace_back(roadway);
  Extent extent = extentOf(map, centrelines, shown);
  const double span = std::max((extent.high - extent.low).maxCoeff(), 5.0);
  const Eigen::Vector2d size = (extent.high - extent.low).array() + 0.05 * span;
  const double asked = options.width > 0.0 ? options.width - 2.0 * kMargin - 90.0 : 0.0;
  metres_per_pixel = chosenScale(map, size, asked);
  // Room for labels outside the outermost roadways is counted in pixels.
  const double inner = std::max(size.x() / metres_per_pixel, 0.0) + 90.0;
  frame = {kMargin, 0.0, std::max(inner, kLeastFrame), std::max(size.y() / metres_per_pixel + 110.0, 220.0)};
  if (options.width > 0.0) frame.width = options.width - 2.0 * kMargin;
  frame.top = titleHeight(frame.width);
  const Eigen::Vector2d middle = 0.5 * (extent.low + extent.high);
  scale_x_ = middle.x() - 0.5 * frame.width * metres_per_pixel;
  scale_y_ = middle.y() + 0.5 * frame.height * metres_per_pixel;
  drawing.width = frame.right() + kMargin;
  drawing.height = frame.bottom() + legendHeight(map, options, frame.width);
  drawing.title = map.name.empty() ? "Plan of the mine" : "Plan of " + map.name;
  drawing.description = "Roadways, chambers and anchors seen from above, north up";
  room_ = Room(drawing.width, drawing.height);
  room_.limitTo({frame.left + 3.0, frame.top + 3.0, frame.width - 6.0, frame.height - 6.0});
}

double Sheet::marginScale(double frame_width) {
  return std::clamp(frame_width / 1400.0, 1.0, 2.0);
}

Pixel Sheet::pixel(const Eigen::Vector2d& p_map) const {
  return {frame.left + (p_map.x() - scale_x_) / metres_per_pixel,
          frame.top + (scale_y_ - p_map.y()) / metres_per_pixel};
}

Eigen::Vector2d Sheet::mapPoint(const Pixel& p) const {
  return {scale_x_ + (p.x - frame.left) * metres_per_pixel, scale_y_ - (p.y - frame.top) * metres_per_pixel};
}

std::vector<Pixel> Sheet::pixels(const map::PlanLine& line) const {
  std::vector<Pixel> points;
  points.reserve(line.size());
  for (const Eigen::Vector2d& p : line) points.push_back(pixel(p));
  return points;
}

double Sheet::halfWidth(map::RoadwayIndex roadway) const {
  return 0.5 * std::max(map.roadways[roadway].width, kNarrowest * metres_per_pixel);
}

std::optional<map::RoadwayIndex> Sheet::shownIndex(const std::string& roadway) const {
  for (std::size_t i = 0; i < map.roadways.size(); ++i) {
    if (map.roadways[i].id == roadway && shown[i]) return i;
  }
  return std::nullopt;
}

Sheet::Spot Sheet::spot(map::RoadwayIndex roadway, double chainage, double offset) const {
  const map::CentrelineState state = centrelines[roadway].at(chainage);
  const Eigen::Vector2d left(-std::sin(state.heading), std::cos(state.heading));
  return {.at = pixel(state.p_map.head<2>() + offset * left),
          .along = {std::cos(state.heading), -std::sin(state.heading)},
          .left = {left.x(), -left.y()}};
}

bool Sheet::place(const Label& label, Room::Mark tolerated) {
  const double width = textWidth(label.text, label.size, label.bold) + 2.0;
  const double height = 1.05 * label.size;
  const double angle = std::atan2(label.outward.y, label.outward.x);
  constexpr double kTurns[] = {0.0, 0.5, -0.5, 1.0, -1.0, 1.6, -1.6, 2.2, -2.2, 3.14};
  for (const double farther : {label.inside ? -1.0 : 0.0, 0.0, 7.0, 16.0}) {
    for (const double turn : kTurns) {
      const Pixel out{std::cos(angle + turn), std::sin(angle + turn)};
      // The box touches the circle of this radius around the point from outside.
      const double reach = farther < 0.0 ? 0.0
                                         : label.distance + farther + 0.5 * std::abs(out.x) * width +
                                               0.5 * std::abs(out.y) * height;
      const Pixel middle{label.at.x + reach * out.x, label.at.y + reach * out.y};
      const Box box{middle.x - 0.5 * width, middle.y - 0.5 * height, width, height};
      const bool inner = farther < 0.0;
      if (!room_.fits(box, inner ? Room::Mark::Soft : tolerated)) {
        if (inner) break;
        continue;
      }
      room_.mark(box, Room::Mark::Hard);
      if (farther > 0.0) {
        drawing.add(DrawnLine{{label.at,
                               {label.at.x + label.distance * 0.6 * out.x + farther * out.x,
                                label.at.y + label.distance * 0.6 * out.y + farther * out.y}},
                              {.stroke = "#9aa4af", .stroke_width = 0.7}});
      }
      drawing.add(DrawnText{.at = {middle.x, middle.y + 0.36 * label.size},
                            .text = label.text,
                            .size = label.size,
                            .colour = label.colour,
                            .anchor = TextAnchor::Middle,
                            .bold = label.bold,
                            .halo = "#ffffff"});
      return true;
    }
  }
  return false;
}

void Sheet::placeLabels() {
  for (const Label& label : labels_) {
    if (!place(label, Room::Mark::Free) && !place(label, Room::Mark::Soft)) ++labels_left_out;
  }
  labels_.clear();
}

}  // namespace pos::report::plan
