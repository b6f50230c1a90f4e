#include "pos/estimation/sins_state.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "support/manifold_laws.hpp"
#include "support/numeric_jacobian.hpp"

namespace pos {

using estimation::SinsDrState;

namespace {

SinsDrState sinsSample(const ins::Earth& earth, double yaw, double pitch) {
  SinsDrState x;
  x.earth = earth;
  x.nav.q_n_b = Pose3::fromXyzYawPitchRoll(0, 0, 0, yaw, pitch, 0.07).rotation;
  x.nav.v_n = {3.1, -1.4, 0.3};
  x.nav.coordinates = earth.isFlat() ? Eigen::Vector3d(12, -7, 3) : Eigen::Vector3d(1.9, 0.61, -350.0);
  x.wheel_coordinates =
      x.nav.coordinates + Eigen::Vector3d(0.3, -0.2, 0.1).cwiseQuotient(earth.at(x.nav.coordinates).metric);
  x.scale = 0.01;
  x.boresight_pitch = 0.004;
  x.boresight_yaw = -0.008;
  return x;
}

std::vector<SinsDrState> sinsSamples() {
  std::vector<SinsDrState> all;
  for (const ins::Earth& earth : {ins::Earth::flat(), ins::Earth::ellipsoid()}) {
    for (const double yaw : {0.0, 1.1, 3.1415, -2.4}) all.push_back(sinsSample(earth, yaw, 0.1));
  }
  return all;
}

}  // namespace

template <>
struct ManifoldSamples<SinsDrState> {
  static std::vector<SinsDrState> states() {
    return {SinsDrState{}, sinsSample(ins::Earth::flat(), 3.1, 0.2),
            sinsSample(ins::Earth::flat(), -3.1, -0.2)};
  }
};
INSTANTIATE_TYPED_TEST_SUITE_P(SinsDrState, ManifoldLaws, ::testing::Types<SinsDrState>);

namespace estimation {
namespace {

using testing::numericJacobian;

/// Numeric H of a quantity whose truth is zero (or a reading): d quantity / d tangent = -d nu / d tangent.
template <class Function>
void expectH(const SinsDrState& x, const Function& innovation, double flat_tolerance = 1e-6) {
  // A step of 1e-5 m is 1.6e-12 rad of longitude: rounding alone costs 1e-4 on the ellipsoid.
  const double tolerance = x.earth.isFlat() ? flat_tolerance : std::max(flat_tolerance, 3e-4);
  const auto analytic = innovation(x);
  const Eigen::MatrixXd numeric = numericJacobian<SinsDrState>(
      x, 21, [&](const SinsDrState& y) -> Eigen::VectorXd { return -innovation(y).nu; }, 1e-5);
  EXPECT_LT((analytic.H - numeric).cwiseAbs().maxCoeff(), tolerance) << analytic.H << "\n\n" << numeric;
}

const InertialMounts kMounts{.imu = {0.4, 0.1, 0.9}, .axle = {-0.6, 0.0, 0.3}};

TEST(SinsDrModels, EveryInnovationHasItsJacobian) {
  for (const SinsDrState& x : sinsSamples()) {
    expectH(x, [](const SinsDrState& y) { return positionDifference(y, 0.007); });
    expectH(x, [](const SinsDrState& y) { return zeroVelocity(y); });
    expectH(x, [](const SinsDrState& y) { return zeroRate(y, {0.01, 0.02, 0.03}); });
    expectH(x, [](const SinsDrState& y) { return noSidewaysSpeed(y, {0.01, 0.02, 0.3}, kMounts); });
    const Eigen::Quaterniond truth = x.nav.q_n_b;
    expectH(
        x,
        [&](const SinsDrState& y) {
          // The wheels' velocity as this state would have it.
          SinsDrInput in;
          in.wheel_speed = 2.0 * (1.0 + x.scale) / (1.0 + y.scale);
          in.wheel_v_n = in.wheel_speed * (y.nav.q_n_b * x.rollingDirection());
          return velocityDifference(y, in);
        },
        0.05);
    const Eigen::Vector3d seen = Eigen::Vector3d(0.3, 0.2, 0.1);
    const auto origin = [&](const SinsDrState& y) -> Eigen::Vector3d {
      return ins::metresBetween(y.earth, x.nav.coordinates, y.nav.coordinates) - y.nav.q_n_b * kMounts.imu;
    };
    expectH(x, [&](const SinsDrState& y) { return positionFix(y, seen - origin(y), kMounts); });
    expectH(x, [&](const SinsDrState& y) {
      const Pose3 pose{{0, 0, 0}, y.nav.q_n_b};
      return headingFix(y, std::remainder(0.2 - pose.yaw(), 2.0 * M_PI));
    });
    (void)truth;
  }
}

/// d/dt of the wheels' error by the errors of what moves it: attitude, scale, mounting.
TEST(SinsDrModels, WheelRowsOfFAreTheDerivativesOfRolling) {
  for (const SinsDrState& x : sinsSamples()) {
    const double speed = 2.5;
    SinsDrInput in;
    in.wheel_speed = speed;
    in.wheel_v_n = speed * (x.nav.q_n_b * x.rollingDirection());
    const Matrix<21, 21> F = sinsDrErrorF(x, in);
    const Vector<21> signs = errorSigns();
    const Eigen::MatrixXd numeric =
        numericJacobian<SinsDrState>(x, 21, [&](const SinsDrState& y) -> Eigen::VectorXd {
          // Truth's velocity by the wheels: the raw speed is what it is.
          const double own = speed * (1.0 + x.scale) / (1.0 + y.scale);
          return own * (y.nav.q_n_b * y.rollingDirection());
        });
    for (const int column : {0, 1, 2, 18, 19, 20}) {
      // error_D = -(tangent_D); F_error = S F_tangent S.
      const Eigen::Vector3d expected = signs[15] * numeric.col(column) * signs[column];
      const double tolerance =
          column == 18 ? 0.06 : (column > 18 ? 0.03 : 1e-6);  // first order in scale, angles
      EXPECT_LT((F.block<3, 1>(15, column) - expected).norm(), tolerance) << column;
    }
  }
}

TEST(SinsDrModels, ReanchoringMakesTheDifferenceKnownAndKeepsTheRest) {
  const Matrix<21, 21> A = Matrix<21, 21>::Random();
  Belief<SinsDrState> belief(sinsSample(ins::Earth::flat(), 0.4, 0.1), A * A.transpose());
  const Matrix<21, 21> before = belief.covariance;
  reanchor(belief);
  const auto H = positionDifference(belief.mean, 0.0).H;
  EXPECT_LT((H * belief.covariance * H.transpose()).norm(), 1e-12);
  EXPECT_EQ(positionDifference(belief.mean, 0.0).nu.norm(), 0.0);
  EXPECT_LT((belief.covariance.topLeftCorner<15, 15>() - before.topLeftCorner<15, 15>()).norm(), 1e-12);
  const Eigen::SelfAdjointEigenSolver<Matrix<21, 21>> eigen(belief.covariance);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-9);
}

TEST(SinsDrModels, RollingAFullCircleComesBackWithALeverArm) {
  SinsDrState x;
  const Eigen::Vector3d start = x.wheel_coordinates;
  const int steps = 200;
  Eigen::Quaterniond q = x.nav.q_n_b;
  for (int i = 0; i < steps; ++i) {
    const Eigen::Quaterniond next = q * quaternionFromRotationVector({0, 0, 2.0 * M_PI / steps});
    x = rolled(x, q, next, 2.0 * M_PI * 3.0 / steps, kMounts);
    q = next;
  }
  EXPECT_LT((x.wheel_coordinates - start).norm(), 1e-9);
}

TEST(SinsDrModels, AttitudeErrorTurnsBothPositionsAlikeSoTheirDifferenceCannotSeeIt) {
  const SinsDrState x = sinsSample(ins::Earth::flat(), 0.7, 0.0);
  SinsDrInput in;
  in.wheel_speed = x.nav.v_n.norm();
  in.wheel_v_n = x.nav.v_n;
  in.force_b = x.nav.q_n_b.conjugate() * Eigen::Vector3d(0, 0, 9.80665);
  const Matrix<21, 21> F = sinsDrErrorF(x, in);
  // At steady speed the heading's error moves the wheels' place at once, the inertial one through the
  // velocity error that goes with it: phi_U with dv = v x phi.
  Vector<21> gauge = Vector<21>::Zero();
  gauge[2] = 1.0;
  gauge.segment<3>(3) = ins::skew(x.nav.v_n) * Eigen::Vector3d::UnitZ();
  const Vector<21> rate = F * gauge;
  EXPECT_LT((rate.segment<3>(6) - rate.segment<3>(15)).norm(), 1e-12);
}

}  // namespace
}  // namespace estimation
}  // namespace pos
