#include "pos/report/campaign_table.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "pos/report/text.hpp"

namespace pos::report {

namespace {

using eval::CampaignSummary;
using eval::EstimatorOverRuns;
using eval::MetricOverRuns;

struct Column {
  std::string title;
  std::function<std::string(const EstimatorOverRuns&)> text;
  /// Smaller is better; nothing keeps an estimator out of the contest. Empty: the column has no best.
  std::function<std::optional<double>(const EstimatorOverRuns&)> cost;
};

const MetricOverRuns* found(const EstimatorOverRuns& e, const std::string& metric) {
  const auto at = e.metrics.find(metric);
  return at == e.metrics.end() ? nullptr : &at->second;
}

std::string roundedOr(const std::optional<double>& value) {
  return value ? rounded(*value) : std::string(kNoValue);
}

Column meanColumn(const std::string& title, const std::string& metric) {
  const auto mean = [metric](const EstimatorOverRuns& e) -> std::optional<double> {
    const MetricOverRuns* figures = found(e, metric);
    return figures != nullptr ? std::optional(figures->mean) : std::nullopt;
  };
  return {title, [mean](const EstimatorOverRuns& e) { return roundedOr(mean(e)); }, mean};
}

Column spreadColumn(const std::string& title, const std::string& metric) {
  Column column = meanColumn(title, metric);
  column.text = [metric](const EstimatorOverRuns& e) {
    const MetricOverRuns* figures = found(e, metric);
    return figures == nullptr ? std::string(kNoValue)
                              : rounded(figures->mean) + " \u00b1 " + rounded(figures->std);
  };
  return column;
}

/// A share that is best when it is large.
Column shareColumn(const std::string& title, const std::string& metric) {
  const auto mean = meanColumn(title, metric).cost;
  return {title,
          [mean](const EstimatorOverRuns& e) {
            const auto value = mean(e);
            return value ? percent(*value) : std::string(kNoValue);
          },
          [mean](const EstimatorOverRuns& e) -> std::optional<double> {
            const auto value = mean(e);
            return value ? std::optional(-*value) : std::nullopt;
          }};
}

Column worstColumn(const CampaignSummary& campaign, const std::string& title, const std::string& metric) {
  return {title,
          [&campaign, metric](const EstimatorOverRuns& e) {
            const MetricOverRuns* figures = found(e, metric);
            if (figures == nullptr) return std::string(kNoValue);
            return rounded(figures->worst) + " [run " +
                   std::to_string(campaign.rows[figures->worst_row].run) + "]";
          },
          [metric](const EstimatorOverRuns& e) -> std::optional<double> {
            const MetricOverRuns* figures = found(e, metric);
            return figures != nullptr ? std::optional(figures->worst) : std::nullopt;
          }};
}

Column valueColumn(const std::string& title, std::optional<double> EstimatorOverRuns::*field) {
  const auto value = [field](const EstimatorOverRuns& e) { return e.*field; };
  return {title, [value](const EstimatorOverRuns& e) { return roundedOr(value(e)); }, value};
}

Column aneesColumn() {
  return {"ANEES xy [inside]",
          [](const EstimatorOverRuns& e) {
            if (e.anees_xy.moments == 0) return std::string(kNoValue);
            return rounded(e.anees_xy.mean) + " [" + percent(e.anees_xy.inside()) + "]";
          },
          {}};
}

std::string signedPercent(double share) {
  return (share > 0.0 ? "+" : "") + fixed(100.0 * share, 1) + " %";
}

Column againstBaseline(const CampaignSummary& campaign) {
  return {"xy rmse against " + campaign.head.baseline + " [95 %]",
          [&campaign](const EstimatorOverRuns& e) {
            if (e.name == campaign.head.baseline) return std::string("baseline");
            for (const eval::PairedComparison& pair : campaign.pairs) {
              if (pair.estimator != e.name || pair.metric != "errors.xy.rmse") continue;
              return signedPercent(pair.change) + " [" + fixed(100.0 * pair.change_bounds.low, 1) + ".." +
                     fixed(100.0 * pair.change_bounds.high, 1) + "]";
            }
            return std::string(kNoValue);
          },
          {}};
}

std::vector<Column> columns(const CampaignSummary& campaign) {
  std::vector<Column> all{spreadColumn("xy rmse m", "errors.xy.rmse"),
                          worstColumn(campaign, "worst m [run]", "errors.xy.rmse"),
                          meanColumn("median m", "errors.xy.median"),
                          meanColumn("p95 m", "errors.xy.p95"),
                          meanColumn("max m", "errors.xy.max"),
                          valueColumn("mean RMSE m", &EstimatorOverRuns::mean_rmse_xy),
                          valueColumn("max RMSE m", &EstimatorOverRuns::max_rmse_xy),
                          meanColumn("yaw rmse deg", "errors.yaw.rmse"),
                          aneesColumn()};
  if (campaign.estimators.size() > 1) all.push_back(againstBaseline(campaign));
  const bool intervals =
      std::any_of(campaign.estimators.begin(), campaign.estimators.end(),
                  [](const auto& e) { return found(e, "intervals.right_share") != nullptr; });
  if (!intervals) return all;
  all.push_back(shareColumn("right set", "intervals.right_share"));
  all.push_back(shareColumn("right set off boundaries", "intervals.right_share_clear"));
  Column past = worstColumn(campaign, "branch decided past m [run]", "intervals.branch_past_m");
  past.cost = {};
  all.push_back(past);
  return all;
}

std::optional<double> bestCost(const Column& column, const std::vector<EstimatorOverRuns>& estimators) {
  if (!column.cost) return std::nullopt;
  std::vector<double> costs;
  for (const EstimatorOverRuns& estimator : estimators) {
    if (const auto cost = column.cost(estimator)) costs.push_back(*cost);
  }
  if (costs.size() < 2) return std::nullopt;
  const auto [low, high] = std::minmax_element(costs.begin(), costs.end());
  return *low < *high ? std::optional(*low) : std::nullopt;
}

std::string aneesWarning(const EstimatorOverRuns& e) {
  const eval::AneesOverTime& anees = e.anees_xy;
  if (anees.moments == 0) return "";
  std::string what;
  if (anees.above > 0.1) what = "too sure of itself at " + percent(anees.above);
  if (anees.below > 0.1) {
    what += (what.empty() ? "" : " and ") + std::string("too cautious at ") + percent(anees.below);
  }
  return what.empty() ? ""
                      : e.name + " is " + what + " of the moments (mean ANEES " + rounded(anees.mean) +
                            ", honest would be 2).";
}

std::vector<std::string> estimatorWarnings(const EstimatorOverRuns& e, std::size_t runs) {
  std::vector<std::string> all;
  const MetricOverRuns* rmse = found(e, "errors.xy.rmse");
  if (rmse == nullptr) {
    all.push_back(e.name + " has no horizontal error in any run.");
    return all;
  }
  if (rmse->count < runs) {
    all.push_back(e.name + " has no horizontal error in " + grouped(runs - rmse->count) + " of " +
                  grouped(runs) + " runs; its figures are of the others.");
  }
  if (runs > 1 && rmse->count > 1 && rmse->min == rmse->max) {
    all.push_back(e.name +
                  " gives the same figures in every run: nothing that the seed changes reaches it, or it "
                  "keeps a seed of its own.");
  }
  if (const std::string text = aneesWarning(e); !text.empty()) all.push_back(text);
  return all;
}

}  // namespace

std::string metricTitle(const std::string& metric) {
  if (metric == "consistency.nees_xy_mean") return "NEES xy";
  if (!metric.starts_with("errors.")) return metric;
  const std::size_t dot = metric.rfind('.');
  const std::string component = metric.substr(7, dot - 7);
  return component + " " + metric.substr(dot + 1) + (component == "yaw" ? " (deg)" : " (m)");
}

Comparison campaignComparison(const CampaignSummary& campaign) {
  Comparison table;
  table.columns.push_back("estimator");
  table.rows.resize(campaign.estimators.size());
  for (std::size_t i = 0; i < campaign.estimators.size(); ++i)
    table.rows[i].push_back({campaign.estimators[i].name});
  for (const Column& column : columns(campaign)) {
    table.columns.push_back(column.title);
    const auto best = bestCost(column, campaign.estimators);
    for (std::size_t i = 0; i < campaign.estimators.size(); ++i) {
      const EstimatorOverRuns& estimator = campaign.estimators[i];
      table.rows[i].push_back({column.text(estimator), best && column.cost(estimator) == best});
    }
  }
  return table;
}

std::string campaignText(const CampaignSummary& campaign) {
  const std::string runs = grouped(campaign.rows.size());
  return tableText(campaignComparison(campaign)) + runs + (campaign.rows.size() == 1 ? " run" : " runs") +
         "; means over the runs, \u00b1 standard deviation of one run\n";
}

std::vector<std::string> campaignWarnings(const CampaignSummary& campaign) {
  std::vector<std::string> all;
  const std::size_t runs = campaign.rows.size();
  if (runs < campaign.head.runs) {
    all.push_back("Only " + grouped(runs) + " of " + grouped(campaign.head.runs) + " runs are done.");
  }
  if (runs > 0 && runs < 20) {
    all.push_back("With fewer than 20 runs the intervals are too narrow, and the worst run says little.");
  }
  if (campaign.head.recorded && runs > 1) {
    all.push_back(
        "All runs share one recorded log. What differs is chance in the estimators and in the faults; ANEES "
        "bounds and intervals know nothing of how another recording would come out.");
  }
  if (campaign.head.step <= 0.0) all.push_back("There is no truth: errors and honesty cannot be told.");
  if (campaign.head.step <= 0.0) return all;
  for (const EstimatorOverRuns& estimator : campaign.estimators) {
    const std::vector<std::string> its = estimatorWarnings(estimator, runs);
    all.insert(all.end(), its.begin(), its.end());
  }
  return all;
}

}  // namespace pos::report
