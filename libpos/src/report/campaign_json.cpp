#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pos/report/campaign_files.hpp"

namespace pos::report {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json number(const std::optional<double>& value) {
  return value ? number(*value) : Json(nullptr);
}

Json metricJson(const eval::MetricOverRuns& figures, const std::vector<eval::CampaignRow>& rows) {
  const eval::CampaignRow& worst = rows[figures.worst_row];
  return {{"count", figures.count},
          {"mean", number(figures.mean)},
          {"std", number(figures.std)},
          {"median", number(figures.median)},
          {"min", number(figures.min)},
          {"max", number(figures.max)},
          {"worst",
           {{"value", number(figures.worst)},
            {"run", worst.run},
            {"seed", worst.seed},
            {"repeat", worst.repeat}}}};
}

Json aneesJson(const eval::AneesOverTime& anees) {
  if (anees.moments == 0) return nullptr;
  return {{"dof", anees.dof},
          {"moments", anees.moments},
          {"mean", number(anees.mean)},
          {"inside", number(anees.inside())},
          {"above", number(anees.above)},
          {"below", number(anees.below)}};
}

/// NIS over all runs and moments for each degree of freedom; an honest filter gives 1.
Json nisJson(const std::vector<eval::MomentOverRuns>& moments) {
  double nis = 0.0;
  double dof = 0.0;
  for (const eval::MomentOverRuns& moment : moments) {
    nis += moment.nis;
    dof += moment.nis_dof;
  }
  return dof > 0.0 ? number(nis / dof) : Json(nullptr);
}

Json estimatorJson(const eval::EstimatorOverRuns& estimator, const std::vector<eval::CampaignRow>& rows) {
  Json metrics = Json::object();
  for (const auto& [name, figures] : estimator.metrics) metrics[name] = metricJson(figures, rows);
  return {{"type", estimator.type},
          {"mean_rmse_xy_m", number(estimator.mean_rmse_xy)},
          {"max_rmse_xy_m", number(estimator.max_rmse_xy)},
          {"anees_xy", aneesJson(estimator.anees_xy)},
          {"anees_pose", aneesJson(estimator.anees_pose)},
          {"nis_per_dof", nisJson(estimator.moments)},
          {"events", estimator.events},
          {"metrics", std::move(metrics)}};
}

Json pairJson(const eval::PairedComparison& pair, const std::string& baseline) {
  const auto bounds = [](const Interval& interval) {
    return Json::array({number(interval.low), number(interval.high)});
  };
  return {{"estimator", pair.estimator},
          {"baseline", baseline},
          {"metric", pair.metric},
          {"runs", pair.count},
          {"mean", number(pair.mean)},
          {"baseline_mean", number(pair.baseline_mean)},
          {"difference", number(pair.difference)},
          {"difference_95", bounds(pair.difference_bounds)},
          {"change", number(pair.change)},
          {"change_95", bounds(pair.change_bounds)},
          {"better_share", number(pair.better_share)},
          {"undecided", pair.undecided()}};
}

Json headJson(const eval::CampaignSummary& campaign) {
  const eval::CampaignHead& head = campaign.head;
  return {{"name", head.name},
          {"input", head.input},
          {"recorded", head.recorded},
          {"map", head.map},
          {"seed", head.seed},
          {"runs", head.runs},
          {"runs_done", campaign.rows.size()},
          {"step_s", number(head.step)},
          {"baseline", head.baseline},
          {"definitions",
           "std divides by n - 1; e_k is the root mean square over the runs of the xy error at moment k, "
           "mean_rmse_xy_m its mean and max_rmse_xy_m its largest over the moments; ANEES shares are of the "
           "moments against two-sided 95 % chi-square bounds for that moment's number of runs; pairs are "
           "estimator - baseline run by run with percentile bootstrap 95 % intervals"}};
}

}  // namespace

std::string campaignJson(const eval::CampaignSummary& campaign) {
  Json estimators = Json::object();
  for (const eval::EstimatorOverRuns& estimator : campaign.estimators) {
    estimators[estimator.name] = estimatorJson(estimator, campaign.rows);
  }
  Json pairs = Json::array();
  for (const eval::PairedComparison& pair : campaign.pairs)
    pairs.push_back(pairJson(pair, campaign.head.baseline));
  const Json json = {{"format", "pos.campaign/1"},
                     {"campaign", headJson(campaign)},
                     {"estimators", std::move(estimators)},
                     {"pairs", std::move(pairs)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace pos::report
