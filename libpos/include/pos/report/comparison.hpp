#pragma once
/// The table that answers "which estimator did best", for the terminal and for the report.

#include <string>
#include <vector>

#include "pos/eval/run_summary.hpp"

namespace pos::report {

struct ComparisonCell {
  std::string text;
  bool best = false;  ///< best of its column; never set for a single estimator or where all are equal
};

struct Comparison {
  std::vector<std::string> columns;               ///< headings with units
  std::vector<std::vector<ComparisonCell>> rows;  ///< one per estimator, as many cells as columns
};

Comparison comparison(const eval::RunSummary& run);

/// Any such table as aligned text; '*' marks the best of a column.
std::string tableText(const Comparison& table);

/// The comparison as aligned text; '*' marks the best of a column.
std::string comparisonTable(const eval::RunSummary& run);

/// One line that says how good the truth was taken to be; empty when it was taken as perfect.
std::string truthSigmaNote(const eval::RunSummary& run);

/// What a reader must know before trusting the figures, one sentence or two each: damaged log, missing truth,
/// coverage below 95 %, NEES outside its bounds, many gated readings, slower than real time.
std::vector<std::string> warnings(const eval::RunSummary& run);

}  // namespace pos::report
