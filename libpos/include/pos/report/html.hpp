#pragma once
/// report.html: one file that needs no network.

#include <string>
#include <vector>

#include "pos/eval/face_geometry.hpp"
#include "pos/eval/run_summary.hpp"
#include "pos/report/figures.hpp"

namespace pos::report {

/// What a report shows beside the figures that every run has.
struct ReportExtras {
  std::vector<eval::EstimatorFace> faces = {};  ///< of shearers
  std::vector<NamedFigure> pictures = {};       ///< of single readings, after the figures
  std::string viewer = {};  ///< name of the file beside the report that holds the run to play; empty: none
};

/// The report of one run. `resolved_config` is shown as it is at the end.
std::string reportHtml(const eval::RunSummary& run, const std::string& resolved_config,
                       const ReportExtras& extras = {});

}  // namespace pos::report
