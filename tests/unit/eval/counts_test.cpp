#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pos/core/random.hpp"
#include "pos/eval/compute_stats.hpp"
#include "pos/eval/decimation.hpp"
#include "pos/eval/residuals.hpp"
#include "pos/eval/verdict_counts.hpp"

namespace pos::eval {

namespace {

IngestReport report(Verdict verdict, double innovation) {
  return {.verdict = verdict,
          .dof = 1,
          .nis = innovation * innovation,
          .innovation = innovation,
          .innovation_sigma = 1.0,
          .reason = verdict == Verdict::Gated ? "beyond the gate" : ""};
}

}  // namespace

TEST(VerdictCounts, CountsPerSensorAndPerAnchor) {
  VerdictCounts counts;
  counts.add("uwb", 7, report(Verdict::Applied, 1.0));
  counts.add("uwb", 7, report(Verdict::Gated, 9.0));
  counts.add("uwb", 8, report(Verdict::Applied, 2.0));
  counts.add("odometry", std::nullopt, {.verdict = Verdict::NotInitialised});
  EXPECT_EQ(counts.sensors().at("uwb").count(Verdict::Applied), 2U);
  EXPECT_EQ(counts.sensors().at("uwb").count(Verdict::Gated), 1U);
  EXPECT_EQ(counts.sensors().at("odometry").count(Verdict::NotInitialised), 1U);
  EXPECT_EQ(counts.anchors().at(7).total(), 2U);
  EXPECT_EQ(counts.anchors().at(8).total(), 1U);
  EXPECT_EQ(counts.anchors().size(), 2U);
  EXPECT_EQ(counts.total().total(), 4U);
  EXPECT_NEAR(counts.total().gatedFraction(), 1.0 / 3.0, 1e-12);
  EXPECT_EQ(counts.total().reasons.at("beyond the gate"), 1U);
}

TEST(VerdictCounts, NisIsTheMeanOverAppliedReadingsOnly) {
  VerdictCounts counts;
  counts.add("uwb", 7, report(Verdict::Applied, 1.0));
  counts.add("uwb", 7, report(Verdict::Applied, 2.0));
  counts.add("uwb", 7, report(Verdict::Gated, 100.0));
  counts.add("uwb", 7, {.verdict = Verdict::Applied});  // no innovation
  EXPECT_DOUBLE_EQ(*counts.sensors().at("uwb").nisMean(), 2.5);
  EXPECT_DOUBLE_EQ(counts.sensors().at("uwb").nisDof(), 1.0);
  EXPECT_FALSE(Tally{}.nisMean());
  EXPECT_EQ(Tally{}.gatedFraction(), 0.0);
}

TEST(Residuals, FiguresAgreeWithClosedForms) {
  ResidualCollector collector;
  const std::vector<double> applied{0.1, 0.2, 0.3, 0.4, 0.5};
  for (std::size_t i = 0; i < applied.size(); ++i) {
    collector.add(3, stampFromSeconds(static_cast<double>(i)), report(Verdict::Applied, applied[i]));
  }
  collector.add(3, stampFromSeconds(9.0), report(Verdict::Gated, 10.0));
  const auto all = collector.summary();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].anchor, 3);
  EXPECT_EQ(all[0].applied.count, 5U);
  EXPECT_EQ(all[0].all.count, 6U);
  EXPECT_NEAR(all[0].applied.mean, 0.3, 1e-12);
  EXPECT_NEAR(all[0].applied.std, std::sqrt(0.02), 1e-12);
  EXPECT_NEAR(all[0].applied.median, 0.3, 1e-12);
  EXPECT_NEAR(all[0].applied.mad_sigma, 1.4826022185 * 0.1, 1e-9);
  EXPECT_NEAR(all[0].all.mean, 11.5 / 6.0, 1e-12);
  EXPECT_NEAR(all[0].all.median, 0.35, 1e-12);
}

