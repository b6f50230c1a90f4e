#include "pos/ins/error_model.hpp"

#include <gtest/gtest.h>

#include "pos/core/pose3.hpp"

namespace pos::ins {
namespace {

using Vector15 = Eigen::Matrix<double, 15, 1>;
using Matrix15 = Eigen::Matrix<double, 15, 15>;

struct Case {
  Earth earth;
  NavigationState state;
  Eigen::Vector3d omega;
  Eigen::Vector3d force;
};

/// The estimated solution whose error is `x`: C^ = (I - [phi x]) C to first order, as a rotation.
NavigationState disturbed(const Case& c, const Vector15& x) {
  NavigationState s = c.state;
  s.q_n_b = quaternionFromRotationVector(-x.segment<3>(kPhi)) * s.q_n_b;
  s.v_n += x.segment<3>(kVelocity);
  s.coordinates += x.segment<3>(kPosition).cwiseQuotient(c.earth.at(c.state.coordinates).metric);
  return s;
}

/// Rate of change of the error, from the nonlinear mechanisation of both solutions.
Vector15 errorRate(const Case& c, const Vector15& x) {
  const NavigationState hat = disturbed(c, x);
  const NavigationRates truth = navigationRates(c.earth, c.state, c.omega, c.force);
  const NavigationRates wrong = navigationRates(c.earth, hat, c.omega + x.segment<3>(kGyroBias),
                                                c.force + x.segment<3>(kAccelerometerBias));
  Vector15 rate = Vector15::Zero();
  const Eigen::Matrix3d C = c.state.C_n_b();
  const Eigen::Matrix3d product = wrong.C_n_b * C.transpose() + hat.C_n_b() * truth.C_n_b.transpose();
  const Eigen::Matrix3d odd = -0.5 * (product - product.transpose());
  rate.segment<3>(kPhi) << odd(2, 1), odd(0, 2), odd(1, 0);
  rate.segment<3>(kVelocity) = wrong.v_n - truth.v_n;
  // dp = metric(truth) * (coordinates^ - coordinates); its rate has the metric's own rate in it.
  const EarthPoint here = c.earth.at(c.state.coordinates);
  const double dt = 1e-3;
  const Eigen::Vector3d ahead = c.earth.at(c.state.coordinates + dt * truth.p).metric;
  const Eigen::Vector3d behind = c.earth.at(c.state.coordinates - dt * truth.p).metric;
  const Eigen::Vector3d metric_rate = (ahead - behind) / (2.0 * dt);
  const Eigen::Vector3d apart = hat.coordinates - c.state.coordinates;
  rate.segment<3>(kPosition) = here.metric.cwiseProduct(wrong.p - truth.p) + metric_rate.cwiseProduct(apart);
  return rate;
}

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

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const bool flat : {true, false}) {
    for (const double yaw : {0.0, 1.2, 3.1415, -2.0}) {
      Case c{flat ? Earth::flat() : Earth::ellipsoid(), {}, {0.02, -0.03, 0.2}, {0.4, -0.7, 9.9}};
      c.state.q_n_b = Pose3::fromXyzYawPitchRoll(0, 0, 0, yaw, 0.15, -0.08).rotation;
      c.state.v_n = {3.6, -2.0, 0.4};
      c.state.coordinates = flat ? Eigen::Vector3d(100, 50, -20) : Eigen::Vector3d(1.9, 0.61, -350.0);
      all.push_back(c);
    }
  }
  return all;
}

// Each block is held to its own largest entry: the blocks differ by twelve orders of magnitude. Left out on
// purpose are the radii's change with latitude (rows of phi and dv by dp, and the metric's), below 2e-8 1/s.
TEST(ErrorModel, EveryBlockEqualsTheDifferentiatedMechanisation) {
  for (const Case& c : cases()) {
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
  const Case c = cases().back();
  const ErrorModel model = errorModel(c.earth, c.state, c.force);
  EXPECT_NEAR(model.v_p(2, 2), 3.085e-6, 5e-9);
}

}  // namespace
}  // namespace pos::ins
