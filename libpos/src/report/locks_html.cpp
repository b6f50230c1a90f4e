#include "pos/report/locks_html.hpp"

#include "html_parts.hpp"
#include "pos/report/text.hpp"

namespace pos::report {

std::string locksHtml(const LockReport& run, const std::string& resolved_config) {
  std::string html = pageStart(run.title) + element("h1", escaped(run.title));
  html += "<dl class=\"facts\">" + fact("Map", run.map) + "</dl>\n" + warningBox(run.warnings);
  html += "<h2>Figures of the run</h2>\n<div class=\"scroll\"><table><tbody>\n";
  for (const LockFigure& figure : run.figures) {
    html += "<tr><th scope=\"row\">" + escaped(figure.name) + "</th>" + element("td", escaped(figure.value)) +
            "</tr>\n";
  }
  html += "</tbody></table></div>\n" + figureSection({timeDistanceFigure(run.diagram)});
  return html + configSection(resolved_config) + pageEnd();
}

}  // namespace pos::report
