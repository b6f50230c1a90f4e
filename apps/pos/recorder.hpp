#pragma once
/// Keeps what one estimator said during a replay: on disk as it goes, and in memory for the evaluation.

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "interval_watch.hpp"
#include "pos/core/evenly_spread.hpp"
#include "pos/estimation/estimator.hpp"
#include "pos/eval/run_summary.hpp"
#include "pos/io/run_folder.hpp"
#include "pos/report/figures.hpp"
#include "sweep_pictures.hpp"

namespace pos::app {

/// The files of one estimator in a run folder.
struct RecorderFiles {
  io::TumWriter tum;
  io::EstimateCsvWriter csv;
};

/// Who wants to know at once what an estimator said.
struct RecorderEars {
  std::function<void(const Measurement&, const IngestReport&)> verdict;
  std::function<void(const Estimate&, const std::optional<interval::IntervalBelief>&)> estimate;
};

/// One estimator with its record. Estimates are recorded after the last measurement of a stamp, at most
/// `max_rate` times a second.
class Recorder {
 public:
  Recorder(const std::string& name, const std::string& type, std::unique_ptr<estimation::Estimator> estimator,
           double max_rate);
  Recorder(Recorder&&) = default;

  void openFiles(const io::RunFolder& folder);
  /// In memory keeps evenly spread estimates only, at most this many: enough to draw, where there is no truth
  /// to judge all of them by. The files hold all.
  void keepAtMost(std::size_t estimates) { kept_ = EvenlySpread<Estimate>(estimates); }
  /// Also sums the NIS of applied readings on a campaign's grid.
  void sumNisOn(const eval::TimeGrid& grid) { record_.nis.emplace(grid); }
  /// Also says in which lock intervals the vehicle is, and aids the estimator as configured; before
  /// openFiles.
  void watchIntervals(std::shared_ptr<const IntervalGround> ground, const io::IntervalsConfig& config);
  /// From now on `ears` are told, and nothing is kept in memory: a live feed has no end.
  void tell(RecorderEars ears);
  /// Gives the measurement to the estimator and notes verdict and time spent; returns what the estimator
  /// said.
  IngestReport take(const Measurement& measurement);
  /// Counts a measurement that the configuration keeps from the estimators.
  void withhold(const Measurement& measurement, std::string_view reason);
  /// All measurements with this stamp are in.
  void endEpoch(Stamp stamp);
  /// What the watch over intervals has to tell since the last call.
  std::vector<io::RunEvent> takeEvents();
  /// What is in the files so far goes to the disk.
  void flush();
  Diagnostics diagnostics() const { return estimator_->diagnostics(); }
  /// A picture of a sweep with legs, where the estimator used one.
  std::optional<report::NamedFigure> sweepPicture() const;
  /// Closes the files and hands out the record.
  eval::EstimatorRecord finish();

  const std::string& name() const { return record_.name; }
  const std::string& type() const { return record_.type; }

 private:
  IngestReport ingest(const Measurement& measurement);
  void note(const Measurement& measurement, const IngestReport& report);
  void watchSwitching(const Estimate& estimate);

  std::unique_ptr<estimation::Estimator> estimator_;
  eval::EstimatorRecord record_;
  std::unique_ptr<RecorderFiles> files_;
  std::unique_ptr<IntervalWatch> watch_;
  std::optional<RecorderEars> ears_;
  SweepPictures pictures_;
  std::optional<Stamp> last_;  ///< of the estimate recorded last
  EvenlySpread<Estimate> kept_{std::numeric_limits<std::size_t>::max()};
  Duration shortest_step_{};
  io::EpochVerdicts epoch_{};
};

}  // namespace pos::app
