#include "recorder.hpp"

#include <chrono>

namespace pos::app {
namespace {

std::optional<AnchorId> anchorOf(const Measurement& measurement) {
  const auto* range = std::get_if<BeaconRange>(&measurement.reading);
  return range != nullptr ? std::optional(range->anchor) : std::nullopt;
}

}  // namespace

Recorder::Recorder(const std::string& name, const std::string& type,
                   std::unique_ptr<estimation::Estimator> estimator, double max_rate)
    : estimator_(std::move(estimator)), shortest_step_(durationFromSeconds(1.0 / max_rate)) {
  record_.name = name;
  record_.type = type;
}

void Recorder::openFiles(const io::RunFolder& folder) {
  files_ = std::make_unique<RecorderFiles>(
      RecorderFiles{io::TumWriter(folder.tum(name())), io::EstimateCsvWriter(folder.csv(name()))});
}

IngestReport Recorder::take(const Measurement& measurement) {
  const auto before = std::chrono::steady_clock::now();
  const IngestReport report = estimator_->ingest(measurement);
  const auto spent = std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now() - before);
  if (report.verdict != Verdict::Unsupported)
    record_.compute.add(spent);  // what it has no use for would flatter it
  note(measurement, report);
  return report;
}

void Recorder::withhold(const Measurement& measurement, std::string_view reason) {
  note(measurement, {.verdict = Verdict::Unsupported, .reason = reason});
}

void Recorder::note(const Measurement& measurement, const IngestReport& report) {
  const auto anchor = anchorOf(measurement);
  record_.verdicts.add(measurement.sensor, anchor, report);
  if (anchor) record_.residuals.add(*anchor, measurement.stamp, report);
  if (record_.nis) record_.nis->add(measurement.stamp, report);
  if (!report.event.empty()) ++record_.events[std::string(report.event)];
  ++epoch_[static_cast<std::size_t>(report.verdict)];
}

void Recorder::endEpoch(Stamp stamp) {
  if (!record_.estimates.empty() && stamp - record_.estimates.back().stamp < shortest_step_) return;
  const auto estimate = estimator_->estimateAt(stamp);
  if (!estimate) return;
  record_.estimates.push_back(*estimate);
  if (files_) {
    files_->tum.write(*estimate);
    files_->csv.write(*estimate, epoch_);
  }
  epoch_ = {};
}

eval::EstimatorRecord Recorder::finish() {
  record_.diagnostics = estimator_->diagnostics();
  if (files_) {
    files_->tum.close();
    files_->csv.close();
  }
  return std::move(record_);
}

}  // namespace pos::app
