#include "pass.hpp"

#include <algorithm>

#include "pos/yardstick/factory.hpp"

namespace pos::app {
namespace {

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

}  // namespace

Pass::Pass(const Inputs& inputs, const io::RunFolder* folder)
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

void Pass::take(Measurement measurement) {
  push(std::move(measurement));
  drain();
}

void Pass::push(Measurement measurement) {
  if (std::holds_alternative<PoseTruth>(measurement.reading)) return;  // reference: for the evaluation only
  const io::SensorConfig* sensor = sensorConfig(inputs_.config, measurement.sensor);
  if (sensor != nullptr) measurement.stamp -= durationFromSeconds(sensor->latency);
  if (sensor != nullptr && !sensor->use) {
    for (Recorder& recorder : recorders_) recorder.withhold(measurement, "switched off by sensors.use");
    return;
  }
  sequencer_.push(faults_.applied(std::move(measurement)));
}

void Pass::drain() {
  while (const auto measurement = sequencer_.pop()) {
    if (epoch_ != measurement->stamp) beginEpoch(measurement->stamp);
    for (Recorder& recorder : recorders_) takeBy(recorder, *measurement);
  }
}

void Pass::beginEpoch(Stamp stamp) {
  endEpoch();
  if (!started_) result_.first = result_.last = stamp;
  started_ = true;
  epoch_ = stamp;
  result_.last = std::max(result_.last, stamp);
}

void Pass::takeBy(Recorder& recorder, const Measurement& measurement) {
  const IngestReport report = recorder.take(measurement);
  if (report.event.empty()) return;
  note({measurement.stamp, recorder.name(), "estimator", measurement.sensor, std::string(report.event)});
}

void Pass::note(const io::RunEvent& event) {
  if (events_) events_->write(event);
  if (on_event_) on_event_(event);
}

void Pass::endEpoch() {
  if (!epoch_) return;
  for (Recorder& recorder : recorders_) {
    recorder.endEpoch(*epoch_);
    for (const io::RunEvent& event : recorder.takeEvents()) note(event);
  }
  epoch_.reset();
}

void Pass::finish() {
  sequencer_.finish();
  drain();
  endEpoch();
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
