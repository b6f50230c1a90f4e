#include <algorithm>
#include <cmath>

#include "campaign_parts.hpp"
#include "pos/eval/statistics.hpp"
#include "pos/report/campaign_table.hpp"

namespace pos::report {

namespace {

constexpr double kRowHeight = 46.0;
constexpr double kLabel = 210.0;
constexpr double kFigures = 150.0;
constexpr std::size_t kMostDots = 400;

struct Row {
  std::size_t estimator;
  std::vector<double> by_run;  ///< without gaps
  std::vector<double> sorted;
};

std::vector<Row> rowsOf(const eval::CampaignSummary& campaign, const std::string& metric) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < campaign.estimators.size(); ++i) {
    const auto found = campaign.estimators[i].values.find(metric);
    if (found == campaign.estimators[i].values.end()) continue;
    Row row{i, found->second, {}};
    std::erase_if(row.by_run, [](double v) { return std::isnan(v); });
    row.sorted = row.by_run;
    std::sort(row.sorted.begin(), row.sorted.end());
    if (!row.sorted.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

/// Dots are spread over the row by the golden ratio, so that they overlap little and always lie alike.
double scatter(std::size_t run) {
  const double turns = 0.6180339887498949 * static_cast<double>(run);
  return turns - std::floor(turns) - 0.5;
}

void drawRow(Svg& svg, const Plot& plot, double middle, const Row& row, const eval::EstimatorOverRuns& e) {
  const auto at = [&](double share) { return plot.x(eval::sortedQuantile(row.sorted, share)); };
  svg.text({plot.box.left - 10.0, middle + 4.0}, shortened(e.name, kNameCharacters), "end");
  const std::size_t stride = (row.by_run.size() + kMostDots - 1) / kMostDots;
  for (std::size_t run = 0; run < row.by_run.size(); run += stride) {
    svg.circle({plot.x(row.by_run[run]), middle + 26.0 * scatter(run)}, 2.2,
               fillClass(row.estimator) + " faint");
  }
  svg.line({at(0.0), middle}, {at(1.0), middle}, strokeClass(row.estimator) + " curve");
  svg.rect({at(0.25), middle - 9.0, std::max(1.0, at(0.75) - at(0.25)), 18.0},
           "box " + strokeClass(row.estimator));
  svg.line({at(0.5), middle - 12.0}, {at(0.5), middle + 12.0}, "inkline");
  svg.text({plot.box.right() + 10.0, middle + 4.0},
           rounded(eval::sortedQuantile(row.sorted, 0.5)) + ", worst " + rounded(row.sorted.back()),
           "start small");
}

}  // namespace

std::optional<NamedFigure> spreadFigure(const eval::CampaignSummary& campaign, const std::string& metric) {
  const std::vector<Row> rows = rowsOf(campaign, metric);
  if (rows.empty()) return std::nullopt;
  double low = rows.front().sorted.front();
  double high = rows.front().sorted.back();
  double low_median = eval::sortedQuantile(rows.front().sorted, 0.5);
  for (const Row& row : rows) {
    low = std::min(low, row.sorted.front());
    high = std::max(high, row.sorted.back());
    low_median = std::min(low_median, eval::sortedQuantile(row.sorted, 0.5));
  }
  const bool logarithmic = low > 0.0 && wantsLogarithm(low_median, high);
  const double pad = 0.04 * (high - low);
  const double from = low < 0.4 * high ? 0.0 : low - pad;
  const std::string title = metricTitle(metric) + ", run by run";
  const double top = kTitleHeight + 30.0;
  const Box box{kLabel, top, kFigureWidth - kLabel - kFigures, kRowHeight * static_cast<double>(rows.size())};
  Plot plot = plotOver(box, logarithmic ? 0.8 * low : from, logarithmic ? 1.2 * high : high + pad, 0.0, 1.0);
  plot.x.logarithmic = logarithmic;
  Svg svg(kFigureWidth, box.bottom() + kBelow, title, "One dot a run, box of the middle half, median");
  svg.text({kRight, 22.0}, title, "title");
  drawLegend(svg, {kRight, kTitleHeight}, kFigureWidth,
             {{"a run", "f0 faint", LegendEntry::Sign::Square},
              {"middle half of the runs", "box s0", LegendEntry::Sign::Band},
              {"median", "inkline"}});
  for (const double tick : plot.x.ticks(6)) {
    svg.line({plot.x(tick), box.top}, {plot.x(tick), box.bottom()}, "grid");
    svg.text({plot.x(tick), box.bottom() + 17.0}, tickText(tick), "middle small muted");
  }
  svg.text({box.left + 0.5 * box.width, box.bottom() + 36.0}, metricTitle(metric), "middle");
  svg.text({box.right() + 10.0, box.top - 8.0}, "median and worst", "start small muted");
  for (std::size_t k = 0; k < rows.size(); ++k) {
    drawRow(svg, plot, box.top + kRowHeight * (static_cast<double>(k) + 0.5), rows[k],
            campaign.estimators[rows[k].estimator]);
  }
  svg.rect(box, "frame");
  std::string name = "spread_" + metric;
  std::replace(name.begin(), name.end(), '.', '_');
  return NamedFigure{name, title,
                     std::string("One dot is one run: further left is better, a short box means that the "
                                 "seed hardly matters, a lone dot far right is a run to look at") +
                         (logarithmic ? "; the axis is logarithmic." : "."),
                     svg.str()};
}

}  // namespace pos::report
