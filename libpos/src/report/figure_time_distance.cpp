#include <algorithm>
#include <cmath>
#include <limits>

#include "figure_parts.hpp"
#include "pos/report/time_distance.hpp"

namespace pos::report {
namespace {

constexpr double kHeight = 430.0;
constexpr double kMargin = 118.0;      // px, right of the frame, for the names of the bands
constexpr double kColumn = 46.0;       // px, of one column of brackets
constexpr double kLabelHeight = 12.0;  // px
constexpr double kTouch = 0.5;         // m that neighbouring bands may overlap

/// Bands sorted upwards, each in the first column where it fits beside the others.
struct PlacedBand {
  const DistanceBand* band = nullptr;
  std::size_t column = 0;
  std::size_t rank = 0;  ///< within its column
};

std::vector<PlacedBand> placed(const std::vector<DistanceBand>& bands) {
  std::vector<PlacedBand> all;
  for (const DistanceBand& band : bands) all.push_back({&band});
  std::stable_sort(all.begin(), all.end(), [](const PlacedBand& a, const PlacedBand& b) {
    return a.band->from != b.band->from ? a.band->from < b.band->from : a.band->to > b.band->to;
  });
  struct Column {
    double end = -std::numeric_limits<double>::infinity();
    std::size_t count = 0;
  };
  std::vector<Column> columns;
  for (PlacedBand& p : all) {
    std::size_t c = 0;
    while (c < columns.size() && columns[c].end > p.band->from + kTouch) ++c;
    if (c == columns.size()) columns.emplace_back();
    p.column = c;
    p.rank = columns[c].count++;
    columns[c].end = p.band->to;
  }
  return all;
}

void drawBandNames(Svg& svg, const Plot& plot, const std::vector<PlacedBand>& bands) {
  for (const PlacedBand& p : bands) {
    const double x = plot.box.right() + 8.0 + kColumn * static_cast<double>(p.column);
    if (x + kColumn > kFigureWidth + 8.0) continue;  // a third column would not be read
    const double top = plot.y(std::min(p.band->to, plot.y.high));
    const double bottom = plot.y(std::max(p.band->from, plot.y.low));
    svg.line({x, top + 1.5}, {x, bottom - 1.5}, p.rank % 2 == 0 ? "inkline thin" : "truth bracket");
    if (bottom - top >= kLabelHeight)
      svg.text({x + 6.0, 0.5 * (top + bottom) + 4.0}, p.band->label, "start small");
  }
}

void drawBands(Svg& svg, const Plot& plot, const std::vector<PlacedBand>& bands) {
  for (const PlacedBand& p : bands) {
    if (p.column > 0) continue;
    const double top = plot.y(p.band->to);
    const double bottom = plot.y(p.band->from);
    if (p.rank % 2 == 1) svg.rect({plot.box.left, top, plot.box.width, bottom - top}, "band");
  }
}

void drawBars(Svg& svg, const Plot& plot, const std::vector<LockBar>& bars) {
  for (const LockBar& bar : bars) {
    const double left = plot.x(bar.begin);
    const double top = plot.y(bar.to);
    const Box box{left, top, plot.x(bar.end) - left, plot.y(bar.from) - top};
    svg.rect(box, fillClass(bar.colour) + " lock " + strokeClass(bar.colour));
  }
}

/// The parts of a line between NaNs.
std::vector<std::vector<Pixel>> parts(const Plot& plot, const DistanceLine& line) {
  std::vector<std::vector<Pixel>> all(1);
  for (std::size_t i = 0; i < line.t.size(); ++i) {
    if (std::isnan(line.distance[i])) {
      if (!all.back().empty()) all.emplace_back();
    } else {
      all.back().push_back(plot(line.t[i], line.distance[i]));
    }
  }
  if (all.back().empty()) all.pop_back();
  return all;
}

/// Names beside the lines, each where it is clear of those before it, or not at all.
class NamePlaces {
 public:
  void draw(Svg& svg, const Plot& plot, const DistanceLine& line) {
    std::vector<Pixel> longest;
    for (std::vector<Pixel>& part : parts(plot, line)) {
      std::erase_if(part, [&](const Pixel& p) { return outside(plot.box, p); });
      if (part.size() > longest.size()) longest = std::move(part);
    }
    for (const double share : {0.5, 0.3, 0.7, 0.15, 0.85}) {
      if (longest.empty()) return;
      const Pixel at = longest[static_cast<std::size_t>(share * static_cast<double>(longest.size() - 1))];
      if (!clear(at)) continue;
      taken_.push_back(at);
      svg.text({at.x + 4.0, at.y - 3.0}, line.label, "start small strong halo");
      return;
    }
  }

 private:
  static bool outside(const Box& box, const Pixel& p) {
    return p.x < box.left || p.x > box.right() - 20.0 || p.y < box.top + 14.0 || p.y > box.bottom();
  }
  bool clear(const Pixel& at) const {
    return std::none_of(taken_.begin(), taken_.end(), [&](const Pixel& p) {
      return std::abs(p.x - at.x) < 20.0 && std::abs(p.y - at.y) < 14.0;
    });
  }
  std::vector<Pixel> taken_;
};

std::vector<LegendEntry> legendOf(const TimeDistance& diagram) {
  std::vector<LegendEntry> legend;
  for (const DistanceLine& line : diagram.lines) {
    if (line.legend) legend.push_back({shortened(line.label, kNameCharacters), line.classes});
  }
  for (const auto& bar : diagram.bar_names)
    legend.push_back({bar.text, fillClass(bar.colour) + " lock", LegendEntry::Sign::Square});
  if (!diagram.bands.empty()) legend.push_back({"lock intervals", "band", LegendEntry::Sign::Band});
  return legend;
}

}  // namespace

NamedFigure timeDistanceFigure(const TimeDistance& diagram) {
  const std::vector<LegendEntry> legend = legendOf(diagram);
  const double width = kFigureWidth - kLeft - kMargin;
  const double top = kTitleHeight + legendHeight(width, legend) + 8.0;
  const Box box{kLeft, top, width, kHeight};
  const Plot plot = plotOver(box, diagram.t0, diagram.t1, diagram.from, diagram.to);
  Svg svg(kFigureWidth, box.bottom() + kBelow, diagram.title, "Distance along the road over time");
  svg.text({kLeft, 22.0}, diagram.title, "title");
  drawLegend(svg, {kLeft, kTitleHeight}, width, legend);
  std::vector<PlacedBand> bands = placed(diagram.bands);
  svg.beginClip(box);
  drawBands(svg, plot, bands);
  svg.endClip();
  drawAxes(svg, plot, {diagram.time_label, diagram.distance_label});
  svg.beginClip(box);
  drawBars(svg, plot, diagram.bars);
  for (const DistanceLine& line : diagram.lines) {
    for (const auto& part : parts(plot, line)) svg.polyline(part, line.classes);
  }
  NamePlaces names;
  for (const DistanceLine& line : diagram.lines) {
    if (!line.legend) names.draw(svg, plot, line);
  }
  svg.endClip();
  drawBandNames(svg, plot, bands);
  return {diagram.name, diagram.title, diagram.caption, svg.str()};
}

}  // namespace pos::report
