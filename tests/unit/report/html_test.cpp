#include "pos/report/html.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "pos/report/comparison.hpp"
#include "pos/report/figures.hpp"
#include "unit/report/demo_run.hpp"

namespace pos::report {

namespace {

using testing::HasSubstr;
using testing::Not;

const eval::RunSummary& demo() {
  static const eval::RunSummary run = demoRun();
  return run;
}

std::string without(std::string text, const std::string& part) {
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part))
    text.erase(at, part.size());
  return text;
}

/// "nan" or "inf" where a number should be.
bool hasNonNumber(const std::string& text) {
  return std::regex_search(text, std::regex("[\"> ,:-](nan|inf)[\"< ,}]"));
}

}  // namespace

TEST(ReportHtml, WritesTheDemoForPeopleToLookAt) {
  const auto folder = std::filesystem::path(POS_BINARY).parent_path() / "report_demo";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "report.html")
      << reportHtml(demo(), "estimators:\n  - type: mcl\n    range_std_m: 0.1\n");
  for (const NamedFigure& figure : figures(demo()))
    std::ofstream(folder / (figure.name + ".svg")) << figure.svg;
  EXPECT_GT(std::filesystem::file_size(folder / "report.html"), 100'000U);
  EXPECT_LT(std::filesystem::file_size(folder / "report.html"), 4'000'000U);
}

TEST(ReportHtml, NeedsNoNetwork) {
  const std::string html = without(reportHtml(demo(), "a: 1"), "xmlns=\"http://www.w3.org/2000/svg\"");
  EXPECT_THAT(html, Not(HasSubstr("http://")));
  EXPECT_THAT(html, Not(HasSubstr("https://")));
  EXPECT_THAT(html, Not(HasSubstr("src=")));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("@import")));
  EXPECT_FALSE(std::regex_search(html, std::regex("href=\"(?!data:)")));
}

TEST(ReportHtml, ListsEverySwitchAndDrawsTheProbabilities) {
  eval::RunSummary run = demo();
  const Stamp boundary = run.start + durationFromSeconds(20.0);
  const Stamp started = boundary + durationFromSeconds(0.008);
  run.estimators[0].modes = {{"gnss", {{0.0, 20.0, 60.0}, {0.99, 0.98, 0.02}, {}}},
                             {"uwb", {{0.0, 20.0, 60.0}, {0.01, 0.02, 0.98}, {}}}};
  run.estimators[0].switching = eval::SwitchingFigures{
      {{"+uwb", "gnss", "gnss + uwb", started, started + durationFromSeconds(0.0256), {}, boundary},
       {"-gnss", "gnss + uwb", "uwb", boundary + durationFromSeconds(600.0), {}, {}, {}}}};
  const std::string html = reportHtml(run, "");
  EXPECT_THAT(html,
              HasSubstr("gnss \u2192 gnss + uwb</td><td>20.000</td><td>20.008</td><td>8.0</td><td>25.6</td>"
                        "<td>never</td>"));
  EXPECT_THAT(html, HasSubstr("<td>620.000</td><td>\u2013</td><td>never</td>"));
  EXPECT_THAT(html, HasSubstr("<figure id=\"modes\">"));
  EXPECT_THAT(html, HasSubstr(">+uwb 26 ms<"));
  EXPECT_THAT(html, HasSubstr(">-gnss never settled<"));
  EXPECT_THAT(reportHtml(demo(), ""), Not(HasSubstr("Switches between models")));
}

TEST(ReportHtml, LeadsToTheRunThatLiesBesideItAndToNothingWhereThereIsNone) {
  const std::string without_viewer = reportHtml(demo(), "a: 1");
  EXPECT_THAT(without_viewer, Not(HasSubstr("<iframe")));
  EXPECT_THAT(without_viewer, Not(HasSubstr("id=\"viewer\"")));
  const std::string html = reportHtml(demo(), "a: 1", {.viewer = "viewer.html"});
  EXPECT_THAT(html, HasSubstr("src=\"viewer.html\""));
  EXPECT_THAT(html, HasSubstr("href=\"viewer.html\""));
  EXPECT_LT(html.find("id=\"viewer\""), html.find("<h2>Figures"));
}

