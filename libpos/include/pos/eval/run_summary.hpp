#pragma once
/// Everything a report says of one run: a log, a map and the estimators that went through it.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pos/eval/compute_stats.hpp"
#include "pos/eval/consistency.hpp"
#include "pos/eval/errors.hpp"
#include "pos/eval/interval_figures.hpp"
#include "pos/eval/relative_error.hpp"
#include "pos/eval/residuals.hpp"
#include "pos/eval/statistics.hpp"
#include "pos/eval/switching.hpp"
#include "pos/eval/time_grid.hpp"
#include "pos/eval/verdict_counts.hpp"
#include "pos/eval/windows.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::eval {

/// A thinned series for one plot. `sigma` is empty or as long as `value`.
struct PlotSeries {
  std::vector<double> t;  ///< s since the start of the run
  std::vector<double> value;
  std::vector<double> sigma;
};

/// A point of a path seen from above.
struct PathPoint {
  double t = 0.0;  ///< s since the start of the run
  double x = 0.0;  ///< m, map
  double y = 0.0;
  std::optional<double> error_xy;  ///< m
};

/// Distance limits of the "share of the time under ..." figures, m.
inline constexpr std::array kErrorLimits{0.3, 0.5, 1.0, 2.0};

struct ComponentError {
  Component component = Component::Xy;
  Statistics statistics;  ///< m or rad
};

/// One estimator against the truth.
struct Evaluation {
  Association association;
  Alignment alignment;
  std::vector<ComponentError> errors;  ///< those the truth allows, in the order of kComponents
  std::array<double, kErrorLimits.size()> fraction_under{};  ///< of the xy error, per kErrorLimits
  std::vector<CdfPoint> cdf_xy;
  std::vector<RelativeError> relative;
  Consistency consistency;
  std::vector<WindowErrors> windows = {};  ///< of the options
  PlotSeries xy;                           ///< m
  PlotSeries along;                        ///< m, with sigma
  PlotSeries cross;                        ///< m, with sigma
  PlotSeries yaw;                          ///< rad, with sigma
  PlotSeries nees_xy;

  /// Null where the truth does not allow it or nothing matched.
  const Statistics* find(Component component) const;
};

/// How probable one of the models was that an estimator chooses between.
struct ModeCurve {
  std::string name;
  PlotSeries probability;
};

struct EstimatorSummary {
  std::string name;
  std::string type;
  std::size_t estimates = 0;             ///< recorded
  std::optional<Evaluation> evaluation;  ///< where there is a truth
  VerdictCounts verdicts;
  std::vector<AnchorResiduals> residuals;
  ComputeStats compute;
  Diagnostics diagnostics;                           ///< at the end of the run
  std::map<std::string, std::uint64_t> events = {};  ///< how often each happened
  std::vector<GridCell> cells = {};  ///< on the grid of the options; empty without one or without truth
  std::vector<PathPoint> path;
  std::optional<IntervalFigures> intervals = {};   ///< where intervals are evaluated
  std::optional<SwitchingFigures> switching = {};  ///< of an estimator that chooses between models
  std::vector<ModeCurve> modes = {};               ///< likewise

  /// xy rmse, or nothing without truth or matches.
  std::optional<double> rmseXy() const;
};

/// How the log ended.
struct LogEnd {
  bool damaged = false;
  std::uint64_t objects = 0;  ///< read
  std::uint64_t byte = 0;     ///< reached
  std::string message;
};

struct RunSummary {
  std::string run;
  std::string log;
  std::string map;
  std::uint64_t seed = 0;
  Stamp start;  ///< first and last measurement
  Stamp end;
  LogEnd log_end;
  bool has_truth = false;
  std::vector<PathPoint> truth_path;
  std::shared_ptr<const map::TunnelMap> tunnel_map;  ///< for drawing; may be null
  std::vector<EstimatorSummary> estimators;
  std::shared_ptr<const IntervalScene> interval_scene = {};  ///< null where intervals are not evaluated

  /// The estimator with the smallest xy rmse; without truth the first. Null when there is none.
  const EstimatorSummary* best() const;
};

struct EvaluationOptions {
  AssociationOptions association;
  AlignmentMode alignment = AlignmentMode::None;
  PathTangentOptions tangent;  ///< its max_truth_gap is taken from `association`
  RelativeErrorOptions relative;
  double truth_sigma = 0.0;        ///< m per axis, the truth's own; enters the NEES only
  std::size_t plot_points = 2000;  ///< most points of one drawn series
  std::optional<TimeGrid> grid;    ///< also look at the errors at these moments
  std::shared_ptr<const IntervalScene> interval_scene = {};  ///< needed where intervals were recorded
  std::vector<TimeWindow> windows = {};                      ///< looked at one by one
  std::vector<Stamp> boundaries = {};  ///< upward: where the truth changed zone, for switching
};

/// What a run recorded of one estimator.
struct EstimatorRecord {
  std::string name;
  std::string type;
  std::vector<Estimate> estimates;  ///< in time order; without a truth perhaps only some of those recorded
  VerdictCounts verdicts;
  ResidualCollector residuals;
  ComputeStats compute;
  Diagnostics diagnostics;
  std::map<std::string, std::uint64_t> events = {};  ///< how often each happened
  std::optional<NisGrid> nis = {};                   ///< where the run is looked at on a grid
  std::optional<IntervalRecord> intervals = {};      ///< where intervals are evaluated
  std::optional<SwitchingWatch> switching = {};      ///< of an estimator that chooses between models
  std::size_t recorded = 0;  ///< estimates there were; 0: as many as `estimates` holds
};

/// All figures and series of one estimator; `truth` may be null or empty. `start` is the zero of the plots'
/// time. Throws what alignment() throws.
EstimatorSummary summarise(const EstimatorRecord& record, const Truth* truth, Stamp start,
                           const EvaluationOptions& options = {});

/// The truth's path for drawing, at most `points` of it.
std::vector<PathPoint> pathOf(const Truth& truth, Stamp start, std::size_t points = 2000);

}  // namespace pos::eval
