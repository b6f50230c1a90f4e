#include "pos/eval/campaign.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "pos/core/error.hpp"
#include "pos/core/random.hpp"

namespace pos::eval {
namespace {

constexpr double kNone = GridCell::kNothing;

CampaignEntry entry(const std::string& name, double rmse, std::vector<GridCell> cells = {}) {
  return {.name = name, .type = "ekf", .metrics = {{"errors.xy.rmse", rmse}}, .events = {}, .cells = cells};
}

CampaignRun runOf(std::uint64_t index, std::vector<CampaignEntry> estimators) {
  return {.index = index,
          .seed = 100 + index,
          .repeat = "pos replay c.yaml --seed " + std::to_string(100 + index),
          .estimators = std::move(estimators)};
}

GridCell cell(double error, double nees = kNone) {
  return {.squared_xy = error * error, .nees_xy = nees};
}

CampaignSummary summaryOf(const std::vector<CampaignRun>& runs, const std::string& baseline = "") {
  CampaignTotals totals(
      {.name = "c", .input = "i", .map = "m", .runs = runs.size(), .step = 0.5, .baseline = baseline});
  for (const CampaignRun& run : runs) totals.add(run);
  return totals.summary();
}

TEST(SeedOfRun, IsAFixedFunctionOfCampaignSeedAndRun) {
  EXPECT_EQ(seedOfRun(1, 0), seedOfRun(1, 0));
  std::set<std::uint64_t> all;
  for (std::uint64_t campaign = 0; campaign < 20; ++campaign) {
    for (std::uint64_t run = 0; run < 500; ++run) {
      const std::uint64_t seed = seedOfRun(campaign, run);
      EXPECT_LT(seed, std::uint64_t{1} << 53U);
      all.insert(seed);
    }
  }
  EXPECT_EQ(all.size(), 10000U);  // 1e8 / 2^54: no collision, whatever the campaign seed
}

TEST(SeedOfRun, IsThePublishedRule) {
  const auto words = philox4x32({7, 0, 0, 2}, {42, 0});
  EXPECT_EQ(seedOfRun(42, 7), ((std::uint64_t{words[0]} << 32U) | words[1]) >> 11U);
}

TEST(Shard, EveryRunLiesInExactlyOne) {
  for (std::uint64_t run = 0; run < 50; ++run) {
    int holders = 0;
    for (std::uint64_t number = 1; number <= 7; ++number) holders += Shard{number, 7}.holds(run) ? 1 : 0;
    EXPECT_EQ(holders, 1) << run;
  }
}

TEST(OverRuns, MeanSpreadMedianAndWorstAreThoseOfTheValues) {
  const auto figures = overRuns("errors.xy.rmse", {2.0, kNone, 4.0, 9.0});
  ASSERT_TRUE(figures);
  EXPECT_EQ(figures->count, 3U);
  EXPECT_DOUBLE_EQ(figures->mean, 5.0);
  EXPECT_DOUBLE_EQ(figures->std, std::sqrt((9.0 + 1.0 + 16.0) / 2.0));  // divided by n - 1
  EXPECT_DOUBLE_EQ(figures->median, 4.0);
  EXPECT_DOUBLE_EQ(figures->min, 2.0);
  EXPECT_DOUBLE_EQ(figures->max, 9.0);
  EXPECT_DOUBLE_EQ(figures->worst, 9.0);
  EXPECT_EQ(figures->worst_row, 3U);
}

TEST(OverRuns, MedianOfAnEvenNumberLiesHalfWay) {
  EXPECT_DOUBLE_EQ(overRuns("errors.xy.rmse", {1.0, 2.0, 10.0, 4.0})->median, 3.0);
}

TEST(OverRuns, WorstDependsOnWhatTheMetricMeans) {
  EXPECT_DOUBLE_EQ(overRuns("errors.along.mean", {0.5, -2.0, 1.0})->worst, -2.0);
  EXPECT_DOUBLE_EQ(overRuns("fraction_under.0.5_m", {0.9, 0.2, 0.7})->worst, 0.2);
  EXPECT_DOUBLE_EQ(overRuns("coverage", {1.0, 0.9})->worst, 0.9);
  EXPECT_DOUBLE_EQ(overRuns("consistency.nees_xy_mean", {2.0, 6.0, 0.2})->worst, 0.2);  // 10 x against 3 x
}

TEST(OverRuns, NoValueAtAllGivesNothing) {
  EXPECT_FALSE(overRuns("errors.xy.rmse", {kNone, kNone}));
  EXPECT_FALSE(overRuns("errors.xy.rmse", {}));
}

TEST(CampaignTotals, RmsePerMomentIsTakenOverTheRunsAndThenAveraged) {
  // e_0 = sqrt((9 + 16) / 2), e_1 = 1 (one run only), e_2 = 2
  const CampaignSummary summary =
      summaryOf({runOf(0, {entry("a", 1.0, {cell(3.0), cell(1.0), cell(2.0)})}),
                 runOf(1, {entry("a", 1.0, {cell(4.0), GridCell{}, cell(2.0)})})});
  const EstimatorOverRuns& a = summary.estimators.front();
  ASSERT_EQ(a.moments.size(), 3U);
  EXPECT_DOUBLE_EQ(a.moments[0].rmse_xy, std::sqrt(12.5));
  EXPECT_EQ(a.moments[1].runs, 1U);
  EXPECT_DOUBLE_EQ(a.moments[1].rmse_xy, 1.0);
  EXPECT_DOUBLE_EQ(a.moments[2].t, 1.0);
  EXPECT_DOUBLE_EQ(*a.mean_rmse_xy, (std::sqrt(12.5) + 1.0 + 2.0) / 3.0);
  EXPECT_DOUBLE_EQ(*a.max_rmse_xy, std::sqrt(12.5));
}

TEST(CampaignTotals, OneRunGivesMeanAndMaximumOfTheErrorItself) {
  const CampaignSummary summary = summaryOf({runOf(0, {entry("a", 1.0, {cell(3.0), cell(1.0)})})});
  EXPECT_DOUBLE_EQ(*summary.estimators.front().mean_rmse_xy, 2.0);
  EXPECT_DOUBLE_EQ(*summary.estimators.front().max_rmse_xy, 3.0);
}

TEST(CampaignTotals, AMetricThatOneRunLacksKeepsItsRow) {
  CampaignRun second = runOf(1, {entry("a", 2.0)});
  second.estimators[0].metrics["consistency.nis_uwb_mean"] = 1.25;
  const CampaignSummary summary =
      summaryOf({runOf(0, {entry("a", 1.0)}), second, runOf(5, {entry("a", 4.0)})});
  const auto& values = summary.estimators.front().values.at("consistency.nis_uwb_mean");
  ASSERT_EQ(values.size(), 3U);
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_DOUBLE_EQ(values[1], 1.25);
  EXPECT_TRUE(std::isnan(values[2]));
  EXPECT_EQ(summary.rows[2].run, 5U);
}

TEST(CampaignTotals, EventsAreAddedUp) {
  CampaignRun first = runOf(0, {entry("a", 1.0)});
  CampaignRun second = runOf(1, {entry("a", 1.0)});
  first.estimators[0].events = {{"gate opened", 2}};
  second.estimators[0].events = {{"gate opened", 3}, {"lost", 1}};
  const CampaignSummary summary = summaryOf({first, second});
  const auto& events = summary.estimators.front().events;
  EXPECT_EQ(events.at("gate opened"), 5U);
  EXPECT_EQ(events.at("lost"), 1U);
}

TEST(CampaignTotals, RefusesRunsOutOfOrderAndOtherEstimators) {
  CampaignTotals totals({});
  totals.add(runOf(3, {entry("a", 1.0)}));
  EXPECT_THROW(totals.add(runOf(3, {entry("a", 1.0)})), ContractError);
  EXPECT_THROW(totals.add(runOf(4, {entry("b", 1.0)})), ContractError);
}

TEST(Anees, AnHonestEstimatorLiesInsideTheBoundsAsOftenAsPromised) {
  // 2000 independent moments of 30 runs: 5 % outside, binomial 99.9 % interval of the share +- 1.6 %
  CampaignTotals totals({.step = 1.0});
  for (std::uint64_t run = 0; run < 30; ++run) {
    RandomStream random(5, run);
    std::vector<GridCell> cells(2000);
    for (GridCell& each : cells) {
      each.squared_xy = 1.0;
      each.nees_xy = std::pow(random.normal(), 2) + std::pow(random.normal(), 2);
      each.nees_pose =
          std::pow(random.normal(), 2) + std::pow(random.normal(), 2) + std::pow(random.normal(), 2);
    }
    totals.add(runOf(run, {entry("a", 1.0, cells)}));
  }
  const EstimatorOverRuns a = totals.summary().estimators.front();
  EXPECT_NEAR(a.anees_xy.inside(), 0.95, 0.016);
  EXPECT_NEAR(a.anees_pose.inside(), 0.95, 0.016);
  EXPECT_NEAR(a.anees_xy.mean, 2.0, 3.3 * std::sqrt(4.0 / 60000.0));
  EXPECT_NEAR(a.anees_pose.mean, 3.0, 3.3 * std::sqrt(6.0 / 60000.0));
  EXPECT_GT(a.anees_xy.above, 0.01);
  EXPECT_GT(a.anees_xy.below, 0.01);
}

TEST(Anees, SigmasTooSmallAndTooLargeAreToldApart) {
  std::vector<CampaignRun> sure;
  std::vector<CampaignRun> cautious;
  for (std::uint64_t run = 0; run < 20; ++run) {
    sure.push_back(runOf(run, {entry("a", 1.0, {cell(1.0, 8.0)})}));
    cautious.push_back(runOf(run, {entry("a", 1.0, {cell(1.0, 0.5)})}));
  }
  EXPECT_DOUBLE_EQ(summaryOf(sure).estimators[0].anees_xy.above, 1.0);
  EXPECT_DOUBLE_EQ(summaryOf(cautious).estimators[0].anees_xy.below, 1.0);
  EXPECT_EQ(summaryOf(sure).estimators[0].anees_pose.moments, 0U);
}

TEST(Paired, AConstantAdvantageHasAnIntervalOfNoWidth) {
  std::vector<CampaignRun> runs;
  for (std::uint64_t i = 0; i < 12; ++i) {
    const double base = 1.0 + 0.1 * static_cast<double>(i);
    runs.push_back(runOf(i, {entry("base", base), entry("new", base - 0.25)}));
  }
  const CampaignSummary summary = summaryOf(runs, "base");
  ASSERT_EQ(summary.pairs.size(), 1U);
  const PairedComparison& pair = summary.pairs.front();
  EXPECT_EQ(pair.estimator, "new");
  EXPECT_EQ(pair.count, 12U);
  EXPECT_NEAR(pair.difference, -0.25, 1e-12);
  EXPECT_NEAR(pair.difference_bounds.low, -0.25, 1e-12);
  EXPECT_NEAR(pair.difference_bounds.high, -0.25, 1e-12);
  EXPECT_NEAR(pair.change, -0.25 / 1.55, 1e-12);
  EXPECT_LT(pair.change_bounds.low, pair.change);
  EXPECT_GT(pair.change_bounds.high, pair.change);
  EXPECT_DOUBLE_EQ(pair.better_share, 1.0);
  EXPECT_FALSE(pair.undecided());
}

TEST(Paired, NoDifferenceIsUndecided) {
  std::vector<CampaignRun> runs;
  RandomStream random(3, 0);
  for (std::uint64_t i = 0; i < 40; ++i) {
    const double base = random.normal(2.0, 0.2);
    runs.push_back(runOf(i, {entry("base", base), entry("new", base + (i % 2 == 0 ? 0.1 : -0.1))}));
  }
  const CampaignSummary summary = summaryOf(runs, "base");
  EXPECT_TRUE(summary.pairs.front().undecided());
  EXPECT_DOUBLE_EQ(summary.pairs.front().better_share, 0.5);
}

TEST(Paired, OnlyRunsWithBothValuesCount) {
  CampaignRun half = runOf(2, {entry("base", 1.0), entry("new", 5.0)});
  half.estimators[0].metrics["errors.xy.rmse"] = std::nullopt;
  const CampaignSummary summary = summaryOf({runOf(0, {entry("base", 1.0), entry("new", 2.0)}),
                                             runOf(1, {entry("base", 1.0), entry("new", 2.0)}), half},
                                            "base");
  EXPECT_EQ(summary.pairs.front().count, 2U);
  EXPECT_DOUBLE_EQ(summary.pairs.front().difference, 1.0);
  EXPECT_TRUE(summaryOf({runOf(0, {entry("base", 1.0), entry("new", 2.0)})}, "base").pairs.empty());
}

}  // namespace
}  // namespace pos::eval
