#include "pos/eval/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pos/core/error.hpp"

namespace pos::eval {

TEST(Statistics, AgreesWithClosedFormsForSignedErrors) {
  const Statistics s = statistics({-3.0, 1.0, 2.0, 4.0});
  EXPECT_EQ(s.count, 4U);
  EXPECT_DOUBLE_EQ(s.mean, 1.0);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(30.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(26.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.median, 2.5);  // of 1 2 3 4
  EXPECT_DOUBLE_EQ(s.p50, 2.5);
  EXPECT_DOUBLE_EQ(s.min, 1.0);
  EXPECT_DOUBLE_EQ(s.max, 4.0);
  EXPECT_DOUBLE_EQ(s.p90, 1.0 + 0.9 * 3.0);
}

TEST(Statistics, PercentilesOfZeroToHundredAreThemselves) {
  std::vector<double> values;
  for (int i = 100; i >= 0; --i) values.push_back(i % 2 == 0 ? i : -i);
  const Statistics s = statistics(values);
  EXPECT_DOUBLE_EQ(s.p50, 50.0);
  EXPECT_DOUBLE_EQ(s.p68, 68.0);
  EXPECT_DOUBLE_EQ(s.p90, 90.0);
  EXPECT_DOUBLE_EQ(s.p95, 95.0);
  EXPECT_DOUBLE_EQ(s.p99, 99.0);
}

TEST(Statistics, RmseIsMeanAndStandardDeviationTogether) {
  const Statistics s = statistics({0.3, -0.7, 1.9, 0.2, 5.5});
  EXPECT_NEAR(s.rmse * s.rmse, s.mean * s.mean + s.std * s.std, 1e-12);
}

TEST(Statistics, OneSampleIsEveryPercentile) {
  const Statistics s = statistics({-0.5});
  EXPECT_EQ(s.count, 1U);
  EXPECT_EQ(s.mean, -0.5);
  EXPECT_EQ(s.std, 0.0);
  for (const double v : {s.rmse, s.median, s.min, s.max, s.p50, s.p68, s.p90, s.p95, s.p99})
    EXPECT_EQ(v, 0.5);
}

TEST(Statistics, EmptyListCountsZeroAndHoldsNoNaN) {
  const Statistics s = statistics({});
  EXPECT_EQ(s.count, 0U);
  EXPECT_EQ(s.rmse, 0.0);
  EXPECT_TRUE(cumulativeDistribution({}, 10).empty());
  EXPECT_EQ(fractionUnder({}, 1.0), 0.0);
  EXPECT_THROW(sortedQuantile({}, 0.5), ContractError);
}

TEST(Statistics, FractionUnderCountsMagnitudesStrictly) {
  EXPECT_DOUBLE_EQ(fractionUnder({0.1, -0.2, 0.3, -4.0}, 0.3), 0.5);
}

TEST(Statistics, DistributionRisesFromSmallestToLargest) {
  std::vector<double> values;
  for (int i = 0; i <= 1000; ++i) values.push_back(0.001 * i);
  const std::vector<CdfPoint> cdf = cumulativeDistribution(values, 11);
  ASSERT_EQ(cdf.size(), 11U);
  for (const CdfPoint& p : cdf) EXPECT_NEAR(p.value, p.fraction, 1e-12);
  const std::vector<CdfPoint> few = cumulativeDistribution({3.0, -1.0}, 11);
  ASSERT_EQ(few.size(), 2U);
  EXPECT_EQ(few[0].value, 1.0);
  EXPECT_EQ(few[0].fraction, 0.5);
  EXPECT_EQ(few[1].fraction, 1.0);
}

}  // namespace pos::eval
