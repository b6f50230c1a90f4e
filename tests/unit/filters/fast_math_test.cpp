#include "pos/filters/fast_math.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pos/core/angle.hpp"

namespace pos::filters {

TEST(FastMath, ExpAgreesWithDoublePrecision) {
  for (double x = -86.0; x < 88.0; x += 0.0137) {
    EXPECT_NEAR(static_cast<double>(fastExp(static_cast<float>(x))) /
                    std::exp(static_cast<double>(static_cast<float>(x))),
                1.0, 1e-6)
        << x;
  }
  EXPECT_EQ(fastExp(0.0F), 1.0F);
}

TEST(FastMath, ExpStaysPositiveAndFiniteFarOut) {
  EXPECT_GT(fastExp(-1e30F), 0.0F);
  EXPECT_LT(fastExp(-1e30F), 1e-37F);
  EXPECT_TRUE(std::isfinite(fastExp(1e30F)));
}

TEST(FastMath, LogAgreesWithDoublePrecision) {
  for (double e = -37.0; e < 38.0; e += 0.00731) {
    const auto x = static_cast<float>(std::pow(10.0, e));
    const double expected = std::log(static_cast<double>(x));
    EXPECT_NEAR(fastLog(x), expected, 3e-7 * (1.0 + std::abs(expected))) << x;
  }
  EXPECT_EQ(fastLog(1.0F), 0.0F);
}

TEST(FastMath, SineAndCosineAgreeInEveryQuarter) {
  for (double a = -7.0; a < 7.0; a += 0.00113) {
    const double angle = static_cast<float>(a);
    const SineCosine both = fastSineCosine(static_cast<float>(a));
    EXPECT_NEAR(both.sine, std::sin(angle), 1e-6) << a;
    EXPECT_NEAR(both.cosine, std::cos(angle), 1e-6) << a;
  }
}

TEST(FastMath, WrapKeepsTheDirection) {
  for (double a = -12.0; a < 12.0; a += 0.0313) {
    const double angle = static_cast<float>(a);
    const double wrapped = fastWrap(static_cast<float>(a));
    EXPECT_LE(std::abs(wrapped), kPi + 1e-6);
    EXPECT_NEAR(wrapAngle(wrapped - angle), 0.0, 3e-6) << a;
  }
}

}  // namespace pos::filters
