#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "figure_parts.hpp"
#include "pos/report/axes.hpp"
#include "pos/report/png.hpp"
#include "pos/report/text.hpp"

namespace pos::report {

namespace {

using eval::PathPoint;

/// Blue over magenta to orange: no red-green contrast is needed, and both ends show on white and on dark
/// paper.
constexpr std::array<std::string_view, 8> kErrorColours{"#2f6fd0", "#6a63cf", "#9657c0", "#b94aa5",
                                                        "#d24580", "#e05258", "#e8702f", "#f0980f"};

struct Extent {
  double x_low = 1e300, x_high = -1e300, y_low = 1e300, y_high = -1e300;
  void add(double x, double y) {
    x_low = std::min(x_low, x);
    x_high = std::max(x_high, x);
    y_low = std::min(y_low, y);
    y_high = std::max(y_high, y);
  }
  bool empty() const { return x_low > x_high; }
};

/// What must be in sight: truth, anchors and the best estimator; without truth every estimator.
Extent extentOf(const eval::RunSummary& run) {
  Extent extent;
  const auto addPath = [&extent](const std::vector<PathPoint>& path) {
    for (const PathPoint& p : path) extent.add(p.x, p.y);
  };
  addPath(run.truth_path);
  if (run.tunnel_map) {
    for (const map::Anchor& anchor : run.tunnel_map->anchors) extent.add(anchor.p_map.x(), anchor.p_map.y());
  }
  for (const eval::EstimatorSummary& estimator : run.estimators) {
    if (run.truth_path.empty() || &estimator == run.best()) addPath(estimator.path);
  }
  return extent;
}

/// A plot of equal scale in x and y around the extent.
Plot planPlot(const Extent& extent, double top, double width) {
  const double span = std::max({extent.x_high - extent.x_low, extent.y_high - extent.y_low, 1.0});
  const double pad = 0.06 * span;
  const double dx = std::max(extent.x_high - extent.x_low, 0.02 * span) + 2.0 * pad;
  const double dy = std::max(extent.y_high - extent.y_low, 0.02 * span) + 2.0 * pad;
  const double height = std::clamp(width * dy / dx, 240.0, 720.0);
  const double metres_per_pixel = std::max(dx / width, dy / height);
  const double cx = 0.5 * (extent.x_low + extent.x_high);
  const double cy = 0.5 * (extent.y_low + extent.y_high);
  const double half_x = 0.5 * metres_per_pixel * width;
  const double half_y = 0.5 * metres_per_pixel * height;
  return plotOver({kLeft, top, width, height}, cx - half_x, cx + half_x, cy - half_y, cy + half_y);
}

void drawGrid(Svg& svg, const Plot& plot, const map::OccupancyGrid& grid) {
  const GridPicture drawn = gridPicture(grid);
  const double y_top = grid.y_min + grid.resolution * grid.rows;
  const double step = grid.resolution * drawn.step;
  const auto pixel = [&](double x, double y) {
    const Eigen::Vector2d p = grid.T_map_grid * Eigen::Vector2d(x, y);
    return plot(p.x(), p.y());
  };
  const Pixel origin = pixel(grid.x_min, y_top);
  const Pixel u = pixel(grid.x_min + step, y_top);
  const Pixel v = pixel(grid.x_min, y_top - step);
  svg.image(pngBytes(drawn.picture), drawn.picture.columns, drawn.picture.rows, origin,
            {u.x - origin.x, u.y - origin.y}, {v.x - origin.x, v.y - origin.y});
}

std::vector<Pixel> pixels(const Plot& plot, const std::vector<PathPoint>& path) {
  std::vector<Pixel> points;
  for (const PathPoint& p : path) points.push_back(plot(p.x, p.y));
  return points;
}

std::size_t colourOf(double error, double saturation) {
  const auto bin = static_cast<std::size_t>(std::max(0.0, error / saturation) * kErrorColours.size());
  return std::min(bin, kErrorColours.size() - 1);
}

/// The path in pieces of one colour each.
void drawColoured(Svg& svg, const Plot& plot, const std::vector<PathPoint>& path, double saturation) {
  std::size_t first = 0;
  for (std::size_t i = 1; i <= path.size(); ++i) {
    const std::size_t colour = colourOf(path[first].error_xy.value_or(0.0), saturation);
    if (i < path.size() && colourOf(path[i].error_xy.value_or(0.0), saturation) == colour) continue;
    std::vector<Pixel> piece;
    for (std::size_t k = first; k < std::min(i + 1, path.size()); ++k)
      piece.push_back(plot(path[k].x, path[k].y));
    svg.colouredLine(piece, kErrorColours[colour]);
    first = i;
    if (first >= path.size()) break;
  }
}

void drawAnchors(Svg& svg, const Plot& plot, const std::vector<map::Anchor>& anchors) {
  for (const map::Anchor& anchor : anchors) {
    const Pixel at = plot(anchor.p_map.x(), anchor.p_map.y());
    svg.polygon({{at.x, at.y - 7.0}, {at.x + 6.5, at.y + 5.0}, {at.x - 6.5, at.y + 5.0}}, "anchor");
    const bool near_right = at.x > plot.box.right() - 46.0;
    svg.text({at.x + (near_right ? -10.0 : 10.0), at.y + 4.0}, std::to_string(anchor.id),
             near_right ? "end strong halo" : "start strong halo");
  }
}

/// Bottom left, or bottom right where an anchor is in the way.
void drawScaleBar(Svg& svg, const Plot& plot, const std::vector<map::Anchor>& anchors) {
  const double metres_per_pixel = (plot.x.high - plot.x.low) / plot.box.width;
  const double length = roundLength(160.0 * metres_per_pixel);
  const double pixels_long = length / metres_per_pixel;
  const double y = plot.box.bottom() - 14.0;
  const double room = pixels_long + 40.0;
  const bool taken = std::any_of(anchors.begin(), anchors.end(), [&](const map::Anchor& anchor) {
    const Pixel at = plot(anchor.p_map.x(), anchor.p_map.y());
    return at.x < plot.box.left + room && at.y > y - 44.0;
  });
  const double x = taken ? plot.box.right() - 14.0 - pixels_long : plot.box.left + 14.0;
  svg.rect({x - 8.0, y - 24.0, pixels_long + 16.0, 33.0}, "paper");
  svg.line({x, y}, {x + pixels_long, y}, "inkline");
  svg.line({x, y - 5.0}, {x, y + 5.0}, "inkline");
  svg.line({x + pixels_long, y - 5.0}, {x + pixels_long, y + 5.0}, "inkline");
  svg.text({x + 0.5 * pixels_long, y - 8.0}, tickText(length) + " m", "middle halo");
}

void drawNorth(Svg& svg, const Plot& plot) {
  const double x = plot.box.right() - 18.0;
  const double y = plot.box.top + 14.0;
  svg.polygon({{x, y - 2.0}, {x + 6.0, y + 18.0}, {x, y + 13.0}, {x - 6.0, y + 18.0}}, "inkfill");
  svg.text({x, y + 33.0}, "N", "middle strong halo");
}

void drawColourBar(Svg& svg, const Plot& plot, double saturation) {
  const double left = plot.box.right() + 26.0;
  const double height = std::min(plot.box.height - 30.0, 220.0);
  const double step = height / kErrorColours.size();
  const double bottom = plot.box.top + 20.0 + height;
  for (std::size_t i = 0; i < kErrorColours.size(); ++i) {
    svg.colouredRect({left, bottom - step * static_cast<double>(i + 1), 16.0, step + 0.3}, kErrorColours[i]);
  }
  for (const std::size_t i : {std::size_t{0}, kErrorColours.size() / 2, kErrorColours.size()}) {
    const double value = saturation * static_cast<double>(i) / kErrorColours.size();
    const std::string prefix = i == kErrorColours.size() ? "\u2265 " : "";
    svg.text({left + 22.0, bottom - step * static_cast<double>(i) + 4.0}, prefix + rounded(value),
             "start small");
  }
  svg.text({left - 4.0, plot.box.top + 8.0}, "error (m)", "start small");
}

/// Estimators from the largest rmse to the smallest, so that a lost one does not cover the others.
std::vector<std::size_t> worstFirst(const eval::RunSummary& run) {
  std::vector<std::size_t> order(run.estimators.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&run](std::size_t a, std::size_t b) {
    return run.estimators[a].rmseXy().value_or(0.0) > run.estimators[b].rmseXy().value_or(0.0);
  });
  return order;
}

}  // namespace

