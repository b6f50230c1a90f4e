#include "replay.hpp"

#include <algorithm>

#include "pass.hpp"
#include "source.hpp"

namespace pos::app {
namespace {

constexpr std::size_t kBatch = 1024;  // measurements between two looks at the progress

/// The next measurements of the source; false at its end.
bool fill(std::vector<Measurement>& batch, Source& source) {
  batch.clear();
  while (batch.size() < kBatch) {
    auto measurement = source.next();
    if (!measurement) break;
    batch.push_back(std::move(*measurement));
  }
  return !batch.empty();
}

/// The truth without the first `skip` seconds, which are not judged.
Truth judged(Truth truth, double skip) {
  if (skip <= 0.0 || truth.poses.empty()) return truth;
  const Stamp from = truth.poses.front().stamp + durationFromSeconds(skip);
  std::erase_if(truth.poses, [&](const TruthPose& pose) { return pose.stamp < from; });
  return truth;
}

/// Windows of the configuration as moments; the run begins with its truth, where it has one.
std::vector<eval::TimeWindow> timeWindows(const Inputs& inputs, const Replayed& replayed) {
  const bool known = inputs.truth && !inputs.truth->poses.empty();
  const Stamp start = known ? inputs.truth->poses.front().stamp : replayed.first;
  std::vector<eval::TimeWindow> windows;
  for (const io::WindowConfig& window : inputs.config.evaluation.windows) {
    windows.push_back(
        {window.name, start + durationFromSeconds(window.from), start + durationFromSeconds(window.to)});
  }
  return windows;
}

/// The face that a shearer of the configuration drives along.
std::optional<eval::FaceLine> faceOf(const io::RunConfig& config, const std::string& estimator) {
  for (const io::EstimatorEntry& entry : config.estimators) {
    const auto* shearer = std::get_if<estimation::ShearerConfig>(&entry.config);
    if (entry.name != estimator || shearer == nullptr) continue;
    const estimation::FaceConfig& face = shearer->face;
    return eval::FaceLine{.end_1 = {face.x, face.y}, .heading = face.heading, .length = face.length};
  }
  return std::nullopt;
}

}  // namespace

Replayed replayed(const Inputs& inputs, const io::RunFolder* folder, const Progress& progress, Keep keep) {
  Pass pass(inputs, folder, keep);
  const std::unique_ptr<Source> source = openSource(inputs);
  std::uint64_t measurements = 0;
  bool interrupted = false;
  std::vector<Measurement> batch;
  while (fill(batch, *source)) {
    measurements += batch.size();
    pass.takeAll(batch);
    if (!progress(measurements, pass.reached())) {
      interrupted = true;
      break;
    }
  }
  Replayed result = pass.finished(interrupted ? io::LogEnd{} : source->end());
  result.measurements = measurements;
  result.interrupted = interrupted;
  result.tally = source->tally();
  result.source_note = source->note();
  return result;
}

report::ReportExtras extrasOf(const Inputs& inputs, const Replayed& replayed) {
  report::ReportExtras extras{.pictures = replayed.pictures};
  for (const eval::EstimatorRecord& record : replayed.records) {
    const auto line = faceOf(inputs.config, record.name);
    if (!line) continue;
    const Truth* truth = inputs.truth ? &*inputs.truth : nullptr;
    extras.faces.push_back(
        {record.name, eval::faceGeometry(record.estimates, truth, *line, record.diagnostics)});
  }
  return extras;
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
  options.boundaries = inputs.boundaries;
  options.windows = timeWindows(inputs, replayed);
  if (replayed.intervals) options.interval_scene = {replayed.intervals, &replayed.intervals->scene};
  summary.interval_scene = options.interval_scene;
  for (const eval::EstimatorRecord& record : replayed.records) {
    summary.estimators.push_back(eval::summarise(record, truth ? &*truth : nullptr, replayed.first, options));
  }
  return summary;
}

}  // namespace pos::app
