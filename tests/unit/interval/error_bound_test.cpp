#include "pos/interval/error_bound.hpp"

#include <gtest/gtest.h>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"

namespace pos::interval {

TEST(ErrorBound, GivesTheFiguresOfTheSpecification) {
  const DriftModel drift{.reset_along = 0.0, .reset_across = 0.0, .scale = 0.005, .heading = radians(0.5)};
  EXPECT_NEAR(alongBound(drift, 5000.0), 25.0, 1e-9);
  EXPECT_NEAR(acrossBound(drift, 5000.0, 3.0), 43.6, 0.1);
  EXPECT_NEAR(alongBound(drift, 200.0), 1.0, 1e-9);
  EXPECT_NEAR(acrossBound(drift, 200.0, 3.0), 1.745, 0.001);
  const DriftModel bias{.reset_along = 0.0, .reset_across = 0.0, .heading = 0.0, .gyro_bias = radians(0.005)};
  EXPECT_NEAR(acrossBound(bias, 200.0, 3.0), 0.58, 0.005);
}

TEST(ErrorBound, ChoosesTheLargestMergeThatKeepsBothRules) {
  const DriftModel drift{.reset_along = 0.3, .reset_across = 0.2, .scale = 0.01, .heading = radians(0.1)};
  LegDesign leg{.spacings = std::vector<double>(12, 100.0), .width = 6.0, .speed = 3.0};
  // Across: 3 sqrt(0.04 + (0.001745 l)^2) <= 3 holds to 561 m; along: 3 sqrt(0.09 + (0.01 l)^2) <= 50 to 1666
  // m.
  EXPECT_EQ(largestMerge(drift, leg), 5);
  leg.width = 100.0;
  EXPECT_EQ(largestMerge(drift, leg), 12);
  leg.width = 1.0;
  EXPECT_FALSE(largestMerge(drift, leg));
}

TEST(ErrorBound, TheMapAloneNeverMeetsTheRuleAcross) {
  for (const double width : {3.0, 5.0, 8.0}) {
    const DriftModel drift{.reset_across = width / std::sqrt(12.0), .heading = 0.0};
    EXPECT_FALSE(largestMerge(drift, {.spacings = {1.0}, .width = width}));
  }
}

TEST(ErrorBound, RefusesNegativeDrifts) {
  EXPECT_THROW((void)validated(DriftModel{.scale = -0.1}), ConfigError);
}

}  // namespace pos::interval
