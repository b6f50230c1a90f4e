#include "pos/estimation/sins_state.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <unsupported/Eigen/MatrixFunctions>

#include "support/inertial_errors.hpp"
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
    const Eigen::Vector3d lever = Eigen::Vector3d(1.5, -0.3, 0.8) - kMounts.imu;
    const auto point = [&](const SinsDrState& y) -> Eigen::Vector3d {
      return ins::metresBetween(y.earth, x.nav.coordinates, y.nav.coordinates) + y.nav.q_n_b * lever;
    };
    expectH(x, [&](const SinsDrState& y) { return positionFix(y, seen - point(y), lever); });
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

/// A covariance whose states differ in size as a filter's do.
Belief<SinsDrState> believed(const SinsDrState& x, unsigned seed) {
  Vector<21> sigma;
  sigma << Vector<3>::Constant(0.01), Vector<3>::Constant(0.1), Vector<3>::Constant(0.5),
      Vector<3>::Constant(1e-3), Vector<3>::Constant(0.02), Vector<3>::Constant(0.6), 0.01, 0.005, 0.008;
  std::srand(seed);
  const Matrix<21, 21> A = Matrix<21, 21>::Random();
  const Matrix<21, 21> C = A * A.transpose() / 7.0;
  const Matrix<21, 21> P = sigma.asDiagonal() * C * sigma.asDiagonal();
  return {x, 0.5 * (P + P.transpose())};
}

TEST(SinsDrModels, CarryingByBlocksEqualsTheFullMatrices) {
  SinsDrConfig config;
  config.boresight_sigma = 0.01;
  for (const SinsDrState& x : sinsSamples()) {
    SinsDrInput in;
    in.force_b = {0.4, -0.7, 9.9};
    in.wheel_speed = 2.5;
    in.wheel_v_n = 2.5 * (x.nav.q_n_b * x.rollingDirection());
    in.wheel_interval = 0.02;
    for (const double dt : {0.0, 0.005, 0.05}) {
      const Belief<SinsDrState> before = believed(x, 3);
      const auto step = sinsDrStep(config, x, in, dt);
      const Matrix<21, 21> dense = step.F * before.covariance * step.F.transpose() + step.Qd;
      Belief<SinsDrState> blocks = before;
      propagate(blocks, config, in, dt);
      const Vector<21> sigma = dense.diagonal().cwiseSqrt();
      const double off =
          ((blocks.covariance - dense).array() / (sigma * sigma.transpose()).array()).abs().maxCoeff();
      EXPECT_LT(off, x.earth.isFlat() ? 1e-12 : 2e-6 * (dt / 0.05) + 1e-12) << dt;
      EXPECT_EQ((blocks.covariance - blocks.covariance.transpose()).norm(), 0.0);
    }
  }
}

TEST(SinsDrModels, TakingTheDifferenceEqualsTheGeneralCorrection) {
  for (const SinsDrState& x : sinsSamples()) {
    Belief<SinsDrState> general = believed(x, 5);
    Belief<SinsDrState> special = general;
    const Matrix<3, 3> R = 4e-4 * Matrix<3, 3>::Identity();
    const auto a = filters::correct(general, positionDifference(x, 0.007), R);
    const auto b = correctDifference(special, 0.007, R);
    EXPECT_EQ(a.verdict, b.verdict);
    EXPECT_NEAR(a.nis, b.nis, 1e-9 * a.nis);
    EXPECT_TRUE(a.S.isApprox(b.S, 1e-12));
    // Rounding of longitudes (2e-16 rad is 1e-9 m) on the ellipsoid.
    EXPECT_LT(minus(general.mean, special.mean).cwiseAbs().maxCoeff(), x.earth.isFlat() ? 1e-12 : 1e-8);
    EXPECT_TRUE(general.covariance.isApprox(special.covariance, 1e-9));
  }
}

TEST(SinsDrModels, CovarianceStaysSymmetricAndPositiveForAHundredThousandSteps) {
  SinsDrConfig config;
  Belief<SinsDrState> belief = believed(sinsSample(ins::Earth::flat(), 0.7, 0.1), 7);
  reanchor(belief);
  SinsDrInput in;
  in.wheel_speed = 2.5;
  in.wheel_interval = 0.02;
  const Matrix<3, 3> R = 1e-4 * Matrix<3, 3>::Identity();
  for (int i = 0; i < 100000; ++i) {
    const double phase = 1e-3 * i;
    in.force_b = {std::sin(phase), std::cos(2.0 * phase), 9.8};
    in.wheel_v_n = 2.5 * Eigen::Vector3d(std::cos(phase), std::sin(phase), 0.1);
    propagate(belief, config, in, 0.05);
    if (i % 2 == 0) correctDifference(belief, 0.0, R);
  }
  const Matrix<21, 21>& P = belief.covariance;
  EXPECT_EQ((P - P.transpose()).norm(), 0.0);
  const Vector<21> scale = P.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
  const Matrix<21, 21> correlation = scale.asDiagonal() * P * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix<21, 21>> eigen(correlation);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-9);
}

