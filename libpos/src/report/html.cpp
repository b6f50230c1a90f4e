#include "pos/report/html.hpp"

#include <algorithm>
#include <cmath>

#include "face_section.hpp"
#include "html_parts.hpp"
#include "pos/report/comparison.hpp"
#include "pos/report/face_files.hpp"
#include "pos/report/figures.hpp"
#include "pos/report/text.hpp"

namespace pos::report {

namespace {

std::string header(const eval::RunSummary& run) {
  std::string html = element("h1", escaped(run.run.empty() ? "Run" : run.run));
  html += "<dl class=\"facts\">";
  html += fact("Log", run.log) + fact("Map", run.map);
  html += fact("Recorded", momentText(run.start)) + fact("Length", durationText(run.end - run.start));
  html += fact("Objects read", grouped(run.log_end.objects)) + fact("Seed", std::to_string(run.seed));
  return html + "</dl>\n";
}

std::string alignmentNote(const eval::RunSummary& run) {
  for (const eval::EstimatorSummary& estimator : run.estimators) {
    if (!estimator.evaluation || estimator.evaluation->alignment.mode == eval::AlignmentMode::None) continue;
    return " Estimates were first aligned with the truth (" +
           std::string(name(estimator.evaluation->alignment.mode)) + "); summary.json holds the transforms.";
  }
  return run.has_truth ? " Estimates were not aligned with the truth." : "";
}

std::string comparisonSection(const eval::RunSummary& run) {
  std::string html = "<h2 id=\"comparison\">Comparison</h2>\n" + tableHtml(comparison(run));
  html +=
      "<p class=\"note\">\u2605 best of its column. Error = estimate \u2212 truth; "
      "xy, "
      "along, cross and yaw columns are rmse where nothing else is said. NEES of an honest estimator is 2, "
      "inside the bounds in brackets. Gated is the share of usable readings that were rejected.";
  const std::string truth_sigma = truthSigmaNote(run);
  return html + alignmentNote(run) + (truth_sigma.empty() ? "" : " " + escaped(truth_sigma)) + "</p>\n";
}

/// Folded away, so that the wheel scrolls the report and the file is read only when it is wanted.
std::string viewerSection(const std::string& viewer) {
  if (viewer.empty()) return "";
  const std::string file = escaped(viewer);
  return "<h2 id=\"viewer\">The run to play</h2>\n<details><summary>Plan, tracks and charts over "
         "time</summary>"
         "<iframe class=\"viewer\" loading=\"lazy\" title=\"The run to play\" src=\"" +
         file + "\"></iframe></details>\n<p class=\"note\"><a href=\"" + file +
         "\">Open it in a window of its own.</a> It is the file " + file +
         " beside this one; send both to send it along.</p>\n";
}

std::string reasonsText(const eval::Tally& tally) {
  std::string text;
  for (const auto& [reason, count] : tally.reasons) {
    text += (text.empty() ? "" : ", ") + reason + " (" + grouped(count) + ")";
  }
  return text;
}

std::string verdictRow(const std::string& estimator, const std::string& sensor, const eval::Tally& tally) {
  std::string html = "<tr><th scope=\"row\">" + escaped(estimator) + "</th>";
  html += "<td style=\"text-align:left\">" + escaped(sensor) + "</td>";
  for (const Verdict verdict : kVerdicts) html += element("td", grouped(tally.count(verdict)));
  const auto nis = tally.nisMean();
  html += element("td", nis ? rounded(*nis) + " of " + rounded(tally.nisDof()) : std::string(kNoValue));
  return html + "<td style=\"text-align:left;white-space:normal\">" + escaped(reasonsText(tally)) +
         "</td></tr>\n";
}

std::string verdictSection(const eval::RunSummary& run) {
  std::string rows;
  for (const eval::EstimatorSummary& estimator : run.estimators) {
    for (const auto& [sensor, tally] : estimator.verdicts.sensors()) {
      rows += verdictRow(estimator.name, sensor, tally);
    }
  }
  if (rows.empty()) return "";
  return "<h2>Verdicts</h2>\n<div class=\"scroll\"><table><thead><tr><th scope=\"col\">estimator</th>"
         "<th scope=\"col\" style=\"text-align:left\">sensor</th><th>applied</th><th>gated</th><th>too "
         "old</th>"
         "<th>unsupported</th><th>degenerate</th><th>not initialised</th><th>mean NIS</th>"
         "<th style=\"text-align:left\">reasons</th></tr></thead><tbody>\n" +
         rows +
         "</tbody></table></div>\n<p class=\"note\">Mean NIS of the applied readings \u201cof\u201d the "
         "value an "
         "honest filter gives; larger means that the sensor is noisier than its setting.</p>\n";
}

std::string shareText(const std::optional<double>& share) {
  return share ? percent(*share) : std::string(kNoValue);
}

std::string intervalRow(const eval::EstimatorSummary& estimator) {
  const eval::IntervalFigures& f = *estimator.intervals;
  const auto rmse = f.entryTimeRmse();
  std::string html = "<tr><th scope=\"row\">" + escaped(estimator.name) + "</th>";
  html += element("td", shareText(f.rightShare())) + element("td", shareText(f.rightShareClear()));
  html += element("td", percent(f.matched_share)) + element("td", grouped(f.record.entries));
  html +=
      element("td", grouped(f.record.exits)) + element("td", rmse ? rounded(*rmse) : std::string(kNoValue));
  html += element("td", f.record.branches > 0 ? rounded(f.record.branch_past) : std::string(kNoValue));
  return html + element("td", grouped(f.record.lost)) + element("td", grouped(f.record.passages_refused)) +
         "</tr>\n";
}

std::string intervalSection(const eval::RunSummary& run) {
  std::string rows;
  for (const eval::EstimatorSummary& estimator : run.estimators) {
    if (estimator.intervals) rows += intervalRow(estimator);
  }
  if (rows.empty()) return "";
  return "<h2 id=\"intervals\">Lock intervals</h2>\n<div class=\"scroll\"><table><thead><tr>"
         "<th scope=\"col\">estimator</th><th>right set</th><th>right set off boundaries</th>"
         "<th>on a roadway</th><th>entries</th><th>exits</th><th>entry time rmse s</th>"
         "<th>branch decided past m</th><th>lost</th><th>passages refused</th></tr></thead><tbody>\n" +
         rows +
         "</tbody></table></div>\n<p class=\"note\">Right set: share of the time in which exactly the "
         "intervals "
         "that hold the vehicle were named (those at least half probable); off boundaries leaves out what is "
         "within 3 sigma of one. Branch decided past: farthest beyond a junction before its way was "
         "known.</p>\n";
}

/// Decimals that show two digits of sigma, or four digits of the value where there is none.
int decimalsFor(const NamedValue& v) {
  const bool has_sigma = v.sigma > 0.0 && std::isfinite(v.sigma);
  const double size = has_sigma ? v.sigma : std::abs(v.value);
  if (!(size > 0.0) || !std::isfinite(size)) return 0;
  return std::clamp((has_sigma ? 1 : 3) - static_cast<int>(std::floor(std::log10(size))), 0, 12);
}

std::string diagnosticsSection(const eval::RunSummary& run) {
  std::string rows;
  for (const eval::EstimatorSummary& estimator : run.estimators) {
    for (const NamedValue& v : estimator.diagnostics) {
      rows +=
          "<tr><th scope=\"row\">" + escaped(estimator.name) + "</th><td style=\"text-align:left\">" +
          escaped(v.name) + "</td>" + element("td", fixed(v.value, decimalsFor(v))) +
          element("td", v.sigma > 0.0 ? "\u00b1 " + fixed(v.sigma, decimalsFor(v)) : std::string(kNoValue)) +
          "</tr>\n";
    }
  }
  if (rows.empty()) return "";
  return "<h2>State at the end</h2>\n<div class=\"scroll\"><table><thead><tr><th scope=\"col\">estimator</th>"
         "<th scope=\"col\" style=\"text-align:left\">quantity</th><th>value</th><th>sigma</th></tr></thead>"
         "<tbody>\n" +
         rows + "</tbody></table></div>\n";
}

}  // namespace

std::string reportHtml(const eval::RunSummary& run, const std::string& resolved_config,
                       const ReportExtras& extras) {
  std::string html = pageStart(run.run.empty() ? "Run" : run.run);
  html += header(run) + warningBox(warnings(run)) + comparisonSection(run) + intervalSection(run);
  html += switchingSection(run);
  html += faceSection(extras.faces) + viewerSection(extras.viewer);
  std::vector<NamedFigure> all = figures(run);
  for (const NamedFigure& figure : faceFigures(extras.faces)) all.push_back(figure);
  all.insert(all.end(), extras.pictures.begin(), extras.pictures.end());
  html += figureSection(all);
  html += verdictSection(run) + diagnosticsSection(run);
  return html + configSection(resolved_config) + pageEnd();
}

}  // namespace pos::report
