#pragma once
/// Where results go: the terminal, JSON on standard output, a run folder.

#include <optional>
#include <string>
#include <vector>

#include "common.hpp"
#include "inputs.hpp"
#include "pos/eval/requirement.hpp"
#include "pos/eval/run_summary.hpp"
#include "pos/io/run_folder.hpp"
#include "pos/report/html.hpp"

namespace pos::app {

struct OutputOptions {
  bool json = false;
  std::string folder;
  bool force = false;
  std::vector<std::string> requirements;
};

void addOutputs(CLI::App& verb, OutputOptions& options);

/// The run folder asked for with --out, if any.
std::optional<io::RunFolder> openRunFolder(const OutputOptions& options);

/// run.json alone: what went in, for a run whose results are judged later.
void writeRunJson(const io::RunFolder& folder, const Inputs& inputs);
/// run.json, summary.json, report.html and the figures; for a shearer the tables of the face; viewer.html
/// where there is a `viewer` to fill (viewerTemplate).
void writeRun(const io::RunFolder& folder, const Inputs& inputs, const eval::RunSummary& summary,
              report::ReportExtras extras, const std::optional<std::string>& viewer);

/// The comparison table, or the summary as JSON.
void show(const eval::RunSummary& summary, const OutputOptions& options, const io::RunFolder* folder,
          const Voice& voice);

/// A stretch of time: of the truth, of a log, of a trajectory.
struct Span {
  Stamp from;
  Stamp to;
};
/// Throws DataError when truth and `what` have no moment in common: such a truth judges nothing, and its
/// empty columns must not pass for a result.
void requireCommonTime(const Span& truth, const Span& other, const std::string& what);

/// Says how each requirement fared; throws RequirementMissed when one was missed.
void checkRequirements(const eval::RunSummary& summary, const std::vector<std::string>& requirements,
                       const Voice& voice);

/// The same for results already there.
void requireAllPassed(const std::vector<eval::RequirementResult>& results, const Voice& voice);

/// Throws UsageError for a requirement that no run of these estimators could answer, before the work is done.
/// Figures of a sensor are left for later: only the log tells its sensors.
void refuseUnknownMetrics(const std::vector<std::string>& requirements, const io::RunConfig& config);

}  // namespace pos::app
