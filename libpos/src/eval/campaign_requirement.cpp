#include "pos/eval/campaign_requirement.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "pos/core/error.hpp"

namespace pos::eval {
namespace {

struct Aggregate {
  const char* name;
  double MetricOverRuns::*field;
};
constexpr std::array kAggregates{
    Aggregate{"mean", &MetricOverRuns::mean},     Aggregate{"std", &MetricOverRuns::std},
    Aggregate{"median", &MetricOverRuns::median}, Aggregate{"min", &MetricOverRuns::min},
    Aggregate{"max", &MetricOverRuns::max},       Aggregate{"worst", &MetricOverRuns::worst}};

struct Split {
  Aggregate aggregate;
  std::string rest;
};

Split split(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {kAggregates.front(), text};
  const std::string word = text.substr(0, colon);
  const auto* found = std::find_if(kAggregates.begin(), kAggregates.end(),
                                   [&](const Aggregate& aggregate) { return word == aggregate.name; });
  if (found == kAggregates.end()) {
    throw UsageError(Complaint{.what = "unknown figure over the runs in the requirement '" + text + "'",
                               .key = "--require",
                               .got = word,
                               .expected = "mean, std, median, min, max or worst before the colon"});
  }
  return {*found, text.substr(colon + 1)};
}

std::optional<double> share(const AneesOverTime& anees, double value) {
  return anees.moments > 0 ? std::optional(value) : std::nullopt;
}

NamedMetrics namedMetrics(const EstimatorOverRuns& estimator, const Aggregate& aggregate) {
  NamedMetrics named{estimator.name, metrics({}, Duration{0})};  // every name there is, without a value
  for (const auto& [name, figures] : estimator.metrics) named.values[name] = figures.*aggregate.field;
  std::erase_if(named.values, [](const auto& metric) { return metric.first.starts_with("compute."); });
  named.values["campaign.mean_rmse_xy"] = estimator.mean_rmse_xy;
  named.values["campaign.max_rmse_xy"] = estimator.max_rmse_xy;
  named.values["campaign.anees_xy"] = share(estimator.anees_xy, estimator.anees_xy.mean);
  named.values["campaign.anees_xy_inside"] = share(estimator.anees_xy, estimator.anees_xy.inside());
  named.values["campaign.anees_pose"] = share(estimator.anees_pose, estimator.anees_pose.mean);
  named.values["campaign.anees_pose_inside"] = share(estimator.anees_pose, estimator.anees_pose.inside());
  return named;
}

}  // namespace

std::vector<RequirementResult> checkOverRuns(const std::string& text, const CampaignSummary& campaign) {
  const Split parts = split(text);
  std::vector<NamedMetrics> all;
  for (const EstimatorOverRuns& estimator : campaign.estimators)
    all.push_back(namedMetrics(estimator, parts.aggregate));
  std::vector<RequirementResult> results = check(parseRequirement(parts.rest, all), all);
  const std::string word = std::string(parts.aggregate.name) + " over " +
                           std::to_string(campaign.rows.size()) +
                           (campaign.rows.size() == 1 ? " run" : " runs");
  for (RequirementResult& result : results) result.line += " (" + word + ")";
  return results;
}

void refuseUnknownOverRuns(const std::string& text, const std::vector<std::string>& estimators) {
  const Split parts = split(text);
  if (isOfASensor(text)) return;
  std::vector<NamedMetrics> all;
  for (const std::string& name : estimators) {
    EstimatorOverRuns nothing_yet;
    nothing_yet.name = name;
    all.push_back(namedMetrics(nothing_yet, parts.aggregate));
  }
  (void)parseRequirement(parts.rest, all);
}

}  // namespace pos::eval
