#include <algorithm>
#include <cmath>

#include "campaign_parts.hpp"
#include "pos/report/campaign_table.hpp"

namespace pos::report {

namespace {

using eval::PairedComparison;

constexpr double kRowHeight = 26.0;
constexpr double kLabel = 150.0;
constexpr double kWords = 300.0;

struct Group {
  std::string estimator;
  std::vector<const PairedComparison*> pairs;
};

std::vector<Group> groupsOf(const eval::CampaignSummary& campaign) {
  std::vector<Group> groups;
  for (const PairedComparison& pair : campaign.pairs) {
    if (pair.baseline_mean <= 0.0) continue;
    if (groups.empty() || groups.back().estimator != pair.estimator) groups.push_back({pair.estimator, {}});
    groups.back().pairs.push_back(&pair);
  }
  return groups;
}

std::string signedPercent(double share) {
  return (share > 0.0 ? "+" : "") + fixed(100.0 * share, 1) + " %";
}

std::string words(const PairedComparison& pair) {
  const std::string outcome = pair.undecided() ? "undecided" : pair.change < 0.0 ? "better" : "worse";
  return signedPercent(pair.change) + " [" + fixed(100.0 * pair.change_bounds.low, 1) + ".." +
         fixed(100.0 * pair.change_bounds.high, 1) + "], " + outcome;
}

void drawPair(Svg& svg, const Plot& plot, double y, const PairedComparison& pair) {
  const std::string_view looks = pair.undecided() ? "fm" : pair.change < 0.0 ? "f2" : "f1";
  const double low = std::clamp(100.0 * pair.change_bounds.low, plot.x.low, plot.x.high);
  const double high = std::clamp(100.0 * pair.change_bounds.high, plot.x.low, plot.x.high);
  svg.text({plot.box.left - 10.0, y + 4.0}, metricTitle(pair.metric), "end");
  svg.rect({plot.x(low), y - 3.0, std::max(2.0, plot.x(high) - plot.x(low)), 6.0}, looks);
  svg.circle({plot.x(std::clamp(100.0 * pair.change, plot.x.low, plot.x.high)), y}, 4.5, looks);
  svg.text({plot.box.right() + 10.0, y + 4.0}, words(pair), "start small");
  svg.text({kFigureWidth - 12.0, y + 4.0}, percent(pair.better_share), "end small");
}

}  // namespace

std::optional<NamedFigure> pairFigure(const eval::CampaignSummary& campaign) {
  const std::vector<Group> groups = groupsOf(campaign);
  if (groups.empty()) return std::nullopt;
  double low = -5.0;
  double high = 5.0;
  double rows = 0.0;
  for (const Group& group : groups) {
    rows += 1.0 + static_cast<double>(group.pairs.size());
    for (const PairedComparison* pair : group.pairs) {
      low = std::min(low, 110.0 * pair->change_bounds.low);
      high = std::max(high, 110.0 * pair->change_bounds.high);
    }
  }
  const std::string title = "Against " + shortened(campaign.head.baseline, kNameCharacters) + ", run by run";
  const double top = kTitleHeight + 34.0;
  const Box box{kLabel, top, kFigureWidth - kLabel - kWords, kRowHeight * rows + 6.0};
  const Plot plot = plotOver(box, low, std::min(high, 300.0), 0.0, 1.0);
  Svg svg(kFigureWidth, box.bottom() + kBelow, title, "Change of the mean with bootstrap interval");
  svg.text({kRight, 22.0}, title, "title");
  drawLegend(svg, {kRight, kTitleHeight}, kFigureWidth,
             {{"better", "f2", LegendEntry::Sign::Square},
              {"undecided", "fm", LegendEntry::Sign::Square},
              {"worse", "f1", LegendEntry::Sign::Square}});
  for (const double tick : plot.x.ticks(4)) {
    svg.line({plot.x(tick), box.top}, {plot.x(tick), box.bottom()}, "grid");
    svg.text({plot.x(tick), box.bottom() + 17.0}, tickText(tick), "middle small muted");
  }
  svg.line({plot.x(0.0), box.top}, {plot.x(0.0), box.bottom()}, "inkline");
  svg.text({box.left + 0.5 * box.width, box.bottom() + 36.0}, "change of the mean (%)", "middle");
  double y = box.top + 0.5 * kRowHeight + 3.0;
  for (const Group& group : groups) {
    svg.text({box.left - 10.0, y + 4.0}, shortened(group.estimator, 20), "end strong");
    y += kRowHeight;
    for (const PairedComparison* pair : group.pairs) {
      drawPair(svg, plot, y, *pair);
      y += kRowHeight;
    }
  }
  svg.text({box.right() + 10.0, box.top - 8.0}, "change [95 %]", "start small muted");
  svg.text({kFigureWidth - 12.0, box.top - 8.0}, "runs won", "end small muted");
  svg.rect(box, "frame");
  return NamedFigure{
      "pairs", title,
      "Both estimators went through the same runs, so chance that hits both cancels: the dot is "
      "the change of the mean, the bar its 95 % bootstrap interval. A bar across zero means that "
      "these runs do not tell which is better. Changes beyond +300 % are drawn at the edge.",
      svg.str()};
}

}  // namespace pos::report
