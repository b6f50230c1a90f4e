#include "pos/ins/eskf_state.hpp"

#include <gtest/gtest.h>

#include "pos/core/pose3.hpp"
#include "pos/ins/mechanisation.hpp"
#include "support/manifold_laws.hpp"

namespace pos {

template <>
struct ManifoldSamples<ins::EskfState> {
  static std::vector<ins::EskfState> states() {
    ins::EskfState turned;
    turned.p_map = {10.0, -20.0, -300.0};
    turned.v_map = {2.0, 0.1, -0.3};
    turned.q_map_body = Pose3::fromXyzYawPitchRoll(0, 0, 0, 3.1, -0.2, 0.1).rotation;
    turned.accelerometer_bias = {0.02, -0.01, 0.03};
    turned.gyro_bias = {1e-3, 0.0, -2e-3};
    ins::EskfState other_sign = turned;
    other_sign.q_map_body.coeffs() *= -1.0;
    return {{}, turned, other_sign};
  }
};
INSTANTIATE_TYPED_TEST_SUITE_P(EskfState, ManifoldLaws, ::testing::Types<ins::EskfState>);

namespace ins {
namespace {

TEST(RightJacobian, IsTheDerivativeOfExp) {
  for (const double size : {0.0, 1e-9, 1e-4, 0.00999, 0.01001, 0.1, 1.0, 3.0}) {
    const Eigen::Vector3d theta = size * Eigen::Vector3d(0.6, -0.48, 0.64);
    Eigen::Matrix3d numeric;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = 1e-6 * Eigen::Vector3d::Unit(i);
      const Eigen::Quaterniond back = quaternionFromRotationVector(theta).conjugate();
      numeric.col(i) = (rotationVector(back * quaternionFromRotationVector(theta + d)) -
                        rotationVector(back * quaternionFromRotationVector(theta - d))) /
                       2e-6;
    }
    EXPECT_LT((rightJacobian(theta) - numeric).cwiseAbs().maxCoeff(), 1e-9) << size;
    EXPECT_LT((rightJacobian(theta) * rightJacobianInverse(theta) - Eigen::Matrix3d::Identity()).norm(),
              1e-12)
        << size;
  }
}

TEST(RightJacobian, IsTheResetOfTheErrorAfterAnInjection) {
  // theta_new = Log(Exp(-injected) Exp(injected + d)) = J_r(injected) d; the paper's I - [injected x] / 2 is
  // its first order, and the other sign is wrong.
  const Eigen::Vector3d injected(0.02, -0.03, 0.015);
  Eigen::Matrix3d numeric;
  for (int i = 0; i < 3; ++i) {
    const auto reset = [&](double d) {
      return rotationVector(quaternionFromRotationVector(-injected) *
                            quaternionFromRotationVector(injected + d * Eigen::Vector3d::Unit(i)));
    };
    numeric.col(i) = (reset(1e-6) - reset(-1e-6)) / 2e-6;
  }
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  EXPECT_LT((rightJacobian(injected) - numeric).norm(), 1e-9);
  EXPECT_LT((I - 0.5 * skew(injected) - numeric).norm(), 1e-3);
  EXPECT_GT((I - 0.5 * skew(injected) - numeric).norm(), 1e-4);
  EXPECT_GT((I + 0.5 * skew(injected) - numeric).norm(), 0.03);
}

TEST(TurnAttitude, IsTheFullProduct) {
  Matrix<15, 15> P;
  for (int i = 0; i < 15; ++i) {
    for (int j = 0; j < 15; ++j) P(i, j) = 1.0 / (1.0 + i + j);
  }
  const Eigen::Matrix3d block = rightJacobian({0.3, -0.2, 0.5});
  Matrix<15, 15> G = Matrix<15, 15>::Identity();
  G.block<3, 3>(EskfState::kAttitude, EskfState::kAttitude) = block;
  const Matrix<15, 15> expected = G * P * G.transpose();
  turnAttitude(P, block);
  EXPECT_LT((P - expected).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(P, P.transpose());
}

}  // namespace
}  // namespace ins
}  // namespace pos
