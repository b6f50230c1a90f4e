#include "pos/report/campaign_html.hpp"

#include <array>

#include "html_parts.hpp"
#include "pos/report/campaign_table.hpp"
#include "pos/report/text.hpp"

namespace pos::report {

namespace {

constexpr std::array kWorstOf{"errors.xy.rmse", "errors.xy.max", "errors.yaw.rmse",
                              "consistency.nees_xy_mean"};

std::string cells(const std::vector<std::string>& texts) {
  std::string html;
  for (const std::string& text : texts) html += element("td", escaped(text));
  return html;
}

std::string leftCell(const std::string& text) {
  return "<td style=\"text-align:left\">" + escaped(text) + "</td>";
}

std::string rowHead(const std::string& text) {
  return "<tr><th scope=\"row\">" + escaped(text) + "</th>";
}

std::string header(const eval::CampaignSummary& campaign) {
  const eval::CampaignHead& head = campaign.head;
  std::string html = element("h1", escaped(head.name.empty() ? "Campaign" : head.name));
  const bool all = campaign.rows.size() == head.runs;
  html += "<dl class=\"facts\">" + fact("Input", head.input) + fact("Map", head.map);
  html += fact("Runs", grouped(campaign.rows.size()) + (all ? "" : " of " + grouped(head.runs)));
  html += fact("Seed", std::to_string(head.seed));
  if (head.step > 0.0) html += fact("Compared every", tickText(head.step) + " s");
  if (campaign.estimators.size() > 1) html += fact("Baseline", head.baseline);
  return html + "</dl>\n";
}

std::string comparisonSection(const eval::CampaignSummary& campaign) {
  return "<h2 id=\"comparison\">Comparison</h2>\n" + tableHtml(campaignComparison(campaign)) +
         "<p class=\"note\">\u2605 best of its column. Figures are means over the runs, \u00b1 the standard "
         "deviation of one run. Mean and max RMSE: root mean square of the horizontal error over the runs at "
         "every moment, then its mean and its largest over the moments. ANEES of an honest estimator is 2 "
         "and "
         "inside its 95 % bounds at 95 % of the moments. The last column is the change of the mean against "
         "the baseline, run by run, with its bootstrap interval; negative is better, an interval that holds "
         "zero decides nothing.</p>\n";
}

std::string worstSection(const eval::CampaignSummary& campaign) {
  std::string rows;
  for (const eval::EstimatorOverRuns& estimator : campaign.estimators) {
    for (const char* metric : kWorstOf) {
      const auto found = estimator.metrics.find(metric);
      if (found == estimator.metrics.end()) continue;
      const eval::CampaignRow& worst = campaign.rows[found->second.worst_row];
      rows +=
          rowHead(estimator.name) + leftCell(metricTitle(metric)) +
          cells({rounded(found->second.worst), rounded(found->second.median), std::to_string(worst.run)}) +
          "<td style=\"text-align:left;white-space:normal;overflow-wrap:anywhere\"><code>" +
          escaped(worst.repeat) + "</code></td></tr>\n";
    }
  }
  if (rows.empty()) return "";
  return "<h2 id=\"worst\">Worst runs</h2>\n<div class=\"scroll\"><table><thead><tr>"
         "<th scope=\"col\">estimator</th><th scope=\"col\" "
         "style=\"text-align:left\">figure</th><th>worst</th>"
         "<th>median run</th><th>run</th><th style=\"text-align:left\">repeat it</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string metricSection(const eval::CampaignSummary& campaign) {
  std::string rows;
  for (const eval::EstimatorOverRuns& estimator : campaign.estimators) {
    for (const auto& [name, f] : estimator.metrics) {
      rows += rowHead(estimator.name) + leftCell(name) +
              cells({grouped(f.count), rounded(f.mean), rounded(f.std), rounded(f.median), rounded(f.min),
                     rounded(f.max), std::to_string(campaign.rows[f.worst_row].run)}) +
              "</tr>\n";
    }
    for (const auto& [event, count] : estimator.events) {
      rows += rowHead(estimator.name) + leftCell("event: " + event + ", in all runs together") +
              cells({grouped(count), "", "", "", "", "", ""}) + "</tr>\n";
    }
  }
  if (rows.empty()) return "";
  return "<h2 id=\"metrics\">All figures</h2>\n<details><summary>Every figure of every estimator over the "
         "runs"
         "</summary><div class=\"scroll\"><table><thead><tr><th scope=\"col\">estimator</th>"
         "<th scope=\"col\" style=\"text-align:left\">figure</th><th>runs</th><th>mean</th><th>std</th>"
         "<th>median</th><th>min</th><th>max</th><th>worst run</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div></details>\n";
}

}  // namespace

std::string campaignHtml(const eval::CampaignSummary& campaign, const std::string& resolved_config) {
  return pageStart(campaign.head.name.empty() ? "Campaign" : campaign.head.name) + header(campaign) +
         warningBox(campaignWarnings(campaign)) + comparisonSection(campaign) +
         figureSection(campaignFigures(campaign)) + worstSection(campaign) + metricSection(campaign) +
         configSection(resolved_config) + pageEnd();
}

}  // namespace pos::report
