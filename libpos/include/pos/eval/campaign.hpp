#pragma once
/// Many runs of one configuration taken together. Statistic names of the seamless paper (J. China Coal Soc.
/// 2024, table 2; our specification A8): with e_k = sqrt(mean over runs of the squared xy error at moment k),
/// "mean RMSE" is the mean of e_k over the moments and "max RMSE" its largest.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pos/core/chi_square.hpp"
#include "pos/eval/campaign_run.hpp"

namespace pos::eval {

/// What a campaign is of.
struct CampaignHead {
  std::string name = {};
  std::string input = {};  ///< file name of the log or of the scenario
  std::string map = {};
  std::uint64_t seed = 0;
  std::uint64_t runs = 0;     ///< asked for
  bool recorded = false;      ///< all runs share one log, so their errors are not independent of each other
  double step = 0.0;          ///< s, of the grid; 0 without truth
  std::string baseline = {};  ///< estimator the others are compared with
};

/// One figure over the runs that gave it a value.
struct MetricOverRuns {
  std::size_t count = 0;  ///< > 0
  double mean = 0.0;
  double std = 0.0;  ///< of the runs around the mean, divided by n - 1; 0 for a single run
  double median = 0.0;
  double min = 0.0;
  double max = 0.0;
  double worst = 0.0;         ///< see badness()
  std::size_t worst_row = 0;  ///< into CampaignSummary::rows; of equally bad ones the first
};

/// How bad a value of a metric is, larger is worse: for shares, coverage and counts of applied readings the
/// smaller value, for NEES, NIS and sigma factors the one further from honest by its factor, for everything
/// else the larger magnitude.
double badness(const std::string& metric, double value);

/// All runs at one moment.
struct MomentOverRuns {
  double t = 0.0;        ///< s, since the grid's origin
  std::size_t runs = 0;  ///< with an estimate there
  double rmse_xy = 0.0;  ///< m, e_k
  std::size_t nees_runs = 0;
  double anees_xy = 0.0;  ///< means over the runs that claimed a covariance (2 and 3 dof)
  std::size_t nees_pose_runs = 0;
  double anees_pose = 0.0;
  double nis = 0.0;  ///< sum over all runs, with its degrees of freedom
  double nis_dof = 0.0;
};

/// ANEES over the moments against its two-sided 95 % bounds, which belong to each moment's number of runs.
/// Runs are independent of each other, so these bounds are exact where those of a single run are not.
struct AneesOverTime {
  int dof = 0;
  std::size_t moments = 0;  ///< 0: no run claimed a covariance
  double mean = 0.0;        ///< over the moments
  double above = 0.0;  ///< share of the moments where the claimed sigmas are too small, 2.5 % when honest
  double below = 0.0;  ///< where they are too large
  double inside() const { return 1.0 - above - below; }
};

struct EstimatorOverRuns {
  std::string name;
  std::string type;
  std::map<std::string, std::vector<double>> values;  ///< by row; NaN where a run gave none
  std::map<std::string, MetricOverRuns> metrics;      ///< those with a value in at least one run
  std::map<std::string, std::uint64_t> events;        ///< over all runs
  std::vector<MomentOverRuns> moments;                ///< those with an estimate in at least one run
  std::optional<double> mean_rmse_xy;                 ///< m
  std::optional<double> max_rmse_xy;                  ///< m
  AneesOverTime anees_xy;
  AneesOverTime anees_pose;
};

/// An estimator against the baseline, run by run, over the runs in which both have a value.
struct PairedComparison {
  std::string estimator;
  std::string metric;
  std::size_t count = 0;
  double mean = 0.0;  ///< of the estimator
  double baseline_mean = 0.0;
  double difference = 0.0;          ///< mean of estimator - baseline; negative is better
  Interval difference_bounds = {};  ///< bootstrap, 95 %
  double change = 0.0;              ///< mean / baseline_mean - 1
  Interval change_bounds = {};
  double better_share = 0.0;  ///< of the runs in which the estimator has the smaller value

  /// The interval holds zero: these runs do not tell which of the two is better.
  bool undecided() const { return difference_bounds.low <= 0.0 && difference_bounds.high >= 0.0; }
};

struct CampaignRow {
  std::uint64_t run = 0;
  std::uint64_t seed = 0;
  std::string repeat;
};

struct CampaignSummary {
  CampaignHead head;
  std::vector<CampaignRow> rows;  ///< runs done, upward
  std::vector<EstimatorOverRuns> estimators;
  std::vector<PairedComparison> pairs;

  const EstimatorOverRuns* find(const std::string& estimator) const;
};

/// Metrics that pairs are made of: errors of the whole run, and means and largest errors of its windows.
std::vector<std::string> pairedMetrics(const EstimatorOverRuns& estimator);

/// Adds up runs in order. Memory: 8 bytes a run and metric, and the sums of the grid.
class CampaignTotals {
 public:
  explicit CampaignTotals(CampaignHead head) : head_(std::move(head)) {}

  /// Runs come with rising index and with the same estimators (ContractError).
  void add(const CampaignRun& run);
  CampaignSummary summary() const;

 private:
  struct MomentSums {
    std::size_t runs = 0;
    double squared_xy = 0.0;
    std::size_t nees_runs = 0;
    double nees_xy = 0.0;
    std::size_t nees_pose_runs = 0;
    double nees_pose = 0.0;
    double nis = 0.0;
    double nis_dof = 0.0;
  };
  struct Entry {
    EstimatorOverRuns figures;
    std::vector<MomentSums> sums;
  };
  void add(Entry& entry, const CampaignEntry& run);
  std::vector<MomentOverRuns> moments(const Entry& entry) const;

  CampaignHead head_;
  std::vector<CampaignRow> rows_;
  std::vector<Entry> entries_;
};

/// The estimator against the baseline in one metric; nothing where fewer than two runs have both.
std::optional<PairedComparison> paired(const EstimatorOverRuns& estimator, const EstimatorOverRuns& baseline,
                                       const std::string& metric);

/// Figures of a list of values by row, NaN left out; nothing where none is left.
std::optional<MetricOverRuns> overRuns(const std::string& metric, const std::vector<double>& values);

AneesOverTime aneesOverTime(const std::vector<MomentOverRuns>& moments, int dof);

}  // namespace pos::eval
