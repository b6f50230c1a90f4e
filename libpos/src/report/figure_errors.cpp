#include <algorithm>
#include <cmath>

#include "figure_parts.hpp"
#include "pos/core/angle.hpp"
#include "pos/core/chi_square.hpp"
#include "pos/report/text.hpp"

namespace pos::report {

namespace {

using eval::EstimatorSummary;
using eval::PlotSeries;

const eval::Statistics* xyOf(const EstimatorSummary& estimator) {
  return estimator.evaluation ? estimator.evaluation->find(eval::Component::Xy) : nullptr;
}

bool hasErrors(const EstimatorSummary& estimator) {
  return xyOf(estimator) != nullptr;
}

struct Range {
  double low = 1e300;
  double high = 0.0;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low > high; }
};

/// Smallest and largest of one figure of the xy error over all estimators.
Range rangeOf(const eval::RunSummary& run, double eval::Statistics::*field) {
  Range range;
  for (const EstimatorSummary& estimator : run.estimators) {
    if (const auto* xy = xyOf(estimator)) range.add(xy->*field);
  }
  return range;
}

std::vector<Pixel> curve(const Plot& plot, const PlotSeries& series, double unit) {
  std::vector<Pixel> points;
  for (std::size_t i = 0; i < series.t.size(); ++i)
    points.push_back(plot(series.t[i], unit * series.value[i]));
  return points;
}

/// Outline of +-3 sigma, forth above and back below.
std::vector<Pixel> bandOutline(const Plot& plot, const PlotSeries& series, double unit) {
  std::vector<Pixel> outline;
  for (std::size_t i = 0; i < series.sigma.size(); ++i) {
    outline.push_back(plot(series.t[i], 3.0 * unit * series.sigma[i]));
  }
  for (std::size_t i = series.sigma.size(); i > 0; --i) {
    outline.push_back(plot(series.t[i - 1], -3.0 * unit * series.sigma[i - 1]));
  }
  return outline;
}

/// Half height of a panel: all errors fit; a band much wider than them is cut.
double halfHeight(const PlotSeries& series) {
  double error = 0.0;
  double band = 0.0;
  for (const double v : series.value) error = std::max(error, std::abs(v));
  for (const double s : series.sigma) band = std::max(band, 3.0 * s);
  return 1.08 * std::max({error, std::min(band, 2.0 * error), 1e-6});
}

struct PanelSeries {
  std::string label;
  const PlotSeries* series;
  double unit;
};

void drawPanel(Svg& svg, const Plot& plot, const PanelSeries& panel, std::string_view classes) {
  svg.beginClip(plot.box);
  if (!panel.series->sigma.empty()) svg.polygon(bandOutline(plot, *panel.series, panel.unit), "band");
  svg.line({plot.box.left, plot.y(0.0)}, {plot.box.right(), plot.y(0.0)}, "zero");
  svg.polyline(curve(plot, *panel.series, panel.unit), std::string(classes) + " thin");
  svg.endClip();
}

}  // namespace

std::optional<NamedFigure> errorFigure(const eval::RunSummary& run) {
  const auto legend = estimatorLegend(run, hasErrors);
  if (legend.empty()) return std::nullopt;
  const Range largest = rangeOf(run, &eval::Statistics::max);
  const bool logarithmic = wantsLogarithm(rangeOf(run, &eval::Statistics::rmse).low, largest.high);
  const double lowest = std::max(1e-3, 0.5 * rangeOf(run, &eval::Statistics::p50).low / 10.0);
  const double top = kTitleHeight + legendHeight(kPlotWidth, legend) + 8.0;
  const Box box{kLeft, top, kPlotWidth, 270.0};
  const Plot plot = logarithmic
                        ? logPlotOver(box, 0.0, runLength(run), lowest, 1.2 * largest.high)
                        : plotOver(box, 0.0, runLength(run), 0.0, 1.08 * std::max(largest.high, 1e-6));
  Svg svg(kFigureWidth, box.bottom() + kBelow, "Horizontal error over time",
          "Distance to the truth in metres");
  svg.text({kLeft, 22.0}, "Horizontal error over time", "title");
  drawLegend(svg, {kLeft, kTitleHeight}, kPlotWidth, legend);
  drawAxes(svg, plot, {"time since the start (s)", "distance to the truth (m)"});
  svg.beginClip(box);
  for (std::size_t i = 0; i < run.estimators.size(); ++i) {
    if (!hasErrors(run.estimators[i])) continue;
    svg.polyline(curve(plot, run.estimators[i].evaluation->xy, 1.0), strokeClass(i) + " thin");
  }
  svg.endClip();
  return NamedFigure{
      "error_xy", "Horizontal error over time",
      std::string("Distance between estimate and truth at every moment: lower is better, a growing "
                  "line is drift") +
          (logarithmic ? "; the axis is logarithmic, the same step upward is the same factor." : "."),
      svg.str()};
}

