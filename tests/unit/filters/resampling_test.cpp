#include "pos/filters/resampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/particle_oracle.hpp"

namespace pos::filters {
namespace {

/// Particles with these weights, each at its number.
ParticleSet weighted(const std::vector<double>& weights) {
  ParticleSet set;
  set.resize(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    set.place(i, {static_cast<double>(i), -static_cast<double>(i), 0.0});
    set.weight[i] = static_cast<float>(weights[i]);
  }
  return set;
}

/// How many children each parent got.
std::vector<std::size_t> counts(const std::vector<double>& weights, std::size_t children, double offset) {
  ParticleSet set = weighted(weights);
  SystematicResampler().resample(set, children, offset);
  std::vector<std::size_t> n(weights.size(), 0);
  for (std::size_t k = 0; k < set.size(); ++k) {
    EXPECT_EQ(set.y[k], -set.x[k]);
    ++n[static_cast<std::size_t>(set.x[k])];
  }
  return n;
}

}  // namespace

TEST(EffectiveSize, IsTheCountForEqualWeights) {
  EXPECT_NEAR(effectiveSize(weighted(std::vector<double>(250, 0.05))), 250.0, 1e-3);
}

TEST(EffectiveSize, IsOneWhenOneParticleHasItAll) {
  EXPECT_NEAR(effectiveSize(weighted({1.0, 1e-30, 1e-30})), 1.0, 1e-6);
}

TEST(EffectiveSize, HasItsClosedFormForTwoLevels) {
  // weights 3 and 1: (3 + 1)^2 / (9 + 1) = 1.6, normalised or not
  EXPECT_NEAR(effectiveSize(weighted({3.0, 1.0})), 1.6, 1e-6);
  EXPECT_NEAR(effectiveSize(weighted({0.75, 0.25})), 1.6, 1e-6);
}

TEST(EffectiveSizePolicy, ResamplesBelowItsShareOnly) {
  const ParticleSet set = weighted({3.0, 1.0});  // 80 % effective
  EXPECT_FALSE(EffectiveSizePolicy{0.79}.wantsResampling(set));
  EXPECT_TRUE(EffectiveSizePolicy{0.81}.wantsResampling(set));
}

TEST(SystematicResampling, GivesEveryParentFloorOrCeilingOfItsShare) {
  const std::vector<double> w{0.013, 0.2, 0.0005, 0.4, 0.3865};
  for (double offset = 0.001; offset < 1.0; offset += 0.0173) {
    const std::vector<std::size_t> n = counts(w, 100, offset);
    EXPECT_EQ(std::accumulate(n.begin(), n.end(), std::size_t{0}), 100U);
    for (std::size_t i = 0; i < w.size(); ++i) {
      EXPECT_GE(static_cast<double>(n[i]), std::floor(100.0 * w[i] - 1e-4)) << i << " at " << offset;
      EXPECT_LE(static_cast<double>(n[i]), std::ceil(100.0 * w[i] + 1e-4)) << i << " at " << offset;
    }
  }
}

TEST(SystematicResampling, ChildrenAreThoseOfDoublePrecision) {
  RandomStream random(31, 1);
  for (const std::size_t parents : {1U, 3U, 1000U, 5000U}) {
    std::vector<double> w;
    for (std::size_t i = 0; i < parents; ++i)
      w.push_back(static_cast<float>(std::exp(2.0 * random.normal())));
    for (const std::size_t children : {1U, 2U, 7U, 999U, 6000U}) {
      const double offset = random.uniform();
      const std::vector<std::size_t> expected = oracle::childCounts(w, children, offset);
      const std::vector<std::size_t> n = counts(w, children, offset);
      std::size_t moved = 0;  // a tooth on a parent's border to within the rounding of the weights
      for (std::size_t i = 0; i < parents; ++i) moved += n[i] > expected[i] ? n[i] - expected[i] : 0;
      EXPECT_LE(moved, 1U) << parents << " to " << children;
    }
  }
}

TEST(SystematicResampling, ParentThatHasItAllGetsAllChildren) {
  EXPECT_EQ(counts({1e-30, 1.0, 1e-30}, 500, 0.999), (std::vector<std::size_t>{0, 500, 0}));
}

TEST(SystematicResampling, IsUnbiased) {
  const std::vector<double> w{0.05, 0.31, 0.111, 0.029, 0.5};
  constexpr int kRuns = 20000;
  constexpr std::size_t kChildren = 7;
  RandomStream random(99, 3);
  std::vector<double> mean(w.size(), 0.0);
  for (int run = 0; run < kRuns; ++run) {
    const std::vector<std::size_t> n = counts(w, kChildren, random.uniform());
    for (std::size_t i = 0; i < w.size(); ++i) mean[i] += static_cast<double>(n[i]) / kRuns;
  }
  for (std::size_t i = 0; i < w.size(); ++i) {
    const double expected = kChildren * w[i];
    const double part = expected - std::floor(expected);  // the count is a Bernoulli of this beyond the floor
    EXPECT_NEAR(mean[i], expected, 4.0 * std::sqrt(part * (1.0 - part) / kRuns) + 1e-6) << i;
  }
}

TEST(SystematicResampling, WeightsNeedNotBeNormalised) {
  const auto plain = counts({0.2, 0.8}, 1000, 0.3);
  const auto scaled = counts({0.2e-20, 0.8e-20}, 1000, 0.3);
  EXPECT_EQ(plain, scaled);
  EXPECT_EQ(plain[0], 200U);
}

TEST(SystematicResampling, ChildrenKeepTheWeightedMeanAndAreLevel) {
  RandomStream random(4, 4);
  ParticleSet set;
  set.resize(5000);
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double x = random.normal();
    set.place(i, {x, 2.0 * x, 0.1 * random.normal()});
    set.weight[i] = static_cast<float>(std::exp(0.5 * x));  // tilts the mean by 0.5
  }
  const Moments before = moments(set);
  SystematicResampler().resample(set, 3000, random);
  const Moments after = moments(set);
  EXPECT_EQ(set.size(), 3000U);
  EXPECT_NEAR(effectiveSize(set), 3000.0, 0.1);
  EXPECT_NEAR(normalise(set), 0.0, 1e-5);
  EXPECT_NEAR(after.mean.x, before.mean.x, 4.0 / std::sqrt(3000.0));
  EXPECT_NEAR(before.mean.x, 0.5, 0.1);
  EXPECT_NEAR(after.covariance(0, 1) / before.covariance(0, 1), 1.0, 0.1);
}

TEST(SystematicResampling, SameStreamPositionGivesTheSameChildren) {
  ParticleSet a;
  a.resize(100);
  for (std::size_t i = 0; i < 100; ++i) {
    a.place(i, {static_cast<double>(i), 0.0, 0.0});
    a.weight[i] = std::exp(-0.01F * static_cast<float>(i));
  }
  ParticleSet b = a;
  RandomStream one(1, 1);
  RandomStream two(1, 1);
  SystematicResampler().resample(a, 100, one);
  SystematicResampler().resample(b, 100, two);
  EXPECT_EQ(a.x, b.x);
}

}  // namespace pos::filters
