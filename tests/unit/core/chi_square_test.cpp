#include "pos/core/chi_square.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pos {

// Pearson and Hartley, Biometrika Tables, table 8; more digits from NIST/SEMATECH e-Handbook, 1.3.6.7.4.
TEST(ChiSquare, QuantilesAgreeWithThePublishedTable) {
  EXPECT_NEAR(chiSquareQuantile(0.95, 1.0), 3.841, 5e-4);
  EXPECT_NEAR(chiSquareQuantile(0.99, 1.0), 6.635, 5e-4);
  EXPECT_NEAR(chiSquareQuantile(0.95, 2.0), 5.991, 5e-4);
  EXPECT_NEAR(chiSquareQuantile(0.95, 3.0), 7.815, 5e-4);
  EXPECT_NEAR(chiSquareQuantile(0.999, 6.0), 22.458, 5e-4);
  EXPECT_NEAR(chiSquareQuantile(0.025, 10.0), 3.247, 5e-4);
  EXPECT_NEAR(chiSquareQuantile(0.975, 10.0), 20.483, 5e-4);
  EXPECT_NEAR(chiSquareQuantile(0.95, 100.0), 124.342, 5e-4);
}

TEST(ChiSquare, TwoDegreesOfFreedomHaveAClosedForm) {
  for (const double p : {1e-6, 0.01, 0.5, 0.997, 1.0 - 1e-9}) {
    EXPECT_NEAR(chiSquareQuantile(p, 2.0), -2.0 * std::log1p(-p), 1e-9);
  }
  for (const double x : {0.001, 1.0, 20.0})
    EXPECT_NEAR(chiSquareProbability(x, 2.0), -std::expm1(-0.5 * x), 1e-14);
}

TEST(ChiSquare, QuantileInvertsProbabilityAlsoForBrokenDegrees) {
  for (const double dof : {0.5, 1.0, 2.7, 6.0, 300.0}) {
    for (const double p : {0.001, 0.3, 0.95, 0.999}) {
      EXPECT_NEAR(chiSquareProbability(chiSquareQuantile(p, dof), dof), p, 1e-10) << dof << ' ' << p;
    }
  }
}

TEST(ChiSquare, ProbabilityOfNothingOrLessIsZero) {
  EXPECT_EQ(chiSquareProbability(0.0, 3.0), 0.0);
  EXPECT_EQ(chiSquareProbability(-1.0, 3.0), 0.0);
}

// Fifty runs of one degree of freedom at 95 %: the table's 32.36 and 71.42 for 50 degrees, divided by 50.
TEST(ChiSquare, MeanBoundsAreTheQuantilesOfTheSum) {
  const Interval bounds = meanChiSquareBounds(0.95, 1.0, 50.0);
  EXPECT_NEAR(bounds.low, 32.357 / 50.0, 1e-5);
  EXPECT_NEAR(bounds.high, 71.420 / 50.0, 1e-5);
}

TEST(ChiSquare, MeanBoundsCloseInOnTheDegreesOfFreedom) {
  const Interval few = meanChiSquareBounds(0.99, 3.0, 10.0);
  const Interval many = meanChiSquareBounds(0.99, 3.0, 10'000.0);
  EXPECT_LT(few.low, many.low);
  EXPECT_GT(few.high, many.high);
  EXPECT_LT(many.low, 3.0);
  EXPECT_GT(many.high, 3.0);
  EXPECT_NEAR(many.high - many.low, 2.0 * 2.576 * std::sqrt(6.0 / 10'000.0), 1e-3);
}

}  // namespace pos
