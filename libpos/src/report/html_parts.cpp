#include "html_parts.hpp"

#include "pos/report/text.hpp"

namespace pos::report {

namespace {

constexpr std::string_view kStyle = R"(<style>
:root{color-scheme:light dark;--paper:#fff;--back:#f4f6f8;--ink:#1c2530;--muted:#5b6876;--line:#d9dfe5;--accent:#0072b2;
--warn-back:#fff4e0;--warn-line:#d58a00;--best:#e6f2fa}
@media(prefers-color-scheme:dark){:root{--paper:#161b22;--back:#0d1117;--ink:#e6edf3;--muted:#9aa7b4;--line:#2f3843;
--accent:#4ea8de;--warn-back:#2e2412;--warn-line:#e0a030;--best:#15303f}}
*{box-sizing:border-box}body{margin:0;background:var(--back);color:var(--ink);
font:16px/1.5 system-ui,-apple-system,"Segoe UI","DejaVu Sans",sans-serif}
main{max-width:1160px;margin:0 auto;padding:28px 20px 60px}h1{font-size:1.7rem;line-height:1.2;margin:0 0 .3rem}
h2{font-size:1.2rem;margin:2.4rem 0 .7rem}.facts{color:var(--muted);display:flex;flex-wrap:wrap;gap:.2rem 1.6rem;margin:0}
.facts div{display:flex;gap:.45rem}.facts dt{font-weight:600}.facts dd{margin:0;color:var(--ink);overflow-wrap:anywhere}
.warnings{background:var(--warn-back);border-left:4px solid var(--warn-line);border-radius:4px;margin:1.4rem 0 0;
padding:.7rem 1rem}.warnings ul{margin:.2rem 0 0;padding-left:1.2rem}
.scroll{overflow-x:auto;background:var(--paper);border:1px solid var(--line);border-radius:6px}
table{border-collapse:collapse;width:100%;font-size:.86rem;font-variant-numeric:tabular-nums}
th,td{padding:.42rem .5rem;text-align:right;white-space:nowrap;border-bottom:1px solid var(--line)}
small{font-size:.78rem;font-weight:400;color:var(--muted)}tbody tr:last-child td,tbody tr:last-child th{border-bottom:0}th:first-child,td:first-child{text-align:left}
thead th{font-weight:600;color:var(--muted);vertical-align:bottom;white-space:normal}tbody th{font-weight:600;white-space:normal;overflow-wrap:break-word;max-width:16rem}
td.best{background:var(--best);font-weight:600}.star{color:var(--accent)}
.note{color:var(--muted);font-size:.88rem;margin:.5rem 0 0}
figure{margin:0 0 1.6rem;background:var(--paper);border:1px solid var(--line);border-radius:6px;padding:14px 14px 10px}
figure svg{display:block;width:100%;height:auto;max-width:1120px}
figcaption{color:var(--muted);font-size:.9rem;margin:.5rem .3rem 0;max-width:80ch}
details{background:var(--paper);border:1px solid var(--line);border-radius:6px;padding:.6rem 1rem}
summary{cursor:pointer;font-weight:600}pre{overflow-x:auto;font-size:.85rem;line-height:1.4}
.viewer{display:block;width:100%;height:80vh;min-height:560px;border:0;margin:.6rem 0 0}
@media print{body{background:#fff}figure,table{break-inside:avoid}}
</style>
)";

/// Bounds in brackets go below their figure, small: the column stays narrow.
std::string withSecondLine(const std::string& text) {
  const std::size_t bracket = text.find(" [");
  if (bracket == std::string::npos) return text;
  return text.substr(0, bracket) + "<br><small>" + text.substr(bracket + 1) + "</small>";
}

}  // namespace

std::string pageStart(const std::string& title) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escaped(title) + "</title>\n" + std::string(kStyle) + "</head><body><main>\n";
}

std::string pageEnd() {
  return "</main></body></html>\n";
}

std::string element(const std::string& tag, const std::string& inner) {
  return "<" + tag + ">" + inner + "</" + tag.substr(0, tag.find(' ')) + ">";
}

std::string fact(const std::string& label, const std::string& value) {
  return "<div><dt>" + label + "</dt><dd>" + (value.empty() ? std::string(kNoValue) : escaped(value)) +
         "</dd></div>";
}

std::string warningBox(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return "";
  std::string html =
      "<section class=\"warnings\" role=\"note\"><strong>Before you trust these figures</strong><ul>";
  for (const std::string& warning : warnings) html += element("li", escaped(warning));
  return html + "</ul></section>\n";
}

std::string tableHtml(const Comparison& table) {
  std::string html = "<div class=\"scroll\"><table><thead><tr>";
  for (const std::string& column : table.columns) html += "<th scope=\"col\">" + escaped(column) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string text = escaped(row[c].text);
      if (c == 0) {
        html += "<th scope=\"row\">" + text + "</th>";
      } else if (row[c].best) {
        html += "<td class=\"best\"><span class=\"star\" aria-label=\"best\">\u2605</span> " +
                withSecondLine(text) + "</td>";
      } else {
        html += "<td>" + withSecondLine(text) + "</td>";
      }
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string figureSection(const std::vector<NamedFigure>& figures) {
  std::string html = "<h2>Figures</h2>\n";
  for (const NamedFigure& figure : figures) {
    html += "<figure id=\"" + escaped(figure.name) + "\">" + figure.svg + "<figcaption>" +
            escaped(figure.caption) + "</figcaption></figure>\n";
  }
  return html;
}

std::string configSection(const std::string& resolved_config) {
  if (resolved_config.empty()) return "";
  return "<h2>Configuration</h2>\n<details><summary>Resolved configuration</summary><pre>" +
         escaped(resolved_config) + "</pre></details>\n";
}

}  // namespace pos::report
