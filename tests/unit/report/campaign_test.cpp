#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "pos/core/error.hpp"
#include "pos/core/random.hpp"
#include "pos/report/campaign_files.hpp"
#include "pos/report/campaign_html.hpp"
#include "pos/report/campaign_table.hpp"

namespace pos::report {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr std::size_t kMoments = 400;

/// An estimator whose error wanders around `error` and that claims `claimed`.
eval::CampaignEntry entryOf(const std::string& name, double error, double claimed, RandomStream random) {
  eval::CampaignEntry entry{
      .name = name, .type = "test", .metrics = {}, .events = {{"gate opened", 2}}, .cells = {}};
  double squares = 0.0;
  double worst = 0.0;
  const double level = error * std::exp(0.2 * random.normal());
  for (std::size_t k = 0; k < kMoments; ++k) {
    const double burst = k > 200 && k < 240 ? 2.0 : 1.0;
    const double x = burst * level * random.normal();
    const double y = burst * level * random.normal();
    const double squared = x * x + y * y;
    entry.cells.push_back({.squared_xy = squared,
                           .nees_xy = squared / (claimed * claimed),
                           .nees_pose = squared / (claimed * claimed) + 1.0,
                           .nis = 1.0,
                           .nis_dof = 1.0});
    squares += squared;
    worst = std::max(worst, std::sqrt(squared));
  }
  const double rmse = std::sqrt(squares / kMoments);
  entry.metrics = {{"errors.xy.rmse", rmse},
                   {"errors.xy.median", 0.8 * rmse},
                   {"errors.xy.p95", 1.7 * rmse},
                   {"errors.xy.max", worst},
                   {"errors.yaw.rmse", 5.0 * rmse},
                   {"consistency.nees_xy_mean", rmse * rmse / claimed / claimed},
                   {"coverage", 1.0},
                   {"errors.z.rmse", std::nullopt}};
  return entry;
}

eval::CampaignRun demoRun(std::uint64_t index) {
  return {.index = index,
          .seed = eval::seedOfRun(1, index),
          .repeat = "pos replay a.yaml --seed " + std::to_string(eval::seedOfRun(1, index)),
          .estimators = {entryOf("range_odometry", 0.20, 0.20, RandomStream(1, 3 * index)),
                         entryOf("mcl <fast>", 0.21, 0.15, RandomStream(1, 3 * index + 1)),
                         entryOf("dead_reckoning", 1.5, 2.5, RandomStream(1, 3 * index + 2))}};
}

eval::CampaignSummary demo(std::uint64_t runs = 60, std::uint64_t wanted = 60) {
  eval::CampaignTotals totals({.name = "Demo campaign",
                               .input = "demo.rawlog",
                               .map = "demo",
                               .seed = 1,
                               .runs = wanted,
                               .step = 0.5,
                               .baseline = "range_odometry"});
  for (std::uint64_t run = 0; run < runs; ++run) totals.add(demoRun(run));
  return totals.summary();
}

TEST(CampaignRunJson, ReadsBackWithExactMetricsAndSixDigitsOfTheGrid) {
  const eval::CampaignRun run = demoRun(7);
  const std::string text = campaignRunJson(run, "abc");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  const eval::CampaignRun back = campaignRunFrom(text, "f", "abc");
  EXPECT_EQ(back.index, 7U);
  EXPECT_EQ(back.seed, run.seed);
  EXPECT_EQ(back.repeat, run.repeat);
  ASSERT_EQ(back.estimators.size(), 3U);
  EXPECT_EQ(back.estimators[1].name, "mcl <fast>");
  EXPECT_EQ(back.estimators[0].metrics, run.estimators[0].metrics);
  EXPECT_EQ(back.estimators[0].events, run.estimators[0].events);
  ASSERT_EQ(back.estimators[0].cells.size(), kMoments);
  for (std::size_t k = 0; k < kMoments; ++k) {
    const double value = run.estimators[0].cells[k].squared_xy;
    EXPECT_NEAR(back.estimators[0].cells[k].squared_xy, value, 5e-6 * value);
  }
  EXPECT_EQ(campaignRunJson(back, "abc"), text) << "reading and writing again changes nothing";
}

TEST(CampaignRunJson, MomentsWithoutAValueStayWithout) {
  eval::CampaignRun run = demoRun(0);
  run.estimators.resize(1);
  run.estimators[0].cells = {{}, {.squared_xy = 1.0}, {.squared_xy = 0.0, .nees_xy = 2.0}};
  const auto cells = campaignRunFrom(campaignRunJson(run, "a"), "f", "a").estimators[0].cells;
  ASSERT_EQ(cells.size(), 3U);
  EXPECT_TRUE(std::isnan(cells[0].squared_xy));
  EXPECT_DOUBLE_EQ(cells[2].squared_xy, 0.0);
  EXPECT_TRUE(std::isnan(cells[1].nees_xy));
  EXPECT_TRUE(std::isnan(cells[2].nees_pose));
  EXPECT_DOUBLE_EQ(cells[2].nis, 0.0);
}

TEST(CampaignRunJson, DamageAndStrangersAreRefused) {
  const std::string text = campaignRunJson(demoRun(0), "abc");
  for (const std::string& bad :
       {text.substr(0, text.size() / 2), std::string(), std::string("{}"), std::string("[1]"),
        std::regex_replace(text, std::regex("\"nis\":\\[1.0,"), "\"nis\":[")}) {
    EXPECT_THROW(campaignRunFrom(bad, "runs/000000.json", "abc"), DataError) << bad.substr(0, 40);
  }
  EXPECT_THROW(campaignRunFrom(text, "runs/000000.json", "abd"), ConfigError);
}

TEST(CampaignJson, HoldsFiguresWorstRunAndPairs) {
  const eval::CampaignSummary campaign = demo();
  const json all = json::parse(campaignJson(campaign));
  EXPECT_EQ(all.at("format"), "pos.campaign/1");
  EXPECT_EQ(all.at("campaign").at("runs_done"), 60);
  const json& rmse = all.at("estimators").at("range_odometry").at("metrics").at("errors.xy.rmse");
  EXPECT_EQ(rmse.at("count"), 60);
  EXPECT_EQ(rmse.at("worst").at("value"), rmse.at("max"));
  EXPECT_THAT(rmse.at("worst").at("repeat").get<std::string>(),
              HasSubstr("--seed " + std::to_string(rmse.at("worst").at("seed").get<std::uint64_t>())));
  EXPECT_EQ(all.at("estimators").at("range_odometry").at("events").at("gate opened"), 120);
  EXPECT_FALSE(all.at("estimators").at("range_odometry").at("metrics").contains("errors.z.rmse"));
  EXPECT_NEAR(all.at("estimators").at("range_odometry").at("nis_per_dof").get<double>(), 1.0, 1e-12);
  EXPECT_EQ(all.at("pairs").front().at("baseline"), "range_odometry");
}

TEST(CampaignCsv, TablesAreWhole) {
  const eval::CampaignSummary campaign = demo(5, 5);
  const auto columns = [](const std::string& line) { return std::count(line.begin(), line.end(), ',') + 1; };
  for (const std::string& csv : {campaignCsv(campaign), runsCsv(campaign), momentsCsv(campaign)}) {
    std::istringstream lines(csv);
    std::string head;
    std::getline(lines, head);
    std::size_t count = 0;
    for (std::string line; std::getline(lines, line); ++count)
      EXPECT_EQ(columns(line), columns(head)) << line;
    EXPECT_GT(count, 14U);
    EXPECT_THAT(csv, Not(HasSubstr("nan")));
  }
  const std::string runs = runsCsv(campaign);
  EXPECT_EQ(std::count(runs.begin(), runs.end(), '\n'), 1 + 5 * 3);
}

TEST(CampaignText, ShowsSpreadWorstRunAndTheComparison) {
  const std::string text = campaignText(demo());
  EXPECT_THAT(text, HasSubstr("\u00b1"));
  EXPECT_THAT(text, HasSubstr("[run "));
  EXPECT_THAT(text, HasSubstr("baseline"));
  EXPECT_THAT(text, HasSubstr("60 runs"));
}

TEST(CampaignWarnings, TellWhatIsMissingAndWhoIsDishonest) {
  const auto joined = [](const eval::CampaignSummary& campaign) {
    std::string all;
    for (const std::string& warning : campaignWarnings(campaign)) all += warning + "\n";
    return all;
  };
  EXPECT_THAT(joined(demo()), HasSubstr("mcl <fast> is too sure of itself"));
  EXPECT_THAT(joined(demo()), HasSubstr("dead_reckoning is too cautious"));
  EXPECT_THAT(joined(demo()), Not(HasSubstr("runs are done")));
  EXPECT_THAT(joined(demo()), Not(HasSubstr("recorded log")));
  eval::CampaignSummary recorded = demo();
  recorded.head.recorded = true;
  EXPECT_THAT(joined(recorded), HasSubstr("All runs share one recorded log"));
  EXPECT_THAT(joined(demo(8, 60)), HasSubstr("Only 8 of 60 runs are done."));
  EXPECT_THAT(joined(demo(8, 8)), HasSubstr("fewer than 20 runs"));
  eval::CampaignTotals same({.runs = 30, .step = 1.0});
  for (std::uint64_t run = 0; run < 30; ++run) {
    eval::CampaignRun copy = demoRun(0);
    copy.index = run;
    same.add(copy);
  }
  EXPECT_THAT(joined(same.summary()), HasSubstr("gives the same figures in every run"));
}

TEST(CampaignHtml, WritesTheDemoForPeopleToLookAt) {
  const auto folder = std::filesystem::path(POS_BINARY).parent_path() / "report_demo";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "campaign.html") << campaignHtml(demo(), "schema: 1\n");
  EXPECT_GT(std::filesystem::file_size(folder / "campaign.html"), 50'000U);
  EXPECT_LT(std::filesystem::file_size(folder / "campaign.html"), 1'000'000U);
}

TEST(CampaignHtml, NeedsNoNetworkAndEscapesNames) {
  const std::string html = campaignHtml(demo(), "a: <b>");
  EXPECT_THAT(html, Not(HasSubstr("https://")));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("<fast>")));
  EXPECT_THAT(html, HasSubstr("mcl &lt;fast&gt;"));
  EXPECT_FALSE(std::regex_search(html, std::regex("[\"> ,:-](nan|inf)[\"< ,}]")));
}

TEST(CampaignHtml, StandsUpToACampaignWithoutTruthOrRuns) {
  eval::CampaignTotals none({.name = "empty", .runs = 3});
  EXPECT_THAT(campaignHtml(none.summary(), ""), HasSubstr("Only 0 of 3 runs are done."));
  eval::CampaignTotals blind({.name = "blind", .runs = 1});
  blind.add({.index = 0,
             .seed = 1,
             .repeat = "",
             .estimators = {{.name = "a",
                             .type = "t",
                             .metrics = {{"verdicts.total.applied", 3.0}},
                             .events = {},
                             .cells = {}}}});
  EXPECT_THAT(campaignHtml(blind.summary(), ""), HasSubstr("There is no truth"));
  EXPECT_TRUE(campaignFigures(blind.summary()).empty());
  EXPECT_THAT(campaignText(blind.summary()), HasSubstr("1 run;"));
}

TEST(CampaignFigures, TheSameRunsGiveTheSameBytes) {
  const auto first = campaignFigures(demo());
  const auto second = campaignFigures(demo());
  ASSERT_EQ(first.size(), second.size());
  ASSERT_EQ(first.size(), 7U);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].svg, second[i].svg);
}

}  // namespace
}  // namespace pos::report
