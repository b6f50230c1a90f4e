#include <algorithm>
#include <cmath>

#include "campaign_parts.hpp"
#include "pos/core/chi_square.hpp"
#include "pos/eval/decimation.hpp"
#include "pos/report/campaign_html.hpp"
#include "pos/report/campaign_table.hpp"

namespace pos::report {

namespace {

using eval::CampaignSummary;
using eval::EstimatorOverRuns;
using eval::MomentOverRuns;

constexpr std::size_t kMostPoints = 2000;

struct Range {
  double low = 1e300;
  double high = 0.0;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// A thinned curve of one value of the moments; peaks survive.
std::vector<Pixel> curve(const Plot& plot, const std::vector<MomentOverRuns>& moments,
                         double MomentOverRuns::*value) {
  std::vector<double> all;
  for (const MomentOverRuns& moment : moments) all.push_back(moment.*value);
  std::vector<Pixel> points;
  for (const std::size_t i : eval::minMaxIndices(all, kMostPoints))
    points.push_back(plot(moments[i].t, all[i]));
  return points;
}

double lastMoment(const CampaignSummary& campaign) {
  double last = 1e-3;
  for (const EstimatorOverRuns& e : campaign.estimators) {
    if (!e.moments.empty()) last = std::max(last, e.moments.back().t);
  }
  return last;
}

/// Outline of the ANEES bounds, which step where the number of runs changes.
std::vector<Pixel> boundOutline(const Plot& plot, const std::vector<MomentOverRuns>& moments) {
  std::vector<Pixel> upper;
  std::vector<Pixel> lower;
  std::size_t runs = 0;
  Interval bounds;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const bool changed = moments[i].nees_runs != runs;
    if (!changed && i + 1 < moments.size()) continue;
    if (changed && runs > 0) {
      upper.push_back(plot(moments[i].t, bounds.high));
      lower.push_back(plot(moments[i].t, bounds.low));
    }
    runs = moments[i].nees_runs;
    bounds = meanChiSquareBounds(0.95, 2.0, static_cast<double>(runs));
    upper.push_back(plot(moments[i].t, bounds.high));
    lower.push_back(plot(moments[i].t, bounds.low));
  }
  upper.insert(upper.end(), lower.rbegin(), lower.rend());
  return upper;
}

std::vector<MomentOverRuns> withNees(const EstimatorOverRuns& e) {
  std::vector<MomentOverRuns> moments = e.moments;
  std::erase_if(moments, [](const MomentOverRuns& m) { return m.nees_runs == 0; });
  return moments;
}

std::string aneesLine(const EstimatorOverRuns& e) {
  return shortened(e.name, kNameCharacters) + ": mean " + rounded(e.anees_xy.mean) +
         ", inside the bounds at " + percent(e.anees_xy.inside()) + " of the moments";
}

void drawAneesPanel(Svg& svg, const Box& box, const EstimatorOverRuns& e, std::size_t index, double end,
                    const std::string& x_label) {
  const std::vector<MomentOverRuns> moments = withNees(e);
  Range range{0.5, 8.0};
  for (const MomentOverRuns& m : moments) range.add(std::max(m.anees_xy, 0.01));
  const Plot plot = logPlotOver(box, 0.0, end, 0.7 * range.low, std::min(1.4 * range.high, 1e6));
  drawAxes(svg, plot, {x_label, "ANEES"});
  svg.text({kLeft, box.top - 6.0}, aneesLine(e), "start small strong");
  svg.beginClip(box);
  svg.polygon(boundOutline(plot, moments), "band");
  svg.line({box.left, plot.y(2.0)}, {box.right(), plot.y(2.0)}, "zero dash");
  svg.polyline(curve(plot, moments, &MomentOverRuns::anees_xy), strokeClass(index) + " thin");
  svg.endClip();
}

}  // namespace

std::optional<NamedFigure> rmseOverTimeFigure(const CampaignSummary& campaign) {
  std::vector<LegendEntry> legend;
  Range range;
  Range means;
  for (std::size_t i = 0; i < campaign.estimators.size(); ++i) {
    const EstimatorOverRuns& e = campaign.estimators[i];
    if (!e.mean_rmse_xy) continue;
    legend.push_back({shortened(e.name, kNameCharacters), strokeClass(i)});
    range.add(*e.max_rmse_xy);
    means.add(*e.mean_rmse_xy);
  }
  if (legend.empty()) return std::nullopt;
  const bool logarithmic = wantsLogarithm(means.low, range.high);
  const double top = kTitleHeight + legendHeight(kPlotWidth, legend) + 8.0;
  const Box box{kLeft, top, kPlotWidth, 270.0};
  const double end = lastMoment(campaign);
  const Plot plot = logarithmic
                        ? logPlotOver(box, 0.0, end, std::max(1e-3, 0.1 * means.low), 1.2 * range.high)
                        : plotOver(box, 0.0, end, 0.0, 1.08 * std::max(range.high, 1e-6));
  const std::string title = "Horizontal error over the runs";
  Svg svg(kFigureWidth, box.bottom() + kBelow, title, "Root mean square over the runs at every moment");
  svg.text({kLeft, 22.0}, title, "title");
  drawLegend(svg, {kLeft, kTitleHeight}, kPlotWidth, legend);
  drawAxes(svg, plot, {"time since the start (s)", "RMSE over the runs (m)"});
  svg.beginClip(box);
  for (std::size_t i = 0; i < campaign.estimators.size(); ++i) {
    if (campaign.estimators[i].mean_rmse_xy) {
      svg.polyline(curve(plot, campaign.estimators[i].moments, &MomentOverRuns::rmse_xy),
                   strokeClass(i) + " thin");
    }
  }
  svg.endClip();
  return NamedFigure{
      "rmse_over_time", title,
      std::string("What error to expect at every moment: root mean square of the distance to the "
                  "truth over all runs, so that one bad run lifts the line") +
          (logarithmic ? "; the axis is logarithmic." : "."),
      svg.str()};
}

std::optional<NamedFigure> aneesFigure(const CampaignSummary& campaign) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < campaign.estimators.size(); ++i) {
    if (campaign.estimators[i].anees_xy.moments > 0) shown.push_back(i);
  }
  if (shown.empty()) return std::nullopt;
  const std::vector<LegendEntry> legend{
      {"mean NEES of x, y over the runs", strokeClass(shown.front())},
      {"95 % of an honest estimator's values", "band", LegendEntry::Sign::Band},
      {"expected, 2", "zero dash"}};
  constexpr double kPanel = 120.0;
  constexpr double kBetween = 32.0;
  const double top = kTitleHeight + legendHeight(kPlotWidth, legend) + 26.0;
  const double height = static_cast<double>(shown.size()) * (kPanel + kBetween) - kBetween;
  const std::string title = "Honesty over the runs (ANEES)";
  Svg svg(kFigureWidth, top + height + kBelow, title, "ANEES of the position with chi-square bounds");
  svg.text({kLeft, 22.0}, title, "title");
  drawLegend(svg, {kLeft, kTitleHeight}, kPlotWidth, legend);
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const Box box{kLeft, top + static_cast<double>(k) * (kPanel + kBetween), kPlotWidth, kPanel};
    drawAneesPanel(svg, box, campaign.estimators[shown[k]], shown[k], lastMoment(campaign),
                   k + 1 == shown.size() ? "time since the start (s)" : "");
  }
  return NamedFigure{
      "anees", title,
      "Squared error in units of the claimed covariance, averaged over the runs: above the band "
      "the estimator is too sure of itself at that moment, below it is too cautious. The band "
      "narrows with the number of runs.",
      svg.str()};
}

std::vector<NamedFigure> campaignFigures(const CampaignSummary& campaign) {
  std::vector<NamedFigure> all;
  const auto add = [&all](std::optional<NamedFigure> figure) {
    if (figure) all.push_back(std::move(*figure));
  };
  for (const char* metric : {"errors.xy.rmse", "errors.xy.p95", "errors.xy.max", "errors.yaw.rmse"})
    add(spreadFigure(campaign, metric));
  add(pairFigure(campaign));
  add(rmseOverTimeFigure(campaign));
  add(aneesFigure(campaign));
  return all;
}

}  // namespace pos::report
