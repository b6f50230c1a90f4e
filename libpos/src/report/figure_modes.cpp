#include <algorithm>

#include "figure_parts.hpp"
#include "pos/report/text.hpp"

namespace pos::report {

namespace {

std::vector<Pixel> curve(const Plot& plot, const eval::PlotSeries& series) {
  std::vector<Pixel> points;
  for (std::size_t i = 0; i < series.t.size(); ++i) points.push_back(plot(series.t[i], series.value[i]));
  return points;
}

/// A line at every switch, and above it how long it took; a label that would run into the one before is left
/// out, the table has them all.
void drawSwitches(Svg& svg, const Plot& plot, const eval::SwitchingFigures& switching, Stamp start) {
  constexpr double kLabelWidth = 130.0;
  double free_from = plot.box.left;
  for (const eval::ModeSwitch& each : switching.switches) {
    const double x = plot.x(seconds(each.started - start));
    svg.line({x, plot.box.top}, {x, plot.box.bottom()}, "frame dash");
    const bool at_end = x + kLabelWidth > plot.box.right();
    if ((at_end ? x - kLabelWidth : x) < free_from) continue;
    const auto delay = each.delay();
    svg.text({x, plot.box.top - 5.0},
             each.change + (delay ? " " + fixed(1e3 * *delay, 0) + " ms" : " never settled"),
             at_end ? "end small muted" : "start small muted");
    free_from = x + kLabelWidth;
  }
}

/// Models of all estimators, each named once, in the order of their first appearance.
std::vector<std::string> modelNames(const eval::RunSummary& run) {
  std::vector<std::string> names;
  for (const eval::EstimatorSummary& estimator : run.estimators) {
    for (const eval::ModeCurve& mode : estimator.modes) {
      if (std::find(names.begin(), names.end(), mode.name) == names.end()) names.push_back(mode.name);
    }
  }
  return names;
}

}  // namespace

std::optional<NamedFigure> modesFigure(const eval::RunSummary& run) {
  const std::vector<std::string> names = modelNames(run);
  if (names.empty()) return std::nullopt;
  const auto shown = std::count_if(run.estimators.begin(), run.estimators.end(),
                                   [](const auto& estimator) { return !estimator.modes.empty(); });
  std::vector<LegendEntry> legend;
  for (std::size_t i = 0; i < names.size(); ++i) legend.push_back({names[i], strokeClass(i)});
  legend.push_back({"switch, and its delay", "frame dash"});
  constexpr double kPanel = 100.0;
  constexpr double kBetween = 44.0;
  const double top = kTitleHeight + legendHeight(kPlotWidth, legend) + 40.0;
  const double height = static_cast<double>(shown) * (kPanel + kBetween) - kBetween;
  const std::string title = "Probability of each model over time";
  Svg svg(kFigureWidth, top + height + kBelow, title,
          "Probabilities of the models, with the switches marked");
  svg.text({kLeft, 22.0}, title, "title");
  drawLegend(svg, {kLeft, kTitleHeight}, kPlotWidth, legend);
  double panel_top = top;
  for (const eval::EstimatorSummary& estimator : run.estimators) {
    if (estimator.modes.empty()) continue;
    const Box box{kLeft, panel_top, kPlotWidth, kPanel};
    const Plot plot = plotOver(box, 0.0, runLength(run), 0.0, 1.0);
    panel_top += kPanel + kBetween;
    const bool last = panel_top > top + height;
    drawAxes(svg, plot, {last ? "time since the start (s)" : "", "probability"});
    svg.text({kLeft, box.top - 20.0}, shortened(estimator.name, kNameCharacters), "start small strong");
    if (estimator.switching) drawSwitches(svg, plot, *estimator.switching, run.start);
    svg.beginClip(box);
    for (const eval::ModeCurve& mode : estimator.modes) {
      const auto at = std::find(names.begin(), names.end(), mode.name) - names.begin();
      svg.polyline(curve(plot, mode.probability), strokeClass(static_cast<std::size_t>(at)) + " thin");
    }
    svg.endClip();
  }
  return NamedFigure{
      "modes", title,
      "How much each model counts in the answer. A dashed line is a switch: a model came into use "
      "(+) or fell out of it (-); beside it the time until the choice had settled.",
      svg.str()};
}

}  // namespace pos::report
