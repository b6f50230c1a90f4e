#include "pos/eval/bootstrap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "pos/core/random.hpp"

namespace pos::eval {
namespace {

double meanOf(const std::vector<double>& values, const std::vector<std::size_t>& drawn) {
  double sum = 0.0;
  for (const std::size_t i : drawn) sum += values[i];
  return sum / static_cast<double>(drawn.size());
}

Interval meanInterval(const std::vector<double>& values, const BootstrapOptions& options = {}) {
  return bootstrapInterval(
      values.size(), [&](const std::vector<std::size_t>& drawn) { return meanOf(values, drawn); }, options);
}

std::vector<double> normals(std::size_t count, std::uint64_t stream) {
  RandomStream random(77, stream);
  std::vector<double> values(count);
  for (double& v : values) v = random.normal(3.0, 2.0);
  return values;
}

TEST(Bootstrap, TheSameRunsGiveTheSameBits) {
  const std::vector<double> values = normals(25, 1);
  EXPECT_EQ(meanInterval(values).low, meanInterval(values).low);
  EXPECT_EQ(meanInterval(values).high, meanInterval(values).high);
  EXPECT_NE(meanInterval(values).low, meanInterval(values, {.seed = 1}).low);
}

TEST(Bootstrap, EveryRunIsDrawnEquallyOften) {
  std::vector<double> counts(10, 0.0);
  (void)bootstrapInterval(10, [&](const std::vector<std::size_t>& drawn) {
    EXPECT_EQ(drawn.size(), 10U);
    for (const std::size_t i : drawn) counts.at(i) += 1.0;
    return 0.0;
  });
  // 20 000 draws, each run 2000 times with sigma sqrt(20000 * 0.1 * 0.9) = 42.4
  for (const double count : counts) EXPECT_NEAR(count, 2000.0, 4.0 * 42.5);
}

TEST(Bootstrap, WidthIsThatOfTheMeanOfManyValues) {
  const std::vector<double> values = normals(400, 2);
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / 400.0;
  double squares = 0.0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  const double half = 1.96 * std::sqrt(squares / 400.0 / 400.0);
  const Interval interval = meanInterval(values);
  // the 2.5 % point of 2000 resamples scatters by sqrt(p (1 - p) / 2000) / density = 0.06 sigma = 3 % of half
  EXPECT_NEAR(interval.low, mean - half, 0.12 * half);
  EXPECT_NEAR(interval.high, mean + half, 0.12 * half);
}

TEST(Bootstrap, TheIntervalHoldsTheTruthAboutAsOftenAsItSays) {
  // For normal values the percentile interval is mean +- 1.96 s sqrt((n-1)/n) / sqrt(n): with n = 40 it holds
  // the mean with probability P(|t_39| < 1.935) = 0.940. Of 1000 trials 940 +- 3.3 * 7.5, and a little for
  // the 500 resamples.
  int held = 0;
  for (std::uint64_t trial = 0; trial < 1000; ++trial) {
    const Interval interval = meanInterval(normals(40, 100 + trial), {.resamples = 500, .seed = trial});
    held += interval.low <= 3.0 && 3.0 <= interval.high ? 1 : 0;
  }
  EXPECT_GE(held, 911);
  EXPECT_LE(held, 967);
}

}  // namespace
}  // namespace pos::eval