std::optional<NamedFigure> componentFigure(const eval::RunSummary& run, std::size_t index) {
  const EstimatorSummary& estimator = run.estimators[index];
  if (!hasErrors(estimator)) return std::nullopt;
  const eval::Evaluation& e = *estimator.evaluation;
  std::vector<PanelSeries> panels;
  if (!e.along.t.empty()) panels.push_back({"along (m)", &e.along, 1.0});
  if (!e.cross.t.empty()) panels.push_back({"cross (m)", &e.cross, 1.0});
  if (!e.yaw.t.empty()) panels.push_back({"yaw (deg)", &e.yaw, degrees(1.0)});
  if (panels.empty()) return std::nullopt;

  const std::vector<LegendEntry> legend{
      {"error", strokeClass(index)}, {"3 sigma, as the estimator claims", "band", LegendEntry::Sign::Band}};
  constexpr double kPanel = 130.0;
  constexpr double kBetween = 14.0;
  const double top = kTitleHeight + legendHeight(kPlotWidth, legend) + 8.0;
  const double height = static_cast<double>(panels.size()) * (kPanel + kBetween) - kBetween;
  const std::string title = "Errors of " + shortened(estimator.name, 40) + " against what it claims";
  Svg svg(kFigureWidth, top + height + kBelow, title, "Error along and across the path, and of the heading");
  svg.text({kLeft, 22.0}, title, "title");
  drawLegend(svg, {kLeft, kTitleHeight}, kPlotWidth, legend);
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const double half = panels[k].unit * halfHeight(*panels[k].series);
    const Box box{kLeft, top + static_cast<double>(k) * (kPanel + kBetween), kPlotWidth, kPanel};
    const Plot plot = plotOver(box, 0.0, runLength(run), -half, half);
    const bool last = k + 1 == panels.size();
    drawAxes(svg, plot, {last ? "time since the start (s)" : "", panels[k].label});
    drawPanel(svg, plot, panels[k], strokeClass(index));
  }
  return NamedFigure{
      "errors_" + std::to_string(index + 1), title,
      "Positive along = ahead of the truth, positive cross = left of it; an honest estimator's line "
      "stays inside the grey band almost always and uses much of it.",
      svg.str()};
}

