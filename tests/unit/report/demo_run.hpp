#pragma once
/// A made-up run with several estimators, for the tests of the report.

#include "pos/eval/run_summary.hpp"

namespace pos::report {

/// 2000 s round a block of roadways with four anchors, two stops and a grid: an honest filter, one that is
/// too sure of itself, and dead reckoning that drifts. The same every time.
eval::RunSummary demoRun();

}  // namespace pos::report
