#pragma once
/// report.html: one file that needs no network.

#include <string>

#include "pos/eval/run_summary.hpp"

namespace pos::report {

/// The report of one run. `resolved_config` is shown as it is at the end.
std::string reportHtml(const eval::RunSummary& run, const std::string& resolved_config);

}  // namespace pos::report
