#include "replay.hpp"

#include <algorithm>

#include "pass.hpp"
#include "source.hpp"

namespace pos::app {
namespace {

constexpr std::uint64_t kProgressEvery = 1024;

/// The truth without the first `skip` seconds, which are not judged.
Truth judged(Truth truth, double skip) {
  if (skip <= 0.0 || truth.poses.empty()) return truth;
  const Stamp from = truth.poses.front().stamp + durationFromSeconds(skip);
  std::erase_if(truth.poses, [&](const TruthPose& pose) { return pose.stamp < from; });
  return truth;
}

}  // namespace

Replayed replayed(const Inputs& inputs, const io::RunFolder* folder, const Progress& progress) {
  Pass pass(inputs, folder);
  const std::unique_ptr<Source> source = openSource(inputs);
  std::uint64_t measurements = 0;
  bool interrupted = false;
  while (auto measurement = source->next()) {
    pass.take(std::move(*measurement));
    if (++measurements % kProgressEvery == 0 && !progress(measurements, pass.reached())) {
      interrupted = true;
      break;
    }
  }
  Replayed result = pass.finished(interrupted ? io::LogEnd{} : source->end());
  result.measurements = measurements;
  result.interrupted = interrupted;
  result.tally = source->tally();
  return result;
}

eval::RunSummary summaryOf(const Inputs& inputs, const Replayed& replayed) {
  const io::RunConfig& config = inputs.config;
  eval::RunSummary summary;
  summary.run = config.name;
  summary.log = (config.scenario ? config.scenario->file : config.log->file).filename().string();
  summary.map = inputs.map->name;
  summary.seed = config.seed;
  summary.start = replayed.first;
  summary.end = replayed.last;
  summary.log_end = {replayed.log_end.damaged, replayed.log_end.objects, replayed.log_end.byte,
                     replayed.log_end.message};
  summary.has_truth = inputs.truth.has_value();
  summary.tunnel_map = inputs.map;
  const std::optional<Truth> truth =
      inputs.truth ? std::optional(judged(*inputs.truth, config.evaluation.skip_start)) : std::nullopt;
  if (inputs.truth) summary.truth_path = eval::pathOf(*inputs.truth, replayed.first);
  eval::EvaluationOptions options = evaluationOptions(config.evaluation);
  options.grid = inputs.grid;
  if (replayed.intervals) options.interval_scene = {replayed.intervals, &replayed.intervals->scene};
  summary.interval_scene = options.interval_scene;
  for (const eval::EstimatorRecord& record : replayed.records) {
    summary.estimators.push_back(eval::summarise(record, truth ? &*truth : nullptr, replayed.first, options));
  }
  return summary;
}

}  // namespace pos::app