TEST(ReportHtml, EscapesNamesFromOutside) {
  eval::RunSummary run = demo();
  run.estimators.front().name = "<b>&\"x\"";
  run.estimators.front().diagnostics.front().name = "<script>";
  const std::string html = reportHtml(run, "key: <i>");
  EXPECT_THAT(html, HasSubstr("block &lt;A&amp;B&gt; &quot;demo&quot;"));
  EXPECT_THAT(html, HasSubstr("&lt;b&gt;&amp;&quot;x&quot;"));
  EXPECT_THAT(html, HasSubstr("key: &lt;i&gt;"));
  EXPECT_THAT(html, Not(HasSubstr("<b>")));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
}

TEST(ReportHtml, PutsWarningsAboveTheTableAndTheTableAboveTheFigures) {
  const std::string html = reportHtml(demo(), "");
  const std::size_t warning = html.find("The log is damaged");
  const std::size_t table = html.find("<table>");
  const std::size_t figure = html.find("<figure");
  ASSERT_NE(figure, std::string::npos);
  EXPECT_LT(warning, table);
  EXPECT_LT(table, figure);
}

TEST(ReportHtml, HasDrawingsOfEveryKind) {
  std::vector<std::string> names;
  for (const NamedFigure& figure : figures(demo())) names.push_back(figure.name);
  EXPECT_THAT(names, testing::ElementsAre("plan", "error_xy", "cdf_xy", "errors_1", "errors_2", "errors_3",
                                          "errors_4", "nees", "verdicts_sensors", "verdicts_anchors",
                                          "residuals", "compute"));
}

TEST(ReportHtml, NeverPrintsWhatIsNoNumber) {
  eval::RunSummary run = demo();
  run.estimators[0].diagnostics.push_back({"broken", std::nan(""), std::nan("")});
  run.estimators[0].evaluation->nees_xy.value.front() = std::nan("");
  run.estimators.push_back({});
  EXPECT_FALSE(hasNonNumber(reportHtml(run, "")));
}

TEST(ReportHtml, SurvivesARunWithNothingInIt) {
  const eval::RunSummary empty;
  const std::string html = reportHtml(empty, "");
  EXPECT_THAT(html, HasSubstr("The run has no estimator."));
  EXPECT_THAT(html, HasSubstr("</html>"));
  EXPECT_FALSE(hasNonNumber(html));
  EXPECT_TRUE(figures(empty).empty());
}

TEST(ReportHtml, DrawsARunWithASingleEstimate) {
  Truth truth;
  truth.poses = {{stampFromSeconds(0.0), {}}, {stampFromSeconds(1.0), {}}};
  eval::EstimatorRecord record;
  record.name = "one";
  record.estimates = {planarEstimate(stampFromSeconds(0.5), {0.3, 0.4, 0.0}, Matrix<3, 3>::Identity())};
  eval::RunSummary run;
  run.end = stampFromSeconds(1.0);
  run.has_truth = true;
  run.truth_path = eval::pathOf(truth, run.start);
  run.estimators.push_back(eval::summarise(record, &truth, run.start));
  const std::string html = reportHtml(run, "");
  EXPECT_FALSE(hasNonNumber(html));
  EXPECT_THAT(html, HasSubstr("0.500"));
  EXPECT_THAT(html, testing::ContainsRegex("<polyline points=\"([0-9.,]+) [0-9.,]+\" class=\"thick\""));
}

TEST(ReportHtml, DrawsWithoutTruth) {
  eval::EstimatorRecord record;
  record.name = "blind";
  for (int i = 0; i < 10; ++i) {
    record.estimates.push_back(
        planarEstimate(stampFromSeconds(i), {0.1 * i, 0.0, 0.0}, Matrix<3, 3>::Identity()));
  }
  eval::RunSummary run;
  run.end = stampFromSeconds(9.0);
  run.estimators.push_back(eval::summarise(record, nullptr, run.start));
  const std::string html = reportHtml(run, "");
  EXPECT_THAT(html, HasSubstr("holds no truth"));
  EXPECT_THAT(html, HasSubstr("id=\"plan\""));
  EXPECT_FALSE(hasNonNumber(html));
}

TEST(ReportHtml, SameRunGivesTheSameBytes) {
  EXPECT_EQ(reportHtml(demo(), "a"), reportHtml(demoRun(), "a"));
}

}  // namespace pos::report
