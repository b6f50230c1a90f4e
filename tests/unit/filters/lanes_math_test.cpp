#include "pos/core/lanes_math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "pos/core/angle.hpp"
#include "pos/core/random.hpp"

namespace pos::lanes {
namespace {

double first(Floats values) {
  return static_cast<double>(values[0]);
}

}  // namespace

TEST(LanesMath, PowerOfTwoAgreesWithDoublePrecision) {
  for (double t = -100.0; t < 126.0; t += 0.0137) {
    const auto x = static_cast<float>(t);
    EXPECT_NEAR(first(power2(all(x))) / std::exp2(static_cast<double>(x)), 1.0, 5e-7 + 6e-8 * std::abs(t))
        << t;
  }
  EXPECT_EQ(first(power2(all(0.0F))), 1.0);
}

TEST(LanesMath, PowerOfTwoStaysPositiveFarOut) {
  EXPECT_NEAR(first(power2(all(-1e30F))) / std::exp2(-100.0), 1.0, 1e-6);
}

TEST(LanesMath, LogarithmAgreesWithDoublePrecision) {
  for (double e = -37.0; e < 38.0; e += 0.00731) {
    const auto x = static_cast<float>(std::pow(10.0, e));
    const double expected = std::log2(static_cast<double>(x));
    EXPECT_NEAR(first(logarithm2(all(x))), expected, 4e-7 * (1.0 + std::abs(expected))) << x;
  }
  EXPECT_EQ(first(logarithm2(all(1.0F))), 0.0);
}

TEST(LanesMath, SineAndCosineAgreeInEveryQuarter) {
  for (double a = -100.0; a < 100.0; a += 0.00713) {
    const double angle = static_cast<float>(a);
    const SineCosine both = sineCosine(all(static_cast<float>(a)));
    EXPECT_NEAR(first(both.sine), std::sin(angle), 1e-6) << a;
    EXPECT_NEAR(first(both.cosine), std::cos(angle), 1e-6) << a;
  }
}

TEST(LanesMath, WrapKeepsTheDirection) {
  for (double a = -12.0; a < 12.0; a += 0.0313) {
    const double angle = static_cast<float>(a);
    const double in_turn = first(wrapped(all(static_cast<float>(a))));
    EXPECT_LE(std::abs(in_turn), kPi + 1e-6);
    EXPECT_NEAR(wrapAngle(in_turn - angle), 0.0, 3e-6) << a;
  }
}

TEST(LanesMath, DirectionsAreUnitVectorsSpreadOverAllEighths) {
  std::array<int, 8> eighth{};
  RandomStream random(5, 5);
  constexpr int kCount = 8000;
  for (int i = 0; i < kCount; ++i) {
    const SineCosine way = direction(allWords(random.bits()));
    EXPECT_NEAR(std::hypot(first(way.sine), first(way.cosine)), 1.0, 1e-6);
    const double turns = std::atan2(first(way.sine), first(way.cosine)) / (2.0 * kPi) + 0.5;
    ++eighth[static_cast<std::size_t>(turns * 8.0) % 8];
  }
  for (const int count : eighth) EXPECT_NEAR(count, kCount / 8, 4.0 * std::sqrt(kCount * 7.0 / 64.0));
}

TEST(LanesMath, RandomWordsAreThoseOfTheScalarGenerator) {
  Words counter = {};
  for (std::size_t i = 0; i < kWidth; ++i) counter[i] = static_cast<std::uint32_t>(41 + 977 * i);
  const FourWords words = randomWords(counter, {{0x12345678U, 0x9abcdef0U}, {7U, 8U, 9U}});
  for (std::size_t i = 0; i < kWidth; ++i) {
    const auto expected = philox4x32({counter[i], 7U, 8U, 9U}, {0x12345678U, 0x9abcdef0U});
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(words.of[k][i], expected[k]) << i << ' ' << k;
  }
}

}  // namespace pos::lanes