std::optional<NamedFigure> planFigure(const eval::RunSummary& run) {
  const Extent extent = extentOf(run);
  if (extent.empty()) return std::nullopt;
  const eval::EstimatorSummary* best = run.best();
  const eval::Statistics* xy =
      best && best->evaluation ? best->evaluation->find(eval::Component::Xy) : nullptr;
  const double saturation = xy ? std::max(xy->p95, 1e-3) : 0.0;

  std::vector<LegendEntry> legend;
  if (!run.truth_path.empty()) legend.push_back({"truth", "truth"});
  for (std::size_t i = 0; i < run.estimators.size(); ++i) {
    if (xy && &run.estimators[i] == best) continue;
    legend.push_back({shortened(run.estimators[i].name, kNameCharacters), strokeClass(i)});
  }
  if (run.tunnel_map && !run.tunnel_map->anchors.empty()) {
    legend.push_back({"anchor", "anchor", LegendEntry::Sign::Triangle});
  }

  const double top = kTitleHeight + legendHeight(kPlotWidth, legend) + 8.0;
  const Plot plot = planPlot(extent, top, kPlotWidth - (xy ? 88.0 : 0.0));
  Svg svg(kFigureWidth, plot.box.bottom() + kBelow, "Plan view", "Paths seen from above, map axes in metres");
  svg.text({kLeft, 22.0},
           xy ? "Plan view, " + shortened(best->name, 40) + " coloured by its error" : "Plan view", "title");
  drawLegend(svg, {kLeft, kTitleHeight}, kPlotWidth, legend);
  drawAxes(svg, plot, {"x, east (m)", "y, north (m)"});
  svg.beginClip(plot.box);
  if (run.tunnel_map && run.tunnel_map->grid) drawGrid(svg, plot, *run.tunnel_map->grid);
  svg.polyline(pixels(plot, run.truth_path), "truth");
  for (const std::size_t i : worstFirst(run)) {
    if (xy && &run.estimators[i] == best) continue;
    svg.polyline(pixels(plot, run.estimators[i].path), strokeClass(i) + (xy ? " thin pale" : " thin"));
  }
  if (xy) drawColoured(svg, plot, best->path, saturation);
  if (run.tunnel_map) drawAnchors(svg, plot, run.tunnel_map->anchors);
  drawScaleBar(svg, plot, run.tunnel_map ? run.tunnel_map->anchors : std::vector<map::Anchor>{});
  drawNorth(svg, plot);
  svg.endClip();
  if (xy) drawColourBar(svg, plot, saturation);
  return NamedFigure{
      "plan", "Plan view",
      "Where each estimator thought the vehicle was, seen from above; the broad grey line is the truth, "
      "numbered triangles are anchors, and paths that leave the frame are cut off.",
      svg.str()};
}

}  // namespace pos::report