TEST(Residuals, MadSigmaOfNormalResidualsIsTheirSigma) {
  ResidualCollector collector(4000);
  RandomStream noise(5, 1);
  for (int i = 0; i < 100'000; ++i) {
    collector.add(1, stampFromSeconds(i), report(Verdict::Applied, noise.normal(0.2, 0.5)));
  }
  const ResidualFigures f = collector.summary().at(0).all;
  EXPECT_EQ(f.count, 100'000U);
  EXPECT_NEAR(f.mean, 0.2, 0.01);
  EXPECT_NEAR(f.std, 0.5, 0.01);
  EXPECT_NEAR(f.median, 0.2, 0.05);
  EXPECT_NEAR(f.mad_sigma, 0.5, 0.05);
}

TEST(Residuals, KeepsBoundedEvenlySpacedSamplesAndTheSameOnesAgain) {
  const auto collected = [] {
    ResidualCollector collector(64);
    for (int i = 0; i < 10'000; ++i) collector.add(1, stampFromSeconds(i), report(Verdict::Applied, i));
    return collector.summary().at(0).samples;
  };
  const auto samples = collected();
  EXPECT_LE(samples.size(), 64U);
  EXPECT_GE(samples.size(), 31U);
  const double stride = samples[1].residual - samples[0].residual;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].residual, stride * static_cast<double>(i));
    EXPECT_EQ(samples[i].residual, collected()[i].residual);
  }
}

TEST(Residuals, ReportsWithoutAScalarInnovationChangeNothing) {
  ResidualCollector collector;
  collector.add(1, stampFromSeconds(0.0), {.verdict = Verdict::Unsupported});
  EXPECT_TRUE(collector.summary().empty());
}

TEST(ComputeStats, PercentilesAreGoodToABin) {
  ComputeStats stats;
  for (int i = 1; i <= 1000; ++i) stats.add(Duration{1000 * i});
  EXPECT_NEAR(stats.microseconds(0.50) / 500.0, 1.0, 0.05);
  EXPECT_NEAR(stats.microseconds(0.99) / 990.0, 1.0, 0.05);
  EXPECT_DOUBLE_EQ(stats.microseconds(1.0), 1000.0);
  EXPECT_EQ(stats.count(), 1000U);
  EXPECT_EQ(stats.total(), Duration{500'500'000});
  EXPECT_NEAR(stats.realTimeFactor(durationFromSeconds(5.005)), 10.0, 1e-9);
}

TEST(ComputeStats, ExtremesAndNothingStayFinite) {
  ComputeStats stats;
  EXPECT_EQ(stats.microseconds(0.5), 0.0);
  EXPECT_EQ(stats.realTimeFactor(durationFromSeconds(1.0)), 0.0);
  stats.add(Duration{0});
  EXPECT_EQ(stats.microseconds(0.5), 0.0);
  stats.add(durationFromSeconds(1e5));
  EXPECT_TRUE(std::isfinite(stats.microseconds(0.99)));
}

TEST(Decimation, KeepsExtremesFirstAndLast) {
  std::vector<double> values;
  RandomStream noise(1, 2);
  for (int i = 0; i < 50'000; ++i) values.push_back(noise.normal());
  values[12'345] = 99.0;
  values[45'678] = -77.0;
  const auto kept = minMaxIndices(values, 400);
  EXPECT_LE(kept.size(), 400U);
  EXPECT_GT(kept.size(), 300U);
  EXPECT_EQ(kept.front(), 0U);
  EXPECT_EQ(kept.back(), 49'999U);
  EXPECT_NE(std::find(kept.begin(), kept.end(), 12'345U), kept.end());
  EXPECT_NE(std::find(kept.begin(), kept.end(), 45'678U), kept.end());
  for (std::size_t i = 1; i < kept.size(); ++i) EXPECT_LT(kept[i - 1], kept[i]);
}

TEST(Decimation, ShortSeriesStaysWhole) {
  EXPECT_EQ(minMaxIndices({3.0, 1.0, 2.0}, 0).size(), 3U);
  EXPECT_TRUE(minMaxIndices({}, 10).empty());
  EXPECT_LE(minMaxIndices(std::vector<double>(100, 1.0), 1).size(), 4U);
}

}  // namespace pos::eval
