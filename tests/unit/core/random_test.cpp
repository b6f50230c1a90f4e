#include "pos/core/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "pos/core/chi_square.hpp"

namespace pos {
namespace {

using Block = std::array<std::uint32_t, 4>;

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};
template <class Draw>
Moments moments(int n, Draw draw) {
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < n; ++i) {
    const double value = draw();
    sum += value;
    squares += value * value;
  }
  const double mean = sum / n;
  return {mean, squares / n - mean * mean};
}

double correlation(RandomStream a, RandomStream b, int n) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += a.normal() * b.normal();
  return sum / n;
}

constexpr int kDraws = 100'000;
/// Two-sided 99.99 % band of a mean of kDraws values of standard deviation 1.
const double kBand = 3.89 / std::sqrt(kDraws);

}  // namespace

// Known answers of the Random123 distribution, kat_vectors, philox4x32 with 10 rounds.
TEST(Philox, GivesTheKnownAnswers) {
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, StartsWithTheBlocksOfItsSeedAndStream) {
  RandomStream random(0x0000000200000001ULL, 0x0000000400000003ULL);
  for (std::uint32_t block = 0; block < 3; ++block) {
    for (const std::uint32_t word : philox4x32({block, 0, 3, 4}, {1, 2})) EXPECT_EQ(random.bits(), word);
  }
}

TEST(RandomStream, SameSeedAndStreamGiveTheSameSequence) {
  RandomStream a(7, 1);
  RandomStream b(7, 1);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(a.normal(), b.normal());
}

TEST(RandomStream, CopyGoesOnFromTheSamePlace) {
  RandomStream a(7, 1);
  a.normal();  // keeps a spare value
  a.bits();
  RandomStream b = a;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.normal(), b.normal());
}

TEST(RandomStream, UniformStaysInsideAndFillsItsIntervalEvenly) {
  RandomStream random(11, 0);
  constexpr int kBins = 64;
  std::vector<int> bins(kBins, 0);
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform();
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    ++bins[static_cast<std::size_t>(u * kBins)];
  }
  const double expected = static_cast<double>(kDraws) / kBins;
  const double statistic = std::accumulate(bins.begin(), bins.end(), 0.0, [&](double sum, int count) {
    return sum + (count - expected) * (count - expected) / expected;
  });
  EXPECT_GT(statistic, chiSquareQuantile(0.0005, kBins - 1));
  EXPECT_LT(statistic, chiSquareQuantile(0.9995, kBins - 1));
}

TEST(RandomStream, UniformBetweenBoundsHasTheirMeanAndSpread) {
  RandomStream random(12, 0);
  const Moments m = moments(kDraws, [&] { return random.uniform(-2.0, 6.0); });
  const double sigma = 8.0 / std::sqrt(12.0);
  EXPECT_NEAR(m.mean, 2.0, kBand * sigma);
  EXPECT_NEAR(m.variance / (sigma * sigma), 1.0, kBand * std::sqrt(0.8));  // kurtosis 1.8
}

TEST(RandomStream, NormalHasItsMeanSpreadAndTails) {
  RandomStream random(13, 0);
  const Moments m = moments(kDraws, [&] { return random.normal(5.0, 2.0); });
  EXPECT_NEAR(m.mean, 5.0, 2.0 * kBand);
  EXPECT_NEAR(m.variance / 4.0, 1.0, kBand * std::sqrt(2.0));
  RandomStream again(13, 0);
  const Moments fourth = moments(kDraws, [&] { return std::pow(again.normal(), 4); });
  EXPECT_NEAR(fourth.mean, 3.0, kBand * std::sqrt(96.0));
  RandomStream tail(14, 0);
  const double p = 0.0455002639;  // P(|x| > 2)
  const Moments beyond = moments(kDraws, [&] { return std::abs(tail.normal()) > 2.0 ? 1.0 : 0.0; });
  EXPECT_NEAR(beyond.mean, p, kBand * std::sqrt(p * (1.0 - p)));
}

TEST(RandomStream, NeighbouringDrawsStreamsAndSeedsAreUncorrelated) {
  EXPECT_NEAR(correlation({1, 0}, {1, 1}, kDraws), 0.0, kBand);
  EXPECT_NEAR(correlation({1, 0}, {2, 0}, kDraws), 0.0, kBand);
  RandomStream ahead(1, 0);
  ahead.normal();
  EXPECT_NEAR(correlation({1, 0}, ahead, kDraws), 0.0, kBand);
}

TEST(RandomStream, HighWordsOfSeedAndStreamCount) {
  EXPECT_NE(RandomStream(1, 1).bits(), RandomStream(1 + (1ULL << 32U), 1).bits());
  EXPECT_NE(RandomStream(1, 1).bits(), RandomStream(1, 1 + (1ULL << 32U)).bits());
}

TEST(RandomStream, BernoulliComesAsOftenAsAsked) {
  RandomStream random(15, 0);
  const Moments m = moments(kDraws, [&] { return random.bernoulli(0.3) ? 1.0 : 0.0; });
  EXPECT_NEAR(m.mean, 0.3, kBand * std::sqrt(0.21));
  EXPECT_FALSE(RandomStream(1, 0).bernoulli(0.0));
  EXPECT_TRUE(RandomStream(1, 0).bernoulli(1.0));
}

TEST(RandomStream, DrivesStandardAlgorithms) {
  std::vector<int> order(100);
  std::iota(order.begin(), order.end(), 0);
  const std::vector<int> before = order;
  RandomStream random(16, 0);
  std::shuffle(order.begin(), order.end(), random);
  EXPECT_NE(order, before);
  std::sort(order.begin(), order.end());
  EXPECT_EQ(order, before);
  static_assert(RandomStream::min() == 0 && RandomStream::max() == 0xffffffffU);
}

}  // namespace pos
