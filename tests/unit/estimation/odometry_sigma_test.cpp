#include "pos/estimation/odometry_sigma.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pos::estimation {

TEST(OdometrySigma, VariancesOfTwoHalvesAddUpToTheWhole) {
  const OdometryNoise noise;
  const Vector<3> whole = incrementSigma(noise, {1.2, 0.0, 0.4}, 2.0);
  const Vector<3> half = incrementSigma(noise, {0.6, 0.0, 0.2}, 1.0);
  EXPECT_TRUE(whole.cwiseAbs2().isApprox(2.0 * half.cwiseAbs2(), 1e-12));
  EXPECT_NEAR(whole[0], std::sqrt(0.03 * 0.03 * 1.2 + 0.001 * 0.001 * 2.0), 1e-12);
  EXPECT_EQ(incrementSigma(noise, {}, 0.0), (Vector<3>::Zero()));
}

}  // namespace pos::estimation
