#pragma once
/// report.html: one file that needs no network.

#include <string>

#include "pos/eval/run_summary.hpp"

namespace pos::report {

/// The report of one run. `resolved_config` is shown as it is at the end. `viewer` is the name of the file
/// beside the report that holds the run to play; empty where there is none.
std::string reportHtml(const eval::RunSummary& run, const std::string& resolved_config,
                       const std::string& viewer = "");

}  // namespace pos::report
