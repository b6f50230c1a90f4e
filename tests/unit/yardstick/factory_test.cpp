#include "pos/yardstick/factory.hpp"

#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "support/small_run.hpp"

namespace pos::yardstick {

TEST(Factory, MakesEveryTypeAndNamesIt) {
  const auto map = pos::testing::smallMap();
  const std::vector<std::pair<estimation::EstimatorConfig, std::string>> types{
      {estimation::DeadReckoningConfig{}, "dead_reckoning"},
      {estimation::RangeOdometryConfig{}, "range_odometry"},
      {estimation::MclConfig{}, "mcl"},
      {estimation::MrptMclConfig{}, "mrpt_mcl"},
      {estimation::DualUwbConfig{}, "dual_uwb"}};
  for (const auto& [config, name] : types) {
    EXPECT_EQ(estimation::typeName(config), name);
    EXPECT_NE(makeAnyEstimator(config, map), nullptr);
  }
}

TEST(Factory, WithoutTheYardstickMrptMclIsAFaultOfTheCaller) {
  EXPECT_THROW((void)estimation::makeEstimator(estimation::MrptMclConfig{}, pos::testing::smallMap()),
               ContractError);
}

TEST(Factory, AMapThatLacksWhatTheTypeNeedsIsRefused) {
  const auto empty = std::make_shared<const map::TunnelMap>();
  EXPECT_THROW((void)makeAnyEstimator(estimation::RangeOdometryConfig{}, empty), ConfigError);
  EXPECT_THROW((void)makeAnyEstimator(estimation::MclConfig{}, empty), ConfigError);
  EXPECT_THROW((void)makeAnyEstimator(estimation::MrptMclConfig{}, empty), ConfigError);
  EXPECT_THROW((void)makeAnyEstimator(estimation::DualUwbConfig{}, empty), ConfigError);
}

}  // namespace pos::yardstick
