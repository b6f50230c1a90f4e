#include "replay.hpp"

#include <algorithm>

#include "pos/estimation/sequencer.hpp"
#include "pos/io/range_faults.hpp"
#include "pos/yardstick/factory.hpp"
#include "recorder.hpp"
#include "source.hpp"

namespace pos::app {
namespace {

constexpr std::uint64_t kProgressEvery = 1024;

/// What the configuration says of one sensor; null where it says nothing.
const io::SensorConfig* sensorConfig(const io::RunConfig& config, const std::string& sensor) {
  const auto found = std::find_if(config.sensors.begin(), config.sensors.end(),
                                  [&](const io::SensorConfig& s) { return s.sensor == sensor; });
  return found != config.sensors.end() ? &*found : nullptr;
}

/// A sensor whose stamps are moved back arrives that much late: the sequencer has to wait for it.
Duration sequencerLag(const io::RunConfig& config) {
  double lag = config.sequencer.lag;
  for (const io::SensorConfig& sensor : config.sensors)
    lag = std::max(lag, config.sequencer.lag + sensor.latency);
  return durationFromSeconds(lag);
}

class Pass {
 public:
  Pass(const Inputs& inputs, const io::RunFolder* folder)
      : inputs_(inputs), sequencer_(sequencerLag(inputs.config)), faults_(rangeFaults(inputs.config)) {
    if (inputs.config.intervals) result_.intervals = intervalGround(inputs.map, *inputs.config.intervals);
    for (const io::EstimatorEntry& entry : inputs.config.estimators) {
      recorders_.emplace_back(entry.name, std::string(estimation::typeName(entry.config)),
                              yardstick::makeAnyEstimator(entry.config, inputs.map),
                              inputs.config.record.max_rate);
      if (result_.intervals) recorders_.back().watchIntervals(result_.intervals, *inputs.config.intervals);
      if (folder != nullptr) recorders_.back().openFiles(*folder);
      if (inputs.grid) recorders_.back().sumNisOn(*inputs.grid);
    }
    if (folder != nullptr) events_.emplace(folder->eventsCsv());
  }

  Replayed run(const Progress& progress) {
    const std::unique_ptr<Source> source = openSource(inputs_);
    while (auto measurement = source->next()) {
      push(std::move(*measurement));
      drain();
      if (++result_.measurements % kProgressEvery == 0 && !progress(result_.measurements, result_.last)) {
        result_.interrupted = true;
        break;
      }
    }
    sequencer_.finish();
    drain();
    endEpoch();
    if (!result_.interrupted) result_.log_end = source->end();
    result_.tally = source->tally();
    return finished();
  }

 private:
  static io::RangeFaults rangeFaults(const io::RunConfig& config) {
    return io::RangeFaults({.probability = config.faults.range_outlier_probability,
                            .min = config.faults.range_outlier_min,
                            .max = config.faults.range_outlier_max,
                            .seed = config.faults.seed.value_or(config.seed)});
  }

  void push(Measurement measurement) {
    if (std::holds_alternative<PoseTruth>(measurement.reading)) return;  // reference: for the evaluation only
    const io::SensorConfig* sensor = sensorConfig(inputs_.config, measurement.sensor);
    if (sensor != nullptr) measurement.stamp -= durationFromSeconds(sensor->latency);
    if (sensor != nullptr && !sensor->use) {
      for (Recorder& recorder : recorders_) recorder.withhold(measurement, "switched off by sensors.use");
      return;
    }
    sequencer_.push(faults_.applied(std::move(measurement)));
  }

  void drain() {
    while (const auto measurement = sequencer_.pop()) {
      if (epoch_ != measurement->stamp) beginEpoch(measurement->stamp);
      for (Recorder& recorder : recorders_) take(recorder, *measurement);
    }
  }

  void beginEpoch(Stamp stamp) {
    endEpoch();
    if (!started_) result_.first = result_.last = stamp;
    started_ = true;
    epoch_ = stamp;
    result_.last = std::max(result_.last, stamp);
  }

  void take(Recorder& recorder, const Measurement& measurement) {
    const IngestReport report = recorder.take(measurement);
    if (!report.event.empty() && events_) {
      events_->write(
          {measurement.stamp, recorder.name(), "estimator", measurement.sensor, std::string(report.event)});
    }
  }

  void endEpoch() {
    if (!epoch_) return;
    for (Recorder& recorder : recorders_) {
      recorder.endEpoch(*epoch_);
      for (const io::RunEvent& event : recorder.takeEvents()) {
        if (events_) events_->write(event);
      }
    }
    epoch_.reset();
  }

  Replayed finished() {
    for (Recorder& recorder : recorders_) result_.records.push_back(recorder.finish());
    if (events_ && result_.log_end.damaged) {
      events_->write({result_.last, "", "log_damaged", "", result_.log_end.message});
    }
    if (events_) events_->close();
    return std::move(result_);
  }

  const Inputs& inputs_;
  estimation::Sequencer sequencer_;
  io::RangeFaults faults_;
  std::vector<Recorder> recorders_;
  std::optional<io::EventsCsvWriter> events_;
  std::optional<Stamp> epoch_;
  bool started_ = false;
  Replayed result_;
};

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

}  // namespace

Replayed replayed(const Inputs& inputs, const io::RunFolder* folder, const Progress& progress) {
  return Pass(inputs, folder).run(progress);
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
