#pragma once
/// Figures of wheels and inertial units over many seeds of a scenario, as the experiments of
/// docs/experiments/encoders_sins.md ask for them.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "pos/core/angle.hpp"
#include "pos/estimation/factory.hpp"
#include "pos/io/map_yaml.hpp"
#include "pos/io/run_config.hpp"
#include "pos/io/scenario_yaml.hpp"
#include "pos/sim/scenario.hpp"
#include "pos/sim/simulation.hpp"
#include "support/road_help.hpp"

namespace pos::testing {

constexpr double kScoreInterval = 0.1;  // s between looks at the errors

/// What one run of one estimator came to. Errors from `from` s on.
struct WheelRun {
  double max_xy = 0.0;         ///< m
  double end_xy = 0.0;         ///< m
  double end_across = 0.0;     ///< m, across the true heading at the end
  double way = 0.0;            ///< m, of the truth
  double end_yaw = 0.0;        ///< rad, estimate minus truth
  double longest_out = 0.0;    ///< s, longest stretch of comparisons that were not used
  std::vector<double> out;     ///< s, moments at which the wheels were left out
  std::vector<double> back;    ///< s, moments at which they were taken back
  bool ends_out = false;       ///< left out at the end
  bool degraded = false;       ///< said so at least once
  std::optional<double> nees;  ///< at the end, [x y yaw]
};

using WheelRuns = std::map<std::string, std::vector<WheelRun>>;

struct WheelScene {
  io::RunConfig config;
  sim::Scenario scenario;
  std::shared_ptr<const map::TunnelMap> map;
  double from = 5.0;  ///< s, errors before are not looked at
};

/// A replay configuration of the project with its scenario and map.
inline WheelScene wheelScene(const std::filesystem::path& file) {
  WheelScene scene{.config = io::loadRunConfig(file, {}, {}), .scenario = {}, .map = nullptr};
  scene.scenario = io::loadScenario(scene.config.scenario->file, {}, {});
  scene.map = scene.scenario.map
                  ? std::make_shared<const map::TunnelMap>(io::readMapFile(*scene.scenario.map).map)
                  : std::make_shared<const map::TunnelMap>();
  return scene;
}

inline void score(WheelRun& run, const estimation::Estimator& estimator, const Pose2& truth, Stamp stamp) {
  const auto estimate = estimator.estimateAt(stamp);
  if (!estimate) return;
  const Pose2 mean = estimate->T_map_body.planar();
  const Eigen::Vector2d off = mean.translation() - truth.translation();
  run.end_xy = off.norm();
  run.max_xy = std::max(run.max_xy, run.end_xy);
  run.end_across = (rotation2(-truth.yaw) * off).y();
  run.end_yaw = wrapAngle(mean.yaw - truth.yaw);
  const Vector<3> d(off.x(), off.y(), run.end_yaw);
  run.nees = d.dot(estimate->planarCovariance().ldlt().solve(d));
}

/// Counts what a comparison's report says of the wheels.
class OutWatch {
 public:
  void take(WheelRun& run, const IngestReport& report, double t) {
    const bool compared = report.dof > 0 || report.verdict == Verdict::Gated;
    if (report.event.find("left out") != std::string_view::npos &&
        report.event.find("slip") != std::string_view::npos)
      run.out.push_back(t);
    if (report.event.find("agree again") != std::string_view::npos ||
        report.event.find("velocity is taken") != std::string_view::npos)
      run.back.push_back(t);
    if (report.event.find("degraded") != std::string_view::npos) run.degraded = true;
    if (!compared) return;
    if (report.verdict != Verdict::Gated)
      since_.reset();
    else if (!since_)
      since_ = t;
    if (since_) run.longest_out = std::max(run.longest_out, t - *since_);
    run.ends_out = since_.has_value() && run.out.size() > run.back.size();
  }

