#pragma once
/// The drawings of a report.

#include <string>
#include <vector>

#include "pos/eval/run_summary.hpp"

namespace pos::report {

struct NamedFigure {
  std::string name;     ///< file name without ending: "plan", "errors_ekf"
  std::string title;    ///< also drawn at the top of the drawing
  std::string caption;  ///< how to read it, plain text
  std::string svg;      ///< complete drawing
};

/// Every figure that this run has data for, in the order of the report. The same run gives the same bytes.
std::vector<NamedFigure> figures(const eval::RunSummary& run);

}  // namespace pos::report
