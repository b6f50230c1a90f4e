#include "pos/filters/resampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pos::filters {
namespace {

std::vector<float> logs(const std::vector<double>& weights) {
  std::vector<float> lw;
  for (const double w : weights) lw.push_back(static_cast<float>(std::log(w)));
  return lw;
}

std::vector<int> counts(std::span<const std::uint32_t> ancestors, std::size_t parents) {
  std::vector<int> n(parents, 0);
  for (const std::uint32_t a : ancestors) ++n[a];
  return n;
}

}  // namespace

TEST(EffectiveSize, IsTheCountForEqualWeights) {
  EXPECT_NEAR(effectiveSize(std::vector<float>(250, -3.0F)), 250.0, 1e-3);
}

TEST(EffectiveSize, IsOneWhenOneParticleHasItAll) {
  EXPECT_NEAR(effectiveSize(std::vector<float>{0.0F, -80.0F, -80.0F}), 1.0, 1e-6);
}

TEST(EffectiveSize, HasItsClosedFormForTwoLevels) {
  // weights 3 and 1: (3 + 1)^2 / (9 + 1) = 1.6, normalised or not
  EXPECT_NEAR(effectiveSize(logs({3.0, 1.0})), 1.6, 1e-6);
  EXPECT_NEAR(effectiveSize(logs({0.75, 0.25})), 1.6, 1e-6);
}

TEST(EffectiveSizePolicy, ResamplesBelowItsShareOnly) {
  const std::vector<float> lw = logs({3.0, 1.0});  // 80 % effective
  EXPECT_FALSE(EffectiveSizePolicy{0.79}.wantsResampling(lw));
  EXPECT_TRUE(EffectiveSizePolicy{0.81}.wantsResampling(lw));
}

TEST(SystematicResampling, GivesEveryParentFloorOrCeilingOfItsShare) {
  const std::vector<double> w{0.013, 0.2, 0.0005, 0.4, 0.3865};
  SystematicResampler resampler;
  for (double offset = 0.001; offset < 1.0; offset += 0.0173) {
    const std::vector<int> n = counts(resampler.ancestors(logs(w), 100, offset), w.size());
    EXPECT_EQ(std::accumulate(n.begin(), n.end(), 0), 100);
    for (std::size_t i = 0; i < w.size(); ++i) {
      EXPECT_GE(n[i], static_cast<int>(std::floor(100.0 * w[i] - 1e-4))) << i << " at " << offset;
      EXPECT_LE(n[i], static_cast<int>(std::ceil(100.0 * w[i] + 1e-4))) << i << " at " << offset;
    }
  }
}

TEST(SystematicResampling, IsUnbiased) {
  const std::vector<double> w{0.05, 0.31, 0.111, 0.029, 0.5};
  constexpr int kRuns = 20000;
  constexpr std::size_t kChildren = 7;
  RandomStream random(99, 3);
  SystematicResampler resampler;
  std::vector<double> mean(w.size(), 0.0);
  for (int run = 0; run < kRuns; ++run) {
    const std::vector<int> n = counts(resampler.ancestors(logs(w), kChildren, random.uniform()), w.size());
    for (std::size_t i = 0; i < w.size(); ++i) mean[i] += static_cast<double>(n[i]) / kRuns;
  }
  for (std::size_t i = 0; i < w.size(); ++i) {
    const double expected = kChildren * w[i];
    const double part = expected - std::floor(expected);  // the count is a Bernoulli of this beyond the floor
    EXPECT_NEAR(mean[i], expected, 4.0 * std::sqrt(part * (1.0 - part) / kRuns) + 1e-6) << i;
  }
}

TEST(SystematicResampling, WeightsNeedNotBeNormalised) {
  SystematicResampler resampler;
  const auto plain = counts(resampler.ancestors(logs({0.2, 0.8}), 1000, 0.3), 2);
  const auto scaled = counts(resampler.ancestors(logs({0.2e-30, 0.8e-30}), 1000, 0.3), 2);
  EXPECT_EQ(plain, scaled);
  EXPECT_EQ(plain[0], 200);
}

TEST(SystematicResampling, ChildrenKeepTheWeightedMeanAndAreLevel) {
  RandomStream random(4, 4);
  ParticleSet set;
  set.resize(5000);
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double x = random.normal();
    set.place(i, {x, 2.0 * x, 0.1 * random.normal()});
    set.log_weight[i] = static_cast<float>(0.5 * x);  // tilts the mean by 0.5
  }
  const Moments before = moments(set);
  SystematicResampler().resample(set, 3000, random);
  const Moments after = moments(set);
  EXPECT_EQ(set.size(), 3000U);
  EXPECT_NEAR(effectiveSize(set.log_weight), 3000.0, 0.1);
  EXPECT_NEAR(normalise(set.log_weight), 0.0, 1e-5);
  EXPECT_NEAR(after.mean.x, before.mean.x, 4.0 / std::sqrt(3000.0));
  EXPECT_NEAR(before.mean.x, 0.5, 0.1);
  EXPECT_NEAR(after.covariance(0, 1) / before.covariance(0, 1), 1.0, 0.1);
}

TEST(SystematicResampling, SameStreamPositionGivesTheSameChildren) {
  ParticleSet a;
  a.resize(100);
  for (std::size_t i = 0; i < 100; ++i) {
    a.place(i, {static_cast<double>(i), 0.0, 0.0});
    a.log_weight[i] = -0.01F * static_cast<float>(i);
  }
  ParticleSet b = a;
  RandomStream one(1, 1);
  RandomStream two(1, 1);
  SystematicResampler().resample(a, 100, one);
  SystematicResampler().resample(b, 100, two);
  EXPECT_EQ(a.x, b.x);
}

}  // namespace pos::filters
