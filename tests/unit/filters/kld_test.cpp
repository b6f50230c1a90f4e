#include "pos/filters/kld.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "pos/core/chi_square.hpp"
#include "pos/filters/recovery.hpp"

namespace pos::filters {

TEST(Kld, AgreesWithTheChiSquareQuantileItApproximates) {
  // Fox 2003, eq. 6: n = chi2(k - 1 degrees, 1 - delta) / (2 epsilon); z = 2.3263 is 1 - delta = 0.99
  for (const std::size_t bins : {5U, 20U, 100U, 2000U}) {
    const double exact = chiSquareQuantile(0.99, static_cast<double>(bins - 1)) / (2.0 * 0.02);
    EXPECT_NEAR(kldSampleSize(bins, 0.02, 2.3263478740) / exact, 1.0, 0.005) << bins;
  }
}

TEST(Kld, NeedsOneParticleForOneBin) {
  EXPECT_EQ(kldSampleSize(0, 0.02, 2.33), 1.0);
  EXPECT_EQ(kldSampleSize(1, 0.02, 2.33), 1.0);
}

TEST(Kld, SmallestSufficientNumberOfBinsIsFound) {
  for (const double samples : {500.0, 20000.0, 1e6}) {
    const std::size_t bins = kldBins(samples, 0.02, 2.33);
    EXPECT_GE(kldSampleSize(bins, 0.02, 2.33), samples);
    EXPECT_LT(kldSampleSize(bins - 1, 0.02, 2.33), samples);
  }
}

class Bins : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::vector<Pose2> poses{{0.1, 0.1, 0.05},  {0.4, 0.2, 0.09},  // one bin
                                   {-0.1, 0.1, 0.05},                    // the next one across zero
                                   {0.1, 0.6, 0.05},  {0.1, 0.1, 0.15},  // another y, another yaw
                                   {7.0, 7.0, -3.0}};
    set.resize(poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) set.place(i, poses[i]);
    levelWeights(set);
  }
  ParticleSet set;
};

TEST_F(Bins, OccupiedOnesCountOnce) {
  EXPECT_EQ(BinCounter(0.5, 0.1, 100).survivors(set), 5U);
}

TEST_F(Bins, ThoseOfParticlesWithoutChildrenDoNotCount) {
  set.weight = {1.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F};
  EXPECT_EQ(BinCounter(0.5, 0.1, 100).survivors(set), 2U);
}

TEST_F(Bins, CountingStopsAtTheLimitAndStartsAfresh) {
  BinCounter bins(0.5, 0.1, 3);
  EXPECT_EQ(bins.survivors(set), 3U);
  EXPECT_EQ(bins.survivors(set), 3U);
}

TEST(LikelihoodAverages, StepDownInLikelihoodAsksForNewParticles) {
  LikelihoodAverages averages(0.001, 0.1);
  EXPECT_EQ(averages.injectionShare(), 0.0);
  for (int i = 0; i < 50; ++i) averages.add(2.0);
  EXPECT_NEAR(averages.injectionShare(), 0.0, 1e-12);
  for (int i = 0; i < 10; ++i) averages.add(0.2);
  // fast = 0.2 + 1.8 * 0.9^10, slow = 0.2 + 1.8 * 0.999^10
  EXPECT_NEAR(averages.injectionShare(), 1.0 - 0.827622 / 1.982081, 1e-5);
}

TEST(LikelihoodAverages, BetterReadingsAskForNothingAndRateZeroSwitchesOff) {
  LikelihoodAverages averages(0.001, 0.1);
  averages.add(1.0);
  averages.add(3.0);
  EXPECT_EQ(averages.injectionShare(), 0.0);
  LikelihoodAverages off(0.0, 0.1);
  off.add(1.0);
  off.add(1e-9);
  EXPECT_EQ(off.injectionShare(), 0.0);
}

}  // namespace pos::filters