std::optional<NamedFigure> cdfFigure(const eval::RunSummary& run) {
  const auto legend = estimatorLegend(run, hasErrors);
  if (legend.empty()) return std::nullopt;
  const Range p99 = rangeOf(run, &eval::Statistics::p99);
  const bool logarithmic = wantsLogarithm(p99.low, p99.high);
  const double top = kTitleHeight + legendHeight(kPlotWidth, legend) + 8.0;
  const Box box{kLeft, top, kPlotWidth, 260.0};
  Plot plot = plotOver(box, 0.0, 1.1 * std::max(p99.high, 1e-6), 0.0, 100.0);
  if (logarithmic) {
    plot.x.low = std::max(1e-3, 0.1 * rangeOf(run, &eval::Statistics::p50).low);
    plot.x.logarithmic = true;
  }
  Svg svg(kFigureWidth, box.bottom() + kBelow, "Share of the run below an error", "Cumulative distribution");
  svg.text({kLeft, 22.0}, "Share of the run below an error", "title");
  drawLegend(svg, {kLeft, kTitleHeight}, kPlotWidth, legend);
  drawAxes(svg, plot, {"horizontal error (m)", "share of the estimates (%)"});
  svg.line({box.left, plot.y(95.0)}, {box.right(), plot.y(95.0)}, "zero dash");
  svg.text({box.left + 6.0, plot.y(95.0) + 15.0}, "95 %", "start small muted halo");
  svg.beginClip(box);
  for (std::size_t i = 0; i < run.estimators.size(); ++i) {
    if (!hasErrors(run.estimators[i])) continue;
    std::vector<Pixel> points;
    for (const auto& p : run.estimators[i].evaluation->cdf_xy)
      points.push_back(plot(p.value, 100.0 * p.fraction));
    svg.polyline(points, strokeClass(i));
  }
  svg.endClip();
  return NamedFigure{
      "cdf_xy", "Share of the run below an error",
      "Read across from 95 % to a curve and down: 95 % of that estimator's errors are smaller; the "
      "curve furthest to the left is best.",
      svg.str()};
}

std::optional<NamedFigure> neesFigure(const eval::RunSummary& run) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < run.estimators.size(); ++i) {
    const auto& evaluation = run.estimators[i].evaluation;
    if (evaluation && !evaluation->nees_xy.t.empty()) shown.push_back(i);
  }
  if (shown.empty()) return std::nullopt;
  const Interval single = meanChiSquareBounds(0.95, 2.0, 1.0);
  const std::vector<LegendEntry> legend{
      {"NEES of x, y", strokeClass(shown.front())},
      {"95 % of an honest estimator's values", "band", LegendEntry::Sign::Band},
      {"expected mean, 2", "zero dash"}};
  constexpr double kPanel = 110.0;
  constexpr double kBetween = 30.0;
  const double top = kTitleHeight + legendHeight(kPlotWidth, legend) + 26.0;
  const double height = static_cast<double>(shown.size()) * (kPanel + kBetween) - kBetween;
  Svg svg(kFigureWidth, top + height + kBelow, "Honesty over time",
          "NEES of the position with chi-square bounds");
  svg.text({kLeft, 22.0}, "Honesty over time (NEES)", "title");
  drawLegend(svg, {kLeft, kTitleHeight}, kPlotWidth, legend);
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const EstimatorSummary& estimator = run.estimators[shown[k]];
    const PlotSeries& series = estimator.evaluation->nees_xy;
    const double highest = *std::max_element(series.value.begin(), series.value.end());
    const Box box{kLeft, top + static_cast<double>(k) * (kPanel + kBetween), kPlotWidth, kPanel};
    const Plot plot = logPlotOver(box, 0.0, runLength(run), 0.01, std::clamp(2.0 * highest, 100.0, 1e6));
    const bool last = k + 1 == shown.size();
    drawAxes(svg, plot, {last ? "time since the start (s)" : "", "NEES"});
    svg.text({kLeft, box.top - 6.0},
             shortened(estimator.name, kNameCharacters) + ": mean " +
                 rounded(estimator.evaluation->consistency.nees_xy.mean),
             "start small strong");
    svg.beginClip(box);
    svg.rect({box.left, plot.y(single.high), box.width, plot.y(single.low) - plot.y(single.high)}, "band");
    svg.line({box.left, plot.y(2.0)}, {box.right(), plot.y(2.0)}, "zero dash");
    svg.polyline(curve(plot, series, 1.0), strokeClass(shown[k]) + " thin");
    svg.endClip();
  }
  return NamedFigure{
      "nees", "Honesty over time",
      "Squared error in units of the claimed covariance: long stretches above the band mean that the "
      "estimator is too sure of itself, long stretches below that it is too cautious.",
      svg.str()};
}

}  // namespace pos::report
