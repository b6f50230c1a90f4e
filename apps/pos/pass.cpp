#include "pass.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "pos/yardstick/factory.hpp"

namespace pos::app {
namespace {

constexpr std::size_t kMostDrawn = 16384;  // estimates: about 10 MB

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

io::RangeFaults rangeFaults(const io::RunConfig& config) {
  return io::RangeFaults({.probability = config.faults.range_outlier_probability,
                          .min = config.faults.range_outlier_min,
                          .max = config.faults.range_outlier_max,
                          .seed = config.faults.seed.value_or(config.seed)});
}

/// A report judges estimates by their truth, and measures a face by all of them; else it only draws them.
bool onlyDrawn(const Inputs& inputs, const io::EstimatorEntry& entry) {
  return !inputs.truth && !std::holds_alternative<estimation::ShearerConfig>(entry.config);
}

/// Each estimator by itself, but for those of MRPT: all of them draw from its one random generator.
std::vector<std::vector<std::size_t>> groupsOf(const std::vector<Recorder>& recorders) {
  std::vector<std::vector<std::size_t>> groups;
  std::optional<std::size_t> of_mrpt;
  for (std::size_t i = 0; i < recorders.size(); ++i) {
    const bool mrpt = recorders[i].type() == "mrpt_mcl";
    if (!mrpt || !of_mrpt) {
      if (mrpt) of_mrpt = groups.size();
      groups.emplace_back();
    }
    groups[mrpt ? *of_mrpt : groups.size() - 1].push_back(i);
  }
  return groups;
}

}  // namespace

Pass::Pass(const Inputs& inputs, const io::RunFolder* folder, Keep keep)
    : inputs_(inputs), sequencer_(sequencerLag(inputs.config)), faults_(rangeFaults(inputs.config)) {
  if (inputs.config.intervals) result_.intervals = intervalGround(inputs.map, *inputs.config.intervals);
  for (const io::EstimatorEntry& entry : inputs.config.estimators) {
    recorders_.emplace_back(entry.name, std::string(estimation::typeName(entry.config)),
                            yardstick::makeAnyEstimator(entry.config, inputs.map),
                            inputs.config.record.max_rate);
    if (result_.intervals) recorders_.back().watchIntervals(result_.intervals, *inputs.config.intervals);
    if (folder != nullptr) recorders_.back().openFiles(*folder);
    if (inputs.grid) recorders_.back().sumNisOn(*inputs.grid);
    if (keep == Keep::ForTheReport && onlyDrawn(inputs, entry)) recorders_.back().keepAtMost(kMostDrawn);
  }
  if (folder != nullptr) events_.emplace(folder->eventsCsv());
  groups_ = groupsOf(recorders_);
}

void Pass::take(Measurement measurement) {
  push(std::move(measurement));
  drain();
  run(false);
}

void Pass::takeAll(std::vector<Measurement>& measurements) {
  for (Measurement& measurement : measurements) {
    push(std::move(measurement));
    drain();
  }
  run(true);
}

void Pass::push(Measurement measurement) {
  if (std::holds_alternative<PoseTruth>(measurement.reading)) return;  // reference: for the evaluation only
  const io::SensorConfig* sensor = sensorConfig(inputs_.config, measurement.sensor);
  if (sensor != nullptr) measurement.stamp -= durationFromSeconds(sensor->latency);
  if (sensor != nullptr && !sensor->use) {
    steps_.push_back({Step::Kind::Withhold, std::move(measurement)});
    return;
  }
  sequencer_.push(faults_.applied(std::move(measurement)));
}

void Pass::drain() {
  while (auto measurement = sequencer_.pop()) {
    if (epoch_ != measurement->stamp) beginEpoch(measurement->stamp);
    steps_.push_back({Step::Kind::Take, std::move(*measurement)});
  }
}

void Pass::beginEpoch(Stamp stamp) {
  endEpoch();
  if (!started_) result_.first = result_.last = stamp;
  started_ = true;
  epoch_ = stamp;
  result_.last = std::max(result_.last, stamp);
}

void Pass::endEpoch() {
  if (!epoch_) return;
  steps_.push_back({Step::Kind::EndEpoch, {.stamp = *epoch_}});
  epoch_.reset();
}

std::vector<Pass::Told> Pass::goThrough(Recorder& recorder) const {
  std::vector<Told> told;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const auto& [kind, measurement] = steps_[i];
    if (kind == Step::Kind::Withhold) {
      recorder.withhold(measurement, "switched off by sensors.use");
    } else if (kind == Step::Kind::Take) {
      const IngestReport report = recorder.take(measurement);
      if (report.event.empty()) continue;
      told.push_back(
          {i,
           {measurement.stamp, recorder.name(), "estimator", measurement.sensor, std::string(report.event)}});
    } else {
      recorder.endEpoch(measurement.stamp);
      for (io::RunEvent& event : recorder.takeEvents()) told.push_back({i, std::move(event)});
    }
  }
  return told;
}

/// All steps through all recorders; then the events, as if each step had gone through all before the next.
void Pass::run(bool side_by_side) {
  std::vector<std::vector<Told>> told(recorders_.size());
  const auto work = [&](std::size_t group) {
    for (const std::size_t r : groups_[group]) told[r] = goThrough(recorders_[r]);
  };
  if (side_by_side && groups_.size() > 1) {
    // Isolated: a filter that waits for threads of its own must not begin another estimator's work meanwhile.
    tbb::parallel_for(
        std::size_t{0}, groups_.size(),
        [&](std::size_t group) { tbb::this_task_arena::isolate([&] { work(group); }); },
        tbb::simple_partitioner{});
  } else {
    for (std::size_t group = 0; group < groups_.size(); ++group) work(group);
  }
  steps_.clear();
  std::vector<const Told*> all;
  for (const auto& of_one : told) {
    for (const Told& one : of_one) all.push_back(&one);
  }
  std::stable_sort(all.begin(), all.end(), [](const Told* a, const Told* b) { return a->step < b->step; });
  for (const Told* one : all) note(one->event);
}

void Pass::note(const io::RunEvent& event) {
  if (events_) events_->write(event);
  if (on_event_) on_event_(event);
}

void Pass::finish() {
  sequencer_.finish();
  drain();
  endEpoch();
  run(false);
}

void Pass::flush() {
  for (Recorder& recorder : recorders_) recorder.flush();
  if (events_) events_->flush();
}

Replayed Pass::finished(const io::LogEnd& end) {
  finish();
  result_.log_end = end;
  for (Recorder& recorder : recorders_) {
    if (auto picture = recorder.sweepPicture()) result_.pictures.push_back(std::move(*picture));
    result_.records.push_back(recorder.finish());
  }
  if (end.damaged) note({result_.last, "", "log_damaged", "", end.message});
  if (events_) events_->close();
  return std::move(result_);
}

}  // namespace pos::app
