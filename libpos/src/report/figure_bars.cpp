#include <algorithm>
#include <cmath>

#include "figure_parts.hpp"
#include "pos/report/text.hpp"

namespace pos::report {

namespace {

constexpr double kRow = 24.0;
constexpr double kLabelWidth = 250.0;
constexpr double kCountWidth = 170.0;

/// Looks of the verdicts, in the order of kVerdicts.
constexpr std::array<std::string_view, kVerdicts.size()> kVerdictClasses{"bar f0", "bar f1", "bar f3",
                                                                         "bar fg", "bar f4", "bar fm"};

struct BarRow {
  std::string label;
  const eval::Tally* tally;
};
struct BarGroup {
  std::string heading;
  std::vector<BarRow> rows;
};

std::string readable(Verdict verdict) {
  std::string text(name(verdict));
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::vector<LegendEntry> verdictLegend() {
  std::vector<LegendEntry> legend;
  for (std::size_t i = 0; i < kVerdicts.size(); ++i) {
    legend.push_back({readable(kVerdicts[i]), std::string(kVerdictClasses[i]), LegendEntry::Sign::Square});
  }
  return legend;
}

void drawBar(Svg& svg, double top, const BarRow& row) {
  const double left = kLabelWidth;
  const double width = kFigureWidth - kLabelWidth - kCountWidth;
  svg.text({left - 10.0, top + 16.0}, shortened(row.label, 30), "end");
  const double total = static_cast<double>(row.tally->total());
  double at = left;
  for (std::size_t i = 0; i < kVerdicts.size(); ++i) {
    if (row.tally->counts[i] == 0) continue;
    const double w = width * static_cast<double>(row.tally->counts[i]) / total;
    svg.rect({at, top + 3.0, w, kRow - 7.0}, kVerdictClasses[i]);
    at += w;
  }
  const std::uint64_t judged = row.tally->count(Verdict::Applied) + row.tally->count(Verdict::Gated);
  const std::string gated = judged > 0 ? ", gated " + percent(row.tally->gatedFraction()) : "";
  svg.text({left + width + 10.0, top + 16.0}, grouped(row.tally->total()) + gated, "start small");
}

/// A factor to two digits: 0.83, 57, 600 000.
std::string timesText(double factor) {
  if (factor < 10.0) return rounded(factor);
  const double power = std::pow(10.0, std::floor(std::log10(factor)) - 1.0);
  return grouped(static_cast<unsigned long long>(std::llround(std::round(factor / power) * power)));
}

std::string barDrawing(const std::string& title, const std::vector<BarGroup>& groups) {
  const std::vector<LegendEntry> legend = verdictLegend();
  const double width = kFigureWidth - 2.0 * kRight;
  double height = kTitleHeight + legendHeight(width, legend) + 10.0;
  const double first = height;
  for (const BarGroup& group : groups) height += kRow * static_cast<double>(group.rows.size() + 1) + 8.0;
  Svg svg(kFigureWidth, height + 6.0, title, "What became of the measurements");
  svg.text({kRight, 22.0}, title, "title");
  drawLegend(svg, {kRight, kTitleHeight}, width, legend);
  double top = first;
  for (const BarGroup& group : groups) {
    svg.text({kRight, top + 16.0}, shortened(group.heading, 60), "start strong");
    top += kRow;
    for (const BarRow& row : group.rows) {
      drawBar(svg, top, row);
      top += kRow;
    }
    top += 8.0;
  }
  return svg.str();
}

std::string anchorLabel(const eval::RunSummary& run, AnchorId id) {
  const map::Anchor* anchor = run.tunnel_map ? run.tunnel_map->findAnchor(id) : nullptr;
  const std::string number = "anchor " + std::to_string(id);
  if (anchor == nullptr) return run.tunnel_map ? number + " (not in the map)" : number;
  return anchor->name.empty() || anchor->name == std::to_string(id) ? number : number + " " + anchor->name;
}

}  // namespace

std::optional<NamedFigure> sensorVerdictFigure(const eval::RunSummary& run) {
  std::vector<BarGroup> groups;
  for (const eval::EstimatorSummary& estimator : run.estimators) {
    BarGroup group{estimator.name, {}};
    for (const auto& [sensor, tally] : estimator.verdicts.sensors()) group.rows.push_back({sensor, &tally});
    if (!group.rows.empty()) groups.push_back(std::move(group));
  }
  if (groups.empty()) return std::nullopt;
  const std::string title = "Verdicts per sensor";
  return NamedFigure{
      "verdicts_sensors", title,
      "What became of every measurement; a large gated share means that the sensor or its noise "
      "setting disagrees with the rest, unsupported means that the estimator has no use for it.",
      barDrawing(title, groups)};
}

std::optional<NamedFigure> anchorVerdictFigure(const eval::RunSummary& run) {
  std::vector<BarGroup> groups;
  for (const eval::EstimatorSummary& estimator : run.estimators) {
    BarGroup group{estimator.name, {}};
    for (const auto& [id, tally] : estimator.verdicts.anchors()) {
      if (tally.count(Verdict::Unsupported) < tally.total())
        group.rows.push_back({anchorLabel(run, id), &tally});
    }
    if (!group.rows.empty()) groups.push_back(std::move(group));
  }
  if (groups.empty()) return std::nullopt;
  const std::string title = "Verdicts per anchor";
  return NamedFigure{
      "verdicts_anchors", title,
      "One anchor that is gated far more often than the others is probably surveyed wrongly, moved, "
      "or seen through rock; estimators that use no ranges are left out.",
      barDrawing(title, groups)};
}

std::optional<NamedFigure> computeFigure(const eval::RunSummary& run) {
  double low = 1e300;
  double high = 0.0;
  std::vector<std::size_t> timed;
  for (std::size_t i = 0; i < run.estimators.size(); ++i) {
    const eval::ComputeStats& compute = run.estimators[i].compute;
    if (compute.count() == 0) continue;
    timed.push_back(i);
    low = std::min(low, compute.microseconds(0.5));
    high = std::max(high, compute.microseconds(0.99));
  }
  if (timed.empty()) return std::nullopt;
  const std::string title = "Compute time per measurement";
  const double top = kTitleHeight + 32.0;
  const double width = kFigureWidth - kLabelWidth - kCountWidth - 70.0;
  const Box box{kLabelWidth, top, width, 34.0 * static_cast<double>(timed.size()) + 8.0};
  Plot plot = plotOver(box, std::pow(10.0, std::floor(std::log10(std::max(0.5 * low, 1e-3)))),
                       std::pow(10.0, std::ceil(std::log10(std::max(1.2 * high, 2e-3)))), 0.0, 1.0);
  plot.x.logarithmic = true;
  Svg svg(kFigureWidth, box.bottom() + kBelow, title, "Median and 99th percentile per estimator");
  svg.text({kRight, 22.0}, title, "title");
  drawLegend(svg, {kRight, kTitleHeight}, width + kLabelWidth,
             {{"median", "f0", LegendEntry::Sign::Square},
              {"99 % are faster than this", "f0 faint", LegendEntry::Sign::Square}});
  for (const double tick : plot.x.ticks(6)) {
    svg.line({plot.x(tick), box.top}, {plot.x(tick), box.bottom()}, "grid");
    svg.text({plot.x(tick), box.bottom() + 17.0}, tickText(tick), "middle small muted");
  }
  svg.text({box.left + 0.5 * box.width, box.bottom() + 36.0}, "time per measurement (us)", "middle");
  for (std::size_t k = 0; k < timed.size(); ++k) {
    const eval::EstimatorSummary& estimator = run.estimators[timed[k]];
    const double p50 = estimator.compute.microseconds(0.5);
    const double p99 = estimator.compute.microseconds(0.99);
    const double y = box.top + 34.0 * static_cast<double>(k) + 6.0;
    svg.rect({box.left, y, plot.x(p99) - box.left, 26.0}, "f0 faint");
    svg.rect({box.left, y + 5.0, plot.x(p50) - box.left, 16.0}, "f0");
    svg.text({box.left - 10.0, y + 17.0}, shortened(estimator.name, 30), "end");
    svg.text({box.right() + 10.0, y + 17.0},
             rounded(p50) + " / " + rounded(p99) + " us, " +
                 timesText(estimator.compute.realTimeFactor(run.end - run.start)) + " x real time",
             "start small");
  }
  svg.rect(box, "frame");
  return NamedFigure{
      "compute", title,
      "Shorter is cheaper, each grid line to the right is ten times slower; measured on the machine "
      "that made this report and not repeatable to the digit.",
      svg.str()};
}

}  // namespace pos::report