/// Rate of change of all 19 errors, from both nonlinear solutions: inertial unit, and wheels that roll
/// `speed` along the attitude's x axis and read (1 + dk) times the way.
Vector<19> rateOfAllErrors(const testing::InertialCase& c, double speed, const Vector<19>& e) {
  Vector<19> rate = Vector<19>::Zero();
  rate.head<15>() = testing::errorRate(c, e.head<15>());
  const Eigen::Vector3d metric = c.earth.at(c.state.coordinates).metric;
  const Eigen::Vector3d hat = c.state.coordinates + e.segment<3>(15).cwiseQuotient(metric);
  const auto velocity = [&](const Eigen::Quaterniond& q, double way) -> Eigen::Vector3d {
    return way * (q * Eigen::Vector3d::UnitX());
  };
  const Eigen::Vector3d v = velocity(c.state.q_n_b, speed);
  const Eigen::Vector3d v_hat =
      velocity(testing::disturbed(c, e.head<15>()).q_n_b, (1.0 + e[kScale]) * speed);
  rate.segment<3>(15) = testing::metresRate(c.earth, c.state.coordinates, hat, v.cwiseQuotient(metric),
                                            v_hat.cwiseQuotient(c.earth.at(hat).metric));
  return rate;
}

SinsDrState stateOf(const testing::InertialCase& c) {
  SinsDrState x;
  x.earth = c.earth;
  x.nav = c.state;
  x.wheel_coordinates = c.state.coordinates;
  return x;
}

SinsDrInput inputOf(const testing::InertialCase& c, double speed) {
  SinsDrInput in;
  in.force_b = c.force;
  in.wheel_speed = speed;
  in.wheel_v_n = speed * (c.state.q_n_b * Eigen::Vector3d::UnitX());
  in.wheel_interval = 0.02;
  return in;
}

// The radii's own change with latitude is left out on purpose: rows of dv and dp by dp, below 2e-8 1/s.
TEST(SinsDrModels, All361EntriesOfFAreTheDifferentiatedMechanisation) {
  const double speed = 3.1;
  Vector<19> step = Vector<19>::Constant(1e-6);
  step.segment<3>(ins::kVelocity).setConstant(1e-3);
  step.segment<3>(ins::kPosition).setConstant(10.0);
  step.segment<3>(kWheelPosition).setConstant(10.0);
  for (const testing::InertialCase& c : testing::inertialCases()) {
    const Matrix<21, 21> F = sinsDrErrorF(stateOf(c), inputOf(c, speed));
    for (int column = 0; column < 19; ++column) {
      Vector<19> e = Vector<19>::Zero();
      e[column] = step[column];
      const Vector<19> numeric =
          (rateOfAllErrors(c, speed, e) - rateOfAllErrors(c, speed, -e)) / (2.0 * step[column]);
      for (int row = 0; row < 19; ++row) {
        const double largest = F.row(row).head<19>().cwiseAbs().maxCoeff();
        EXPECT_NEAR(F(row, column), numeric[row], 1e-6 * largest + 2e-8) << row << "," << column;
      }
    }
  }
}

TEST(SinsDrModels, PhiIsTheExponentialOfFToSecondOrder) {
  for (const testing::InertialCase& c : testing::inertialCases()) {
    for (const double dt : {0.005, 0.05}) {
      const SinsDrState x = stateOf(c);
      const Matrix<21, 21> FT = dt * sinsDrErrorF(x, inputOf(c, 3.1));
      const Vector<21> s = errorSigns();
      const Eigen::MatrixXd exact = Eigen::MatrixXd(FT).exp();
      const Matrix<21, 21> Phi = s.asDiagonal() * sinsDrStep({}, x, inputOf(c, 3.1), dt).F * s.asDiagonal();
      // What is left is (F dt)^3 / 6: position by the gyro bias, g dt^3 / 6.
      EXPECT_LT((Phi - exact).cwiseAbs().maxCoeff(), 1.1 * 10.0 * dt * dt * dt / 6.0);
    }
  }
}

/// From rest, on a drive with bends: the two positions say nothing of the heading, however long it lasts.
TEST(SinsDrModels, ComparingThePositionsDoesNotMakeTheHeadingSurer) {
  SinsDrConfig config;
  config.imu.gyro_density = 1e-9;
  config.imu.gyro_bias_walk = 0.0;
  SinsDrState x;
  Matrix<21, 21> P = Matrix<21, 21>::Zero();
  ins::AlignmentSigmas sigmas;
  sigmas.gyro_bias = 0.0;
  P.topLeftCorner<15, 15>() = ins::alignmentCovariance(sigmas, x.nav.C_n_b(), 9.80665);
  P(kScale, kScale) = 1e-4;
  Belief<SinsDrState> belief{x, P};
  reanchor(belief);
  const double before = belief.covariance(2, 2);
  const Matrix<3, 3> R = 1e-4 * Matrix<3, 3>::Identity();
  const double dt = 0.05;
  for (int i = 0; i < 6000; ++i) {
    const double t = dt * i;
    const double speed = std::min(t, 3.0);
    const double rate = t > 5.0 ? 0.3 * std::sin(0.2 * t) : 0.0;
    const Eigen::Vector3d force(t < 3.0 ? 1.0 : 0.0, speed * rate, 9.80665);
    belief.mean.nav =
        ins::stepped(x.earth, belief.mean.nav, {dt * Eigen::Vector3d(0, 0, rate), dt * force, dt});
    belief.mean.wheel_coordinates = belief.mean.nav.coordinates;
    SinsDrInput in;
    in.force_b = force;
    in.wheel_speed = speed;
    in.wheel_v_n = belief.mean.nav.v_n;
    in.wheel_interval = 0.02;
    propagate(belief, config, in, dt);
    if (i % 2 == 0) correctDifference(belief, 0.0, R);
  }
  EXPECT_GT(belief.covariance(2, 2), 0.98 * before) << "sigma kept to 1 %";
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
