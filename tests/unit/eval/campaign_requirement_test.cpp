#include "pos/eval/campaign_requirement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pos/core/error.hpp"

namespace pos::eval {
namespace {

using ::testing::HasSubstr;

CampaignSummary campaign() {
  CampaignTotals totals({.runs = 3, .step = 1.0});
  for (std::uint64_t run = 0; run < 3; ++run) {
    CampaignEntry ekf{.name = "ekf",
                      .type = "t",
                      .metrics = {{"errors.xy.rmse", 1.0 + static_cast<double>(run)}, {"coverage", 1.0}},
                      .events = {},
                      .cells = {GridCell{.squared_xy = 4.0}}};
    CampaignEntry mcl = ekf;
    mcl.name = "mcl";
    mcl.metrics["errors.xy.rmse"] = 0.5;
    totals.add({.index = run, .seed = run, .repeat = "", .estimators = {ekf, mcl}});
  }
  return totals.summary();
}

TEST(CampaignRequirement, WithoutAPrefixTheMeanOverTheRunsCounts) {
  const auto results = checkOverRuns("rmse_xy<=2", campaign());
  ASSERT_EQ(results.size(), 2U);
  EXPECT_TRUE(results[0].passed);
  EXPECT_THAT(results[0].line, HasSubstr("ekf: errors.xy.rmse = 2, required <= 2 (mean over 3 runs)"));
  EXPECT_FALSE(checkOverRuns("ekf.rmse_xy<2", campaign()).front().passed);
}

TEST(CampaignRequirement, APrefixChoosesAnotherFigure) {
  EXPECT_FALSE(checkOverRuns("worst:ekf.rmse_xy<3", campaign()).front().passed);
  EXPECT_TRUE(checkOverRuns("worst:ekf.rmse_xy<=3", campaign()).front().passed);
  EXPECT_TRUE(checkOverRuns("min:ekf.errors.xy.rmse<=1", campaign()).front().passed);
  EXPECT_TRUE(checkOverRuns("std:ekf.rmse_xy<=1", campaign()).front().passed);
  EXPECT_FALSE(checkOverRuns("std:ekf.rmse_xy<1", campaign()).front().passed);
}

TEST(CampaignRequirement, KnowsTheFiguresOfAllRunsTogether) {
  EXPECT_TRUE(checkOverRuns("max_rmse_xy<=2", campaign()).front().passed);
  EXPECT_FALSE(checkOverRuns("mean_rmse_xy<2", campaign()).front().passed);
  EXPECT_FALSE(checkOverRuns("anees_xy_inside>0.9", campaign()).front().passed) << "no covariance, no value";
}

TEST(CampaignRequirement, UnknownWordsAreRefusedBeforeTheRuns) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      refuseUnknownOverRuns(text, {"ekf"});
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message("largest:rmse_xy<1"), HasSubstr("mean, std, median, min, max or worst"));
  EXPECT_THAT(message("worst:rmsx_xy<1"), HasSubstr("did you mean rmse_xy?"));
  EXPECT_THAT(message("worst:ekg.rmse_xy<1"), HasSubstr("did you mean ekf?"));
  EXPECT_THAT(message("real_time_factor>1"), HasSubstr("unknown metric"));
  EXPECT_EQ(message("worst:ekf.rmse_xy<1"), "");
  EXPECT_EQ(message("nis_uwb_mean<1"), "");
}

}  // namespace
}  // namespace pos::eval
