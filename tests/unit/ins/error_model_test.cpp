#include "pos/ins/error_model.hpp"

#include <gtest/gtest.h>

#include "support/inertial_errors.hpp"

namespace pos::ins {
namespace {

using testing::errorRate;
using testing::inertialCases;
using testing::Vector15;
using Case = testing::InertialCase;
using Matrix15 = Eigen::Matrix<double, 15, 15>;

Matrix15 numericF(const Case& c) {
  Vector15 step;
  step << Vector15::Constant(1e-6);
  step.segment<3>(kVelocity).setConstant(1e-3);
  step.segment<3>(kPosition).setConstant(10.0);
  Matrix15 F;
  for (int i = 0; i < 15; ++i) {
    Vector15 d = Vector15::Zero();
    d[i] = step[i];
    F.col(i) = (errorRate(c, d) - errorRate(c, -d)) / (2.0 * step[i]);
  }
  return F;
}

// Each block is held to its own largest entry: the blocks differ by twelve orders of magnitude. Left out on
// purpose are the radii's change with latitude (rows of phi and dv by dp, and the metric's), below 2e-8 1/s.
TEST(ErrorModel, EveryBlockEqualsTheDifferentiatedMechanisation) {
  for (const Case& c : inertialCases()) {
    const Matrix15 F = denseF(errorModel(c.earth, c.state, c.force));
    const Matrix15 N = numericF(c);
    for (int r = 0; r < 15; r += 3) {
      for (int k = 0; k < 15; k += 3) {
        const Eigen::Matrix3d analytic = F.block<3, 3>(r, k);
        const Eigen::Matrix3d numeric = N.block<3, 3>(r, k);
        const double rounding = k == kPosition ? 0.0 : 1e-10;
        const double radii = k != kPosition ? 0.0 : (r == kPhi ? 1e-14 : 5e-9);
        EXPECT_LE((analytic - numeric).cwiseAbs().maxCoeff(),
                  1e-6 * numeric.cwiseAbs().maxCoeff() + rounding + radii)
            << "block " << r << "," << k << "\n"
            << analytic << "\n\n"
            << numeric;
      }
    }
  }
}

TEST(ErrorModel, WithoutTheGravityGradientTheVerticalChannelWouldBeStable) {
  const Case c = inertialCases().back();
  const ErrorModel model = errorModel(c.earth, c.state, c.force);
  EXPECT_NEAR(model.v_p(2, 2), 3.085e-6, 5e-9);
}

}  // namespace
}  // namespace pos::ins
