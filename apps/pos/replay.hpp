#pragma once
/// The main loop: one log, several estimators, one pass.

#include <functional>
#include <optional>

#include "inputs.hpp"
#include "interval_watch.hpp"
#include "pos/eval/run_summary.hpp"
#include "pos/io/log_reader.hpp"
#include "pos/io/run_folder.hpp"
#include "pos/report/html.hpp"

namespace pos::app {

/// What came out of a pass over a log.
struct Replayed {
  std::vector<eval::EstimatorRecord> records;
  Stamp first;
  Stamp last;
  std::uint64_t measurements = 0;
  io::LogEnd log_end;
  io::LogTally tally;
  std::string source_note = {};  ///< of how the log was read
  bool interrupted = false;
  std::vector<report::NamedFigure> pictures = {};        ///< of single readings, for the report
  std::shared_ptr<const IntervalGround> intervals = {};  ///< null where intervals are not evaluated
};

/// Called now and then with the number of measurements so far and the stamp reached; false stops the pass.
using Progress = std::function<bool(std::uint64_t, Stamp)>;

/// The estimates in the records: all, or those that a report of the run needs.
enum class Keep { All, ForTheReport };

/// Runs every estimator of the configuration over its log. Files go to `folder` where there is one.
Replayed replayed(const Inputs& inputs, const io::RunFolder* folder, const Progress& progress,
                  Keep keep = Keep::All);

/// The face by every shearer of the run, and pictures of what it saw.
report::ReportExtras extrasOf(const Inputs& inputs, const Replayed& replayed);

/// Records, truth and log judged together.
eval::RunSummary summaryOf(const Inputs& inputs, const Replayed& replayed);

}  // namespace pos::app
