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
  if (watch_) watch_->openFile(folder);
}

void Recorder::watchIntervals(std::shared_ptr<const IntervalGround> ground,
                              const io::IntervalsConfig& config) {
  watch_ = std::make_unique<IntervalWatch>(std::move(ground), config, name());
}

void Recorder::tell(RecorderEars ears) {
  ears_ = std::move(ears);
  if (watch_) watch_->keepNothing();
}

void Recorder::flush() {
  if (watch_) watch_->flush();
  if (!files_) return;
  files_->tum.flush();
  files_->csv.flush();
}

IngestReport Recorder::take(const Measurement& measurement) {
  const io::PassageUse use = watch_ ? watch_->useOf(measurement) : io::PassageUse::AsTold;
  if (use == io::PassageUse::AsTold) return ingest(measurement);
  if (use == io::PassageUse::None) {
    withhold(measurement, "switched off by intervals.passages");
    return {.verdict = Verdict::Unsupported};
  }
  const auto fix = watch_->checked(measurement, estimator_->estimateAt(measurement.stamp));
  if (fix) return ingest(*fix);
  const IngestReport refused{.verdict = Verdict::Gated, .reason = "the vehicle is not beside that chamber"};
  note(measurement, refused);
  return refused;
}

IngestReport Recorder::ingest(const Measurement& measurement) {
  const auto before = std::chrono::steady_clock::now();
  const IngestReport report = estimator_->ingest(measurement);
  const auto spent = std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now() - before);
  if (report.verdict != Verdict::Unsupported && !ears_)
    record_.compute.add(spent);  // what it has no use for would flatter it
  if (!ears_) pictures_.look(*estimator_, measurement, report);
  note(measurement, report);
  return report;
}

void Recorder::withhold(const Measurement& measurement, std::string_view reason) {
  note(measurement, {.verdict = Verdict::Unsupported, .reason = reason});
}

void Recorder::note(const Measurement& measurement, const IngestReport& report) {
  const auto anchor = anchorOf(measurement);
  record_.verdicts.add(measurement.sensor, anchor, report);
  if (ears_) ears_->verdict(measurement, report);
  if (anchor && !ears_) record_.residuals.add(*anchor, measurement.stamp, report);
  if (record_.nis) record_.nis->add(measurement.stamp, report);
  if (!report.event.empty()) ++record_.events[std::string(report.event)];
  ++epoch_[static_cast<std::size_t>(report.verdict)];
}

void Recorder::endEpoch(Stamp stamp) {
  const bool thinned = last_ && stamp - *last_ < shortest_step_;
  if (thinned && !record_.switching) return;
  const auto estimate = estimator_->estimateAt(stamp);
  if (!estimate) return;
  watchSwitching(*estimate);
  if (thinned) return;
  last_ = estimate->stamp;
  if (!ears_) kept_.add(*estimate);
  if (files_) {
    files_->tum.write(*estimate);
    files_->csv.write(*estimate, epoch_);
  }
  epoch_ = {};
  const auto belief = watch_ ? watch_->take(*estimate) : std::nullopt;
  if (ears_) ears_->estimate(*estimate, belief);
  if (!watch_) return;
  const auto fix = watch_->offered(*estimate);
  if (fix && ingest(*fix).verdict == Verdict::Unsupported) watch_->stopOffering();
}

/// Switching is told from every output, however few are recorded.
void Recorder::watchSwitching(const Estimate& estimate) {
  if (estimate.modes.empty()) return;
  if (!record_.switching) record_.switching.emplace();
  record_.switching->take(estimate.stamp, estimate.modes);
}

std::vector<io::RunEvent> Recorder::takeEvents() {
  return watch_ ? watch_->takeEvents() : std::vector<io::RunEvent>{};
}

std::optional<report::NamedFigure> Recorder::sweepPicture() const {
  if (!pictures_.picture()) return std::nullopt;
  report::LegPicture picture = *pictures_.picture();
  picture.title += ", as " + name() + " took it";
  return report::NamedFigure{
      "legs_" + name(), picture.title,
      "Returns as measured; legs corrected by what the estimator knows of the scanner. The "
      "number beside a leg is how far from its support's expected place it was found.",
      report::drawingSvg(report::legDrawing(picture))};
}

eval::EstimatorRecord Recorder::finish() {
  record_.diagnostics = estimator_->diagnostics();
  record_.recorded = kept_.seen();
  record_.estimates = kept_.take();
  if (watch_) record_.intervals = watch_->finish();
  if (files_) {
    files_->tum.close();
    files_->csv.close();
  }
  return std::move(record_);
}

}  // namespace pos::app
