#pragma once
/// summary.json, described in docs/formats/summary.md and docs/formats/summary.schema.json.

#include <string>

#include "pos/eval/run_summary.hpp"

namespace pos::report {

/// Everything, with the compute times of this machine and moment.
std::string summaryJson(const eval::RunSummary& run);

/// Without compute times: the same log, configuration and seed give the same bytes.
std::string repeatableSummaryJson(const eval::RunSummary& run);

}  // namespace pos::report