 private:
  std::optional<double> since_;
};

/// The configuration says `sensors: [{sensor: ..., use: false}]`.
inline bool switchedOff(const io::RunConfig& config, const Measurement& m) {
  return std::any_of(config.sensors.begin(), config.sensors.end(),
                     [&](const io::SensorConfig& s) { return s.sensor == m.sensor && !s.use; });
}

/// Every estimator of the scene over one seed. `edit` may change a configuration for the seed.
inline std::map<std::string, WheelRun> wheelRun(
    const WheelScene& scene, std::uint64_t seed,
    const std::function<void(estimation::EstimatorConfig&, std::uint64_t)>& edit = {}) {
  sim::Simulation simulation(scene.scenario, scene.map, seed);
  struct Entry {
    std::string name;
    std::unique_ptr<estimation::Estimator> estimator;
    WheelRun run;
    OutWatch watch;
    std::unique_ptr<RoadHelp> road = {};  ///< where the configuration gives it the roadway's help
  };
  std::vector<Entry> entries;
  for (const io::EstimatorEntry& e : scene.config.estimators) {
    estimation::EstimatorConfig config = e.config;
    if (edit) edit(config, seed);
    entries.push_back({e.name, estimation::makeEstimator(config, scene.map), {}, {}});
    const auto& intervals = scene.config.intervals;
    if (intervals && intervals->aids(e.name))
      entries.back().road = std::make_unique<RoadHelp>(scene.map, *intervals);
  }
  double way = 0.0;
  Pose2 truth = simulation.truthPoseAt(simulation.start()).planar();
  Stamp scored = simulation.start();
  while (const auto delivery = simulation.next()) {
    const Measurement& m = delivery->measurement;
    if (switchedOff(scene.config, m)) continue;
    const bool wheels = std::holds_alternative<WheelTicks>(m.reading);
    const bool due = wheels && seconds(m.stamp - scored) >= kScoreInterval - 1e-6;
    if (due) {
      const Pose2 now = simulation.truthPoseAt(m.stamp).planar();
      way += (now.translation() - truth.translation()).norm();
      truth = now;
      scored = m.stamp;
    }
    const double t = seconds(m.stamp - simulation.start());
    for (Entry& e : entries) {
      const IngestReport report = e.estimator->ingest(m);
      if (wheels) e.watch.take(e.run, report, t);
      if (due && e.road) e.road->give(*e.estimator, m.stamp);
      if (due && t >= scene.from) score(e.run, *e.estimator, truth, m.stamp);
    }
  }
  std::map<std::string, WheelRun> runs;
  for (Entry& e : entries) {
    e.run.way = way;
    runs[e.name] = e.run;
  }
  return runs;
}

inline WheelRuns wheelRuns(
    const WheelScene& scene, int count,
    const std::function<void(estimation::EstimatorConfig&, std::uint64_t)>& edit = {}) {
  WheelRuns all;
  for (int i = 1; i <= count; ++i) {
    for (auto& [name, run] : wheelRun(scene, static_cast<std::uint64_t>(i), edit)) all[name].push_back(run);
  }
  return all;
}

/// The value below which `share` of the runs lie.
inline double quantile(const std::vector<WheelRun>& runs, double share,
                       const std::function<double(const WheelRun&)>& value) {
  std::vector<double> values;
  for (const WheelRun& run : runs) values.push_back(value(run));
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
}

inline double rms(const std::vector<WheelRun>& runs, const std::function<double(const WheelRun&)>& value) {
  double sum = 0.0;
  for (const WheelRun& run : runs) sum += value(run) * value(run);
  return std::sqrt(sum / static_cast<double>(runs.size()));
}

inline double maxXy(const WheelRun& run) {
  return run.max_xy;
}
inline double endXy(const WheelRun& run) {
  return run.end_xy;
}
inline double endYawDeg(const WheelRun& run) {
  return degrees(run.end_yaw);
}

/// A line for every estimator: what the experiments ask for.
inline void printFigures(const std::string& title, const WheelRuns& all) {
  std::printf("%s\n%-22s %10s %10s %10s %10s %10s %10s %8s\n", title.c_str(), "", "yaw rms", "max p50",
              "max p90", "max p95", "end p90", "end min", "out s");
  for (const auto& [name, runs] : all) {
    std::printf("%-22s %6.4f deg %9.3fm %9.3fm %9.3fm %9.3fm %9.3fm %8.1f\n", name.c_str(),
                rms(runs, endYawDeg), quantile(runs, 0.5, maxXy), quantile(runs, 0.9, maxXy),
                quantile(runs, 0.95, maxXy), quantile(runs, 0.9, endXy), quantile(runs, 0.0, endXy),
                quantile(runs, 1.0, [](const WheelRun& r) { return r.longest_out; }));
  }
}

}  // namespace pos::testing
