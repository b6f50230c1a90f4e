#include <algorithm>
#include <cmath>

#include "figure_parts.hpp"
#include "pos/report/text.hpp"

namespace pos::report {

namespace {

using eval::AnchorResiduals;
using eval::ResidualSample;

constexpr std::size_t kMostAnchors = 12;
constexpr std::size_t kMostPoints = 700;  ///< per anchor
constexpr double kPanel = 84.0;
constexpr double kBetween = 24.0;

/// The best estimator that has residuals, otherwise the first that has.
const eval::EstimatorSummary* chosen(const eval::RunSummary& run) {
  const eval::EstimatorSummary* best = run.best();
  if (best != nullptr && !best->residuals.empty()) return best;
  for (const eval::EstimatorSummary& estimator : run.estimators) {
    if (!estimator.residuals.empty()) return &estimator;
  }
  return nullptr;
}

/// The anchors heard most, ids upward.
std::vector<const AnchorResiduals*> busiest(const std::vector<AnchorResiduals>& all) {
  std::vector<const AnchorResiduals*> list;
  for (const AnchorResiduals& anchor : all) list.push_back(&anchor);
  std::stable_sort(list.begin(), list.end(), [](auto* a, auto* b) { return a->all.count > b->all.count; });
  list.resize(std::min(list.size(), kMostAnchors));
  std::sort(list.begin(), list.end(), [](auto* a, auto* b) { return a->anchor < b->anchor; });
  return list;
}

/// Half height common to all panels: eight robust sigmas of the widest anchor, never more than what occurs.
double halfHeight(const std::vector<const AnchorResiduals*>& anchors) {
  double robust = 0.0;
  double largest = 0.0;
  for (const AnchorResiduals* anchor : anchors) {
    robust = std::max(robust, std::abs(anchor->all.median) + 8.0 * anchor->all.mad_sigma);
    for (const ResidualSample& s : anchor->samples) largest = std::max(largest, std::abs(s.residual));
  }
  return std::max({robust > 0.0 ? std::min(robust, 1.05 * largest) : largest, 1e-3});
}

/// Filled dots for applied readings; crosses for the rest. What lies outside sits on the edge.
void drawSamples(Svg& svg, const Plot& plot, const AnchorResiduals& anchor, Stamp start) {
  const std::size_t stride =
      std::max<std::size_t>(1, (anchor.samples.size() + kMostPoints - 1) / kMostPoints);
  for (std::size_t i = 0; i < anchor.samples.size(); i += stride) {
    const ResidualSample& s = anchor.samples[i];
    const Pixel at = plot(seconds(s.stamp - start), std::clamp(s.residual, plot.y.low, plot.y.high));
    if (s.applied) {
      svg.circle(at, 1.6, "f0");
    } else {
      svg.line({at.x - 3.0, at.y - 3.0}, {at.x + 3.0, at.y + 3.0}, "s1 curve");
      svg.line({at.x - 3.0, at.y + 3.0}, {at.x + 3.0, at.y - 3.0}, "s1 curve");
    }
  }
}

/// How far the farthest sample lies beyond the frame; empty where all are inside.
std::string beyondText(const AnchorResiduals& anchor, double half) {
  double farthest = 0.0;
  for (const ResidualSample& s : anchor.samples) {
    if (std::abs(s.residual) > std::abs(farthest)) farthest = s.residual;
  }
  return std::abs(farthest) > half ? ", farthest " + fixed(farthest, 1) + " m" : "";
}

std::string panelHeading(const AnchorResiduals& anchor, double half) {
  return "anchor " + std::to_string(anchor.anchor) + ": median " + fixed(anchor.all.median, 3) +
         " m, spread " + fixed(anchor.all.mad_sigma, 3) + " m, " + grouped(anchor.applied.count) + " of " +
         grouped(anchor.all.count) + " applied" + beyondText(anchor, half);
}

}  // namespace

std::optional<NamedFigure> residualFigure(const eval::RunSummary& run) {
  const eval::EstimatorSummary* estimator = chosen(run);
  if (estimator == nullptr) return std::nullopt;
  const std::vector<const AnchorResiduals*> anchors = busiest(estimator->residuals);
  const double half = halfHeight(anchors);
  const std::string title = "Range residuals of " + shortened(estimator->name, 40);
  const std::vector<LegendEntry> legend{{"applied", "f0", LegendEntry::Sign::Square},
                                        {"gated or not used (cross)", "f1", LegendEntry::Sign::Square}};
  const double top = kTitleHeight + legendHeight(kPlotWidth, legend) + 26.0;
  const double height = static_cast<double>(anchors.size()) * (kPanel + kBetween) - kBetween;
  Svg svg(kFigureWidth, top + height + kBelow, title, "Measured range minus predicted range per anchor");
  svg.text({kLeft, 22.0}, title, "title");
  drawLegend(svg, {kLeft, kTitleHeight}, kPlotWidth, legend);
  for (std::size_t k = 0; k < anchors.size(); ++k) {
    const Box box{kLeft, top + static_cast<double>(k) * (kPanel + kBetween), kPlotWidth, kPanel};
    const Plot plot = plotOver(box, 0.0, runLength(run), -half, half);
    drawAxes(svg, plot, {k + 1 == anchors.size() ? "time since the start (s)" : "", "residual (m)"});
    svg.text({kLeft, box.top - 6.0}, panelHeading(*anchors[k], half), "start small strong");
    svg.line({box.left, plot.y(0.0)}, {box.right(), plot.y(0.0)}, "zero");
    drawSamples(svg, plot, *anchors[k], run.start);
  }
  const std::string left_out = estimator->residuals.size() > anchors.size()
                                   ? " Shown are the " + std::to_string(anchors.size()) +
                                         " anchors heard most of " +
                                         std::to_string(estimator->residuals.size()) + "."
                                   : "";
  return NamedFigure{"residuals", title,
                     "Measured minus predicted range: a band away from zero is an offset of that anchor, "
                     "points far above it are "
                     "reflections or rock in the way, points far below it faults of the radio; values beyond "
                     "the frame sit on its "
                     "edge." +
                         left_out,
                     svg.str()};
}

}  // namespace pos::report
