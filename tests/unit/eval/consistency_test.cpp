#include "pos/eval/consistency.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pos/core/random.hpp"

namespace pos::eval {

namespace {

/// NEES of errors that are really `ratio` times as large as claimed; each error keeps `keep` of the last.
std::vector<double> neesOf(double ratio, double keep, int count, std::uint64_t stream) {
  RandomStream noise(11, stream);
  std::vector<double> all;
  double x = noise.normal();
  double y = noise.normal();
  for (int i = 0; i < count; ++i) {
    all.push_back(ratio * ratio * (x * x + y * y));
    x = keep * x + std::sqrt(1.0 - keep * keep) * noise.normal();
    y = keep * y + std::sqrt(1.0 - keep * keep) * noise.normal();
  }
  return all;
}

}  // namespace

TEST(Nees, HonestGaussianErrorsLieInsideTheBounds) {
  // 95 % bounds over 200 streams: 190 expected, binomial sigma 3.1; +-4 sigma.
  int inside = 0;
  for (std::uint64_t stream = 0; stream < 200; ++stream) {
    inside += neesSummary(neesOf(1.0, 0.0, 1000, stream), 2).honesty() == Honesty::Consistent ? 1 : 0;
  }
  EXPECT_GE(inside, 177);
}

TEST(Nees, CorrelatedHonestErrorsAreNotCalledDishonest) {
  // The naive bounds call most of these runs dishonest, the effective ones few. The estimate of the
  // correlation is itself uncertain, so that somewhat more than 5 % fall outside.
  int inside = 0;
  int inside_naive = 0;
  for (std::uint64_t stream = 0; stream < 200; ++stream) {
    const NeesSummary s = neesSummary(neesOf(1.0, 0.95, 3000, stream), 2);
    inside += s.honesty() == Honesty::Consistent ? 1 : 0;
    inside_naive += s.mean > s.naive_bounds.low && s.mean < s.naive_bounds.high ? 1 : 0;
  }
  EXPECT_GE(inside, 170);
  EXPECT_LT(inside_naive, 120);
}

TEST(Nees, SigmasTwiceTooSmallAreTooSureByTwo) {
  const NeesSummary s = neesSummary(neesOf(2.0, 0.9, 3000, 1), 2);
  EXPECT_EQ(s.honesty(), Honesty::TooSure);
  EXPECT_NEAR(s.sigmaFactor(), 2.0, 0.25);
}

TEST(Nees, AnExplainingTruthSigmaFillsTheClaimUpToTheErrors) {
  NeesSummary s;
  s.dof = 2;
  s.count = 100;
  s.mean = 50.0;  // errors of 0.5 m per axis against a claim of 0.1 m
  EXPECT_NEAR(s.explainingTruthSigma(std::sqrt(2.0) * 0.5), std::sqrt(0.25 - 0.01), 1e-12);
  s.mean = 1.5;
  EXPECT_EQ(s.explainingTruthSigma(0.5), 0.0);
}

TEST(Nees, SigmasTwiceTooLargeAreTooCautious) {
  const NeesSummary s = neesSummary(neesOf(0.5, 0.9, 3000, 1), 2);
  EXPECT_EQ(s.honesty(), Honesty::TooCautious);
  EXPECT_NEAR(s.sigmaFactor(), 0.5, 0.1);
}

TEST(Nees, BoundsAreThoseOfTheChiSquareDistribution) {
  const NeesSummary s = neesSummary({1.0, 3.0}, 2);
  EXPECT_DOUBLE_EQ(s.mean, 2.0);
  EXPECT_NEAR(s.naive_bounds.low, 0.48442 / 2.0, 1e-4);  // chi2(4) at 2.5 and 97.5 %
  EXPECT_NEAR(s.naive_bounds.high, 11.14329 / 2.0, 1e-4);
}

TEST(Nees, EmptySeriesIsUnknown) {
  const NeesSummary s = neesSummary({}, 2);
  EXPECT_EQ(s.honesty(), Honesty::Unknown);
  EXPECT_EQ(s.sigmaFactor(), 1.0);
  EXPECT_EQ(s.bounds.high, 0.0);
}

TEST(EffectiveSampleSize, IndependentValuesCountFully) {
  const double n = effectiveSampleSize(neesOf(1.0, 0.0, 1500, 5));
  EXPECT_GT(n, 1000.0);
  EXPECT_LE(n, 1500.0);
}

TEST(EffectiveSampleSize, MatchesTheClosedFormOfASquaredMarkovProcess) {
  // The square of a process with autocorrelation a^k has a^(2k): n (1 - a^2) / (1 + a^2).
  const double a = 0.9;
  const double expected = 20000.0 * (1.0 - a * a) / (1.0 + a * a);
  double mean = 0.0;
  for (std::uint64_t stream = 0; stream < 20; ++stream) {
    mean += effectiveSampleSize(neesOf(1.0, a, 20000, stream)) / 20.0;
  }
  EXPECT_NEAR(mean / expected, 1.0, 0.15);
}

TEST(EffectiveSampleSize, ConstantOrSingleValuesCountOnce) {
  EXPECT_EQ(effectiveSampleSize(std::vector<double>(100, 2.0)), 1.0);
  EXPECT_EQ(effectiveSampleSize({2.0}), 1.0);
  EXPECT_EQ(effectiveSampleSize({}), 0.0);
}

TEST(Inside3Sigma, CountsOnlySamplesWithASigma) {
  ErrorSeries series(4);
  series[0].x = {0.29, 0.1};
  series[1].x = {-0.31, 0.1};
  series[2].x = {0.0, 0.1};
  series[3].x = {5.0, 0.0};
  EXPECT_NEAR(*fractionInside3Sigma(series, Component::X), 2.0 / 3.0, 1e-12);
  EXPECT_FALSE(fractionInside3Sigma(series, Component::Yaw));
  EXPECT_EQ(consistency(series).without_covariance, 4U);
}

}  // namespace pos::eval
