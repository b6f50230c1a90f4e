#include "pos/eval/campaign.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/error.hpp"

namespace pos::eval {
namespace {

constexpr double kNothing = GridCell::kNothing;

double meanOr(double sum, std::size_t count, double otherwise) {
  return count > 0 ? sum / static_cast<double>(count) : otherwise;
}

/// Adds `value` to `sum` and counts it, unless it is NaN.
void addKnown(double value, double& sum, std::size_t& count) {
  if (std::isnan(value)) return;
  sum += value;
  ++count;
}

/// A value for row `row` of every metric, NaN where the run gave none; earlier rows of new metrics are NaN.
void addRow(std::map<std::string, std::vector<double>>& values,
            const std::map<std::string, std::optional<double>>& metrics, std::size_t row) {
  for (const auto& [name, value] : metrics) {
    std::vector<double>& column = values[name];
    column.resize(row, kNothing);
    column.push_back(value && std::isfinite(*value) ? *value : kNothing);
  }
  for (auto& [name, column] : values) column.resize(row + 1, kNothing);
}

}  // namespace

const EstimatorOverRuns* CampaignSummary::find(const std::string& estimator) const {
  const auto found = std::find_if(estimators.begin(), estimators.end(),
                                  [&](const EstimatorOverRuns& e) { return e.name == estimator; });
  return found == estimators.end() ? nullptr : &*found;
}

void CampaignTotals::add(const CampaignRun& run) {
  ensure(rows_.empty() || rows_.back().run < run.index, "runs of a campaign are added in order");
  if (rows_.empty()) {
    for (const CampaignEntry& entry : run.estimators) {
      entries_.emplace_back();
      entries_.back().figures.name = entry.name;
      entries_.back().figures.type = entry.type;
    }
  }
  ensure(entries_.size() == run.estimators.size(), "runs of a campaign have the same estimators");
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    ensure(entries_[i].figures.name == run.estimators[i].name, "runs of a campaign have the same estimators");
    add(entries_[i], run.estimators[i]);
  }
  rows_.push_back({run.index, run.seed, run.repeat});
}

void CampaignTotals::add(Entry& entry, const CampaignEntry& run) {
  addRow(entry.figures.values, run.metrics, rows_.size());
  for (const auto& [event, count] : run.events) entry.figures.events[event] += count;
  if (entry.sums.size() < run.cells.size()) entry.sums.resize(run.cells.size());
  for (std::size_t k = 0; k < run.cells.size(); ++k) {
    const GridCell& cell = run.cells[k];
    MomentSums& sums = entry.sums[k];
    addKnown(cell.squared_xy, sums.squared_xy, sums.runs);
    addKnown(cell.nees_xy, sums.nees_xy, sums.nees_runs);
    addKnown(cell.nees_pose, sums.nees_pose, sums.nees_pose_runs);
    sums.nis += cell.nis;
    sums.nis_dof += cell.nis_dof;
  }
}

std::vector<MomentOverRuns> CampaignTotals::moments(const Entry& entry) const {
  std::vector<MomentOverRuns> all;
  for (std::size_t k = 0; k < entry.sums.size(); ++k) {
    const MomentSums& sums = entry.sums[k];
    if (sums.runs == 0) continue;
    all.push_back({.t = static_cast<double>(k) * head_.step,
                   .runs = sums.runs,
                   .rmse_xy = std::sqrt(meanOr(sums.squared_xy, sums.runs, 0.0)),
                   .nees_runs = sums.nees_runs,
                   .anees_xy = meanOr(sums.nees_xy, sums.nees_runs, kNothing),
                   .nees_pose_runs = sums.nees_pose_runs,
                   .anees_pose = meanOr(sums.nees_pose, sums.nees_pose_runs, kNothing),
                   .nis = sums.nis,
                   .nis_dof = sums.nis_dof});
  }
  return all;
}

CampaignSummary CampaignTotals::summary() const {
  CampaignSummary summary{.head = head_, .rows = rows_, .estimators = {}, .pairs = {}};
  for (const Entry& entry : entries_) {
    EstimatorOverRuns figures = entry.figures;
    for (const auto& [name, values] : figures.values) {
      if (const auto over_runs = overRuns(name, values)) figures.metrics[name] = *over_runs;
    }
    figures.moments = moments(entry);
    double sum = 0.0;
    for (const MomentOverRuns& moment : figures.moments) {
      sum += moment.rmse_xy;
      figures.max_rmse_xy = std::max(figures.max_rmse_xy.value_or(0.0), moment.rmse_xy);
    }
    if (!figures.moments.empty()) figures.mean_rmse_xy = meanOr(sum, figures.moments.size(), 0.0);
    figures.anees_xy = aneesOverTime(figures.moments, 2);
    figures.anees_pose = aneesOverTime(figures.moments, 3);
    summary.estimators.push_back(std::move(figures));
  }
  const EstimatorOverRuns* baseline = summary.find(head_.baseline);
  if (baseline == nullptr) return summary;
  for (const EstimatorOverRuns& estimator : summary.estimators) {
    if (&estimator == baseline) continue;
    for (const std::string& metric : pairedMetrics(estimator)) {
      if (const auto pair = paired(estimator, *baseline, metric)) summary.pairs.push_back(*pair);
    }
  }
  return summary;
}

}  // namespace pos::eval
