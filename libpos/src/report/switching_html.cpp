#include "html_parts.hpp"
#include "pos/report/text.hpp"

namespace pos::report {

namespace {

std::string secondsText(const std::optional<Stamp>& stamp, Stamp start) {
  return stamp ? fixed(seconds(*stamp - start), 3) : std::string(kNoValue);
}

std::string millisecondsText(const std::optional<double>& delay, std::string_view otherwise) {
  return delay ? fixed(1e3 * *delay, 1) : std::string(otherwise);
}

std::string switchRow(const std::string& estimator, const eval::ModeSwitch& each, Stamp start) {
  std::string html = "<tr><th scope=\"row\">" + escaped(estimator) + "</th>";
  html += "<td style=\"text-align:left\">" + escaped(each.from + " \u2192 " + each.to) + "</td>";
  html += element("td", secondsText(each.boundary, start)) + element("td", secondsText(each.started, start));
  html += element("td", millisecondsText(each.wait(), kNoValue));
  html += element("td", millisecondsText(each.delay(), "never"));
  return html + element("td", millisecondsText(each.delayToBetter(), "never")) + "</tr>\n";
}

}  // namespace

std::string switchingSection(const eval::RunSummary& run) {
  std::string rows;
  for (const eval::EstimatorSummary& estimator : run.estimators) {
    if (!estimator.switching) continue;
    for (const eval::ModeSwitch& each : estimator.switching->switches)
      rows += switchRow(estimator.name, each, run.start);
  }
  if (rows.empty()) return "";
  return "<h2 id=\"switching\">Switches between models</h2>\n<div class=\"scroll\"><table><thead><tr>"
         "<th scope=\"col\">estimator</th><th scope=\"col\" style=\"text-align:left\">models in use</th>"
         "<th scope=\"col\">true boundary s</th><th scope=\"col\">started s</th>"
         "<th scope=\"col\">waited ms</th><th scope=\"col\">delay ms</th>"
         "<th scope=\"col\">delay, better one leads ms</th></tr></thead><tbody>\n" +
         rows +
         "</tbody></table></div>\n<p class=\"note\">Started: the first reading of a model that joins was "
         "taken, or the next one of a model that leaves was due. Waited: from the true boundary to there, "
         "which is the sensor's doing. Delay: from the start until every model in use was heard, one that "
         "joins has a probability of 0.1, one that left at most 0.02, and the probabilities rest; the last "
         "column does not ask for the 0.1 where the better model leads.</p>\n";
}

}  // namespace pos::report
