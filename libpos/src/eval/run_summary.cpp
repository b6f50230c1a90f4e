#include "pos/eval/run_summary.hpp"

#include <algorithm>
#include <cmath>

#include "pos/eval/decimation.hpp"

namespace pos::eval {

namespace {

constexpr std::size_t kCdfPoints = 201;

struct Point {
  Stamp stamp;
  double value;
  double sigma;
};

PlotSeries thinned(const std::vector<Point>& points, Stamp start, std::size_t capacity, bool has_sigma) {
  std::vector<double> all;
  all.reserve(points.size());
  for (const Point& point : points) all.push_back(point.value);
  PlotSeries series;
  for (const std::size_t i : minMaxIndices(all, capacity)) {
    series.t.push_back(seconds(points[i].stamp - start));
    series.value.push_back(points[i].value);
    if (has_sigma) series.sigma.push_back(points[i].sigma);
  }
  return series;
}

PlotSeries errorPlot(const ErrorSeries& errors, Component which, Stamp start, std::size_t capacity) {
  std::vector<Point> points;
  bool has_sigma = false;
  for (const ErrorSample& sample : errors) {
    const auto error = component(sample, which);
    if (!error) continue;
    points.push_back({sample.stamp, error->value, error->sigma});
    has_sigma = has_sigma || error->sigma > 0.0;
  }
  return thinned(points, start, capacity, has_sigma);
}

PlotSeries neesPlot(const ErrorSeries& errors, Stamp start, std::size_t capacity) {
  std::vector<Point> points;
  for (const ErrorSample& sample : errors) {
    if (sample.nees_xy) points.push_back({sample.stamp, *sample.nees_xy, 0.0});
  }
  return thinned(points, start, capacity, false);
}

/// The estimated path; its worst moments survive the thinning.
std::vector<PathPoint> errorPath(const ErrorSeries& errors, Stamp start, std::size_t capacity) {
  std::vector<PathPoint> path;
  for (const std::size_t i : minMaxIndices(values(errors, Component::Xy), capacity)) {
    const ErrorSample& sample = errors[i];
    path.push_back({seconds(sample.stamp - start), sample.T_map_estimate.translation.x(),
                    sample.T_map_estimate.translation.y(), sample.xy});
  }
  return path;
}

/// Every k-th of n, so that at most `capacity` remain, and the last.
std::vector<std::size_t> evenIndices(std::size_t n, std::size_t capacity) {
  std::vector<std::size_t> kept;
  const std::size_t stride =
      std::max<std::size_t>(1, (n + capacity - 1) / std::max<std::size_t>(capacity, 1));
  for (std::size_t i = 0; i < n; i += stride) kept.push_back(i);
  if (n > 0 && kept.back() != n - 1) kept.push_back(n - 1);
  return kept;
}

std::vector<PathPoint> plainPath(const std::vector<Estimate>& estimates, Stamp start, std::size_t capacity) {
  std::vector<PathPoint> path;
  for (const std::size_t i : evenIndices(estimates.size(), capacity)) {
    const Eigen::Vector3d& p = estimates[i].T_map_body.translation;
    if (p.allFinite()) path.push_back({seconds(estimates[i].stamp - start), p.x(), p.y(), std::nullopt});
  }
  return path;
}

/// One curve per model, as the first estimate with models names them: before the start there is none.
std::vector<ModeCurve> modeCurves(const std::vector<Estimate>& estimates, Stamp start, std::size_t capacity) {
  const auto named =
      std::find_if(estimates.begin(), estimates.end(), [](const Estimate& e) { return !e.modes.empty(); });
  std::vector<ModeCurve> curves;
  if (named == estimates.end()) return curves;
  for (std::size_t j = 0; j < named->modes.size(); ++j) {
    std::vector<Point> points;
    for (auto estimate = named; estimate != estimates.end(); ++estimate) {
      if (j < estimate->modes.size())
        points.push_back({estimate->stamp, estimate->modes[j].probability, 0.0});
    }
    curves.push_back({std::string(named->modes[j].name), thinned(points, start, capacity, false)});
  }
  return curves;
}

Evaluation evaluation(const Matches& matches, const ErrorSeries& errors, const Alignment& alignment) {
  Evaluation e;
  e.association = matches.association;
  e.alignment = alignment;
  for (const Component which : kComponents) {
    const std::vector<double> all = values(errors, which);
    if (!all.empty()) e.errors.push_back({which, statistics(all)});
  }
  const std::vector<double> xy = values(errors, Component::Xy);
  std::transform(kErrorLimits.begin(), kErrorLimits.end(), e.fraction_under.begin(),
                 [&xy](double limit) { return fractionUnder(xy, limit); });
  e.cdf_xy = cumulativeDistribution(xy, kCdfPoints);
  e.consistency = consistency(errors);
  return e;
}

}  // namespace

const Statistics* Evaluation::find(Component component) const {
  const auto found = std::find_if(errors.begin(), errors.end(),
                                  [component](const ComponentError& e) { return e.component == component; });
  return found == errors.end() ? nullptr : &found->statistics;
}

std::optional<double> EstimatorSummary::rmseXy() const {
  const Statistics* xy = evaluation ? evaluation->find(Component::Xy) : nullptr;
  return xy ? std::optional(xy->rmse) : std::nullopt;
}

const EstimatorSummary* RunSummary::best() const {
  if (estimators.empty()) return nullptr;
  const EstimatorSummary* best = &estimators.front();
  for (const EstimatorSummary& candidate : estimators) {
    const auto rmse = candidate.rmseXy();
    if (rmse && (!best->rmseXy() || *rmse < *best->rmseXy())) best = &candidate;
  }
  return best;
}

EstimatorSummary summarise(const EstimatorRecord& record, const Truth* truth, Stamp start,
                           const EvaluationOptions& options) {
  EstimatorSummary summary;
  summary.name = record.name;
  summary.type = record.type;
  summary.estimates = std::max(record.recorded, record.estimates.size());
  summary.verdicts = record.verdicts;
  summary.residuals = record.residuals.summary();
  summary.compute = record.compute;
  summary.diagnostics = record.diagnostics;
  summary.events = record.events;
  summary.path = plainPath(record.estimates, start, options.plot_points);
  if (record.intervals && options.interval_scene) {
    summary.intervals =
        intervalFigures(*record.intervals, *options.interval_scene, truth, options.association);
  }
  if (record.switching) summary.switching = record.switching->finish(options.boundaries);
  summary.modes = modeCurves(record.estimates, start, options.plot_points);
  if (truth == nullptr || truth->poses.empty()) return summary;
  const Matches matches = associate(record.estimates, *truth, options.association);
  const Alignment shift = alignment(matches.pairs, options.alignment, *truth);
  PathTangentOptions tangent = options.tangent;
  tangent.max_truth_gap = options.association.max_truth_gap;  // one idea of a hole in the truth
  const ErrorSeries errors = errorSeries(matches.pairs, shift, *truth, tangent, options.truth_sigma);
  Evaluation e = evaluation(matches, errors, shift);
  e.consistency.truth_sigma = options.truth_sigma;
  e.relative = relativeErrors(errors, options.relative);
  e.windows = windowErrors(errors, options.windows);
  e.xy = errorPlot(errors, Component::Xy, start, options.plot_points);
  e.along = errorPlot(errors, Component::Along, start, options.plot_points);
  e.cross = errorPlot(errors, Component::Cross, start, options.plot_points);
  e.yaw = errorPlot(errors, Component::Yaw, start, options.plot_points);
  e.nees_xy = neesPlot(errors, start, options.plot_points);
  if (!errors.empty()) summary.path = errorPath(errors, start, options.plot_points);
  if (options.grid) {
    summary.cells = gridCells(errors, *options.grid);
    if (record.nis) summary.cells = record.nis->into(std::move(summary.cells));
  }
  summary.evaluation = std::move(e);
  return summary;
}

std::vector<PathPoint> pathOf(const Truth& truth, Stamp start, std::size_t points) {
  std::vector<PathPoint> path;
  for (const std::size_t i : evenIndices(truth.poses.size(), points)) {
    const TruthPose& pose = truth.poses[i];
    const Eigen::Vector3d& p = pose.T_map_body.translation;
    path.push_back({seconds(pose.stamp - start), p.x(), p.y(), std::nullopt});
  }
  return path;
}

}  // namespace pos::eval
