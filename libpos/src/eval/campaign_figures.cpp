#include <algorithm>
#include <cmath>
#include <numeric>

#include "pos/eval/bootstrap.hpp"
#include "pos/eval/campaign.hpp"
#include "pos/eval/statistics.hpp"

namespace pos::eval {
namespace {

constexpr double kConfidence = 0.95;

/// Value that an honest filter gives a consistency metric; nothing for other metrics.
std::optional<double> honestValue(const std::string& metric) {
  if (metric.ends_with("_sigma_factor")) return 1.0;
  if (metric == "consistency.nees_xy_mean") return 2.0;
  if (metric == "consistency.nees_pose_mean") return 3.0;
  return std::nullopt;
}

bool moreIsBetter(const std::string& metric) {
  if (metric.starts_with("intervals.")) return metric.find("share") != std::string::npos;
  return metric.starts_with("fraction_under.") || metric == "coverage" || metric.ends_with(".applied");
}

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Rows of both columns where both have a value.
struct Columns {
  std::vector<double> own;
  std::vector<double> base;
};

Columns common(const EstimatorOverRuns& estimator, const EstimatorOverRuns& baseline,
               const std::string& metric) {
  const auto own = estimator.values.find(metric);
  const auto base = baseline.values.find(metric);
  Columns columns;
  if (own == estimator.values.end() || base == baseline.values.end()) return columns;
  for (std::size_t row = 0; row < std::min(own->second.size(), base->second.size()); ++row) {
    if (std::isnan(own->second[row]) || std::isnan(base->second[row])) continue;
    columns.own.push_back(own->second[row]);
    columns.base.push_back(base->second[row]);
  }
  return columns;
}

double drawnMean(const std::vector<double>& values, const std::vector<std::size_t>& drawn) {
  double sum = 0.0;
  for (const std::size_t i : drawn) sum += values[i];
  return sum / static_cast<double>(drawn.size());
}

}  // namespace

double badness(const std::string& metric, double value) {
  if (const auto honest = honestValue(metric)) return std::abs(std::log(std::max(value, 1e-12) / *honest));
  return moreIsBetter(metric) ? -value : std::abs(value);
}

std::optional<MetricOverRuns> overRuns(const std::string& metric, const std::vector<double>& values) {
  std::vector<double> known;
  MetricOverRuns figures;
  double worst = -std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (std::isnan(values[row])) continue;
    known.push_back(values[row]);
    if (badness(metric, values[row]) <= worst) continue;
    worst = badness(metric, values[row]);
    figures.worst = values[row];
    figures.worst_row = row;
  }
  if (known.empty()) return std::nullopt;
  figures.count = known.size();
  figures.mean = meanOf(known);
  double squares = 0.0;
  for (const double v : known) squares += (v - figures.mean) * (v - figures.mean);
  if (known.size() > 1) figures.std = std::sqrt(squares / static_cast<double>(known.size() - 1));
  std::sort(known.begin(), known.end());
  figures.median = sortedQuantile(known, 0.5);
  figures.min = known.front();
  figures.max = known.back();
  return figures;
}

AneesOverTime aneesOverTime(const std::vector<MomentOverRuns>& moments, int dof) {
  AneesOverTime figures{.dof = dof};
  std::size_t above = 0;
  std::size_t below = 0;
  double sum = 0.0;
  std::map<std::size_t, Interval> bounds;  // few different numbers of runs, many moments
  for (const MomentOverRuns& moment : moments) {
    const std::size_t runs = dof == 2 ? moment.nees_runs : moment.nees_pose_runs;
    if (runs == 0) continue;
    const double anees = dof == 2 ? moment.anees_xy : moment.anees_pose;
    if (!bounds.contains(runs))
      bounds[runs] = meanChiSquareBounds(kConfidence, dof, static_cast<double>(runs));
    ++figures.moments;
    sum += anees;
    above += anees > bounds[runs].high ? 1U : 0U;
    below += anees < bounds[runs].low ? 1U : 0U;
  }
  if (figures.moments == 0) return figures;
  const auto share = [&](double part) { return part / static_cast<double>(figures.moments); };
  figures.mean = share(sum);
  figures.above = share(static_cast<double>(above));
  figures.below = share(static_cast<double>(below));
  return figures;
}

std::vector<std::string> pairedMetrics(const EstimatorOverRuns& estimator) {
  std::vector<std::string> names{"errors.xy.rmse", "errors.xy.mean",    "errors.xy.p95",
                                 "errors.xy.max",  "errors.along.rmse", "errors.cross.rmse",
                                 "errors.z.rmse",  "errors.yaw.rmse"};
  for (const auto& [name, figure] : estimator.metrics) {
    if (name.starts_with("windows.") && (name.ends_with(".mean") || name.ends_with(".max")))
      names.push_back(name);
  }
  return names;
}

std::optional<PairedComparison> paired(const EstimatorOverRuns& estimator, const EstimatorOverRuns& baseline,
                                       const std::string& metric) {
  const Columns columns = common(estimator, baseline, metric);
  const std::size_t n = columns.own.size();
  if (n < 2) return std::nullopt;
  PairedComparison pair{.estimator = estimator.name, .metric = metric, .count = n};
  pair.mean = meanOf(columns.own);
  pair.baseline_mean = meanOf(columns.base);
  pair.difference = pair.mean - pair.baseline_mean;
  pair.difference_bounds = bootstrapInterval(n, [&](const std::vector<std::size_t>& drawn) {
    return drawnMean(columns.own, drawn) - drawnMean(columns.base, drawn);
  });
  std::size_t better = 0;
  for (std::size_t i = 0; i < n; ++i) better += columns.own[i] < columns.base[i] ? 1U : 0U;
  pair.better_share = static_cast<double>(better) / static_cast<double>(n);
  if (pair.baseline_mean == 0.0) return pair;
  pair.change = pair.mean / pair.baseline_mean - 1.0;
  pair.change_bounds = bootstrapInterval(n, [&](const std::vector<std::size_t>& drawn) {
    const double base = drawnMean(columns.base, drawn);
    return base > 0.0 ? drawnMean(columns.own, drawn) / base - 1.0 : 0.0;
  });
  return pair;
}

}  // namespace pos::eval
