#include "pos/estimation/shearer_state.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include <Eigen/Eigenvalues>

#include "pos/core/angle.hpp"
#include "pos/core/pose3.hpp"
#include "pos/core/random.hpp"

namespace pos::estimation {
namespace {

using ins::kPhi;
using ins::kPosition;
using ins::kVelocity;

const Eigen::Vector3d kArm(0.4, -0.3, 0.8);
const LegSight kSight{.measured = {-9.2, 4.1, 0.05},
                      .covariance = Eigen::Vector3d(1e-4, 1e-4, 4e-4).asDiagonal(),
                      .age = 0.004};

ins::Earth turningEarth() {
  return ins::Earth::level({0.0, 5.97e-5, 4.18e-5}, 9.797);
}

ShearerBelief belief(bool sensor_states) {
  ShearerState x;
  x.earth = turningEarth();
  x.nav.q_n_b = Pose3::fromXyzYawPitchRoll(0, 0, 0, 1.4, 0.05, -0.08).rotation;
  x.nav.v_n = {0.01, 0.1, -0.002};
  x.nav.coordinates = {3.0, 120.0, 0.4};
  x.sensor_states = sensor_states;
  if (sensor_states) x.sensor = {0.01, 0.002, 5e-4, 0.03, -0.004, 0.002};
  ShearerBelief b{x, {}, {}};
  RandomStream random(5, 1);
  ShearerMatrix root(x.dof(), x.dof());
  for (Eigen::Index i = 0; i < root.size(); ++i) root(i) = random.normal(0.0, 1e-3);
  b.covariance = root * root.transpose();
  return b;
}

/// A diagonal start like that of the specification.
ShearerBelief started(bool turning) {
  ShearerBelief b;
  b.mean.earth = turning ? turningEarth() : ins::Earth::flat(9.797);
  b.mean.nav.q_n_b = Pose3::fromXyzYawPitchRoll(0, 0, 0, 0.5 * kPi, 0, 0).rotation;
  Eigen::Matrix<double, 15, 1> sigma;
  sigma << 8.7e-5, 8.7e-5, 1.45e-3, 1e-3, 1e-3, 1e-3, 1e-4, 1e-4, 1e-4, 2.4e-7, 2.4e-7, 2.4e-7, 4.9e-4,
      4.9e-4, 4.9e-4;
  b.covariance = sigma.cwiseAbs2().asDiagonal();
  return b;
}

ImuNoise quietUnit() {
  ImuNoise noise;
  noise.gyro_density = noise.accelerometer_density = 1e-12;
  noise.gyro_bias_walk = noise.accelerometer_bias_walk = 1e-15;
  return noise;
}

/// Central difference of f(state (+) d) by every component of d.
template <class F>
ShearerRows3 numeric(const ShearerState& x, F f) {
  ShearerRows3 J(3, x.dof());
  for (int i = 0; i < x.dof(); ++i) {
    const double h = 1e-6;
    ShearerVector d = ShearerVector::Zero(x.dof());
    d[i] = h;
    ShearerState up = x;
    inject(up, d);
    ShearerState down = x;
    d[i] = -h;
    inject(down, d);
    J.col(i) = (f(up) - f(down)) / (2.0 * h);
  }
  return J;
}

}  // namespace

TEST(ShearerState, LegHIsTheDerivativeOfThePrediction) {
  for (const bool states : {false, true}) {
    ShearerBelief b = belief(states);
    ASSERT_TRUE(addLandmark(b, 7, kSight, kArm));
    ASSERT_TRUE(addLandmark(b, 8, {{-10.7, 4.0, 0.0}, kSight.covariance, 0.0}, kArm));
    const auto H = legInnovation(b.mean, kSight, 0, kArm).H;
    const auto N = numeric(b.mean, [&](const ShearerState& x) -> Eigen::Vector3d {
      return -legInnovation(x, kSight, 0, kArm).nu;
    });
    EXPECT_LT((H - N).norm(), 1e-7 * N.norm());
    const auto stop = stopInnovation(b.mean, 1, {1, 2, 3});
    const auto stop_N = numeric(b.mean, [&](const ShearerState& x) -> Eigen::Vector3d {
      return -stopInnovation(x, 1, {1, 2, 3}).nu;
    });
    EXPECT_LT((stop.H - stop_N).norm(), 1e-7);
  }
}

TEST(ShearerState, NewLandmarkCarriesTheCovarianceOfItsPlace) {
  for (const bool states : {false, true}) {
    ShearerBelief b = belief(states);
    const ShearerState x = b.mean;
    const ShearerMatrix P = b.covariance;
    ASSERT_TRUE(addLandmark(b, 7, kSight, kArm));
    const ShearerRows3 J =
        numeric(x, [&](const ShearerState& s) -> Eigen::Vector3d { return placeOf(s, kSight, kArm); });
    const Eigen::Matrix3d C = x.nav.C_n_b();
    const int n = x.dof();
    const double scale = b.covariance.norm();
    EXPECT_LT((b.covariance.block(n, 0, 3, n) - J * P).norm(), 1e-7 * scale);
    EXPECT_LT((b.covariance.block<3, 3>(n, n) - J * P * J.transpose() - C * kSight.covariance * C.transpose())
                  .norm(),
              1e-7 * scale);
    EXPECT_EQ((b.covariance.topLeftCorner(n, n) - P).norm(), 0.0);
  }
}

TEST(ShearerState, TakingUpAndForgettingALandmarkChangesNoBit) {
  ShearerBelief b = belief(true);
  ASSERT_TRUE(addLandmark(b, 1, kSight, kArm));
  const ShearerBelief before = b;
  ASSERT_TRUE(addLandmark(b, 2, {{-7.0, 4.0, 0.0}, kSight.covariance, 0.0}, kArm));
  removeLandmark(b, 1);
  EXPECT_EQ((b.covariance - before.covariance).norm(), 0.0);
  ASSERT_TRUE(addLandmark(b, 2, {{-7.0, 4.0, 0.0}, kSight.covariance, 0.0}, kArm));
  removeLandmark(b, 0);
  EXPECT_EQ(b.mean.landmarks[0].id, 2);
  EXPECT_EQ((b.covariance.topLeftCorner<15, 15>() - before.covariance.topLeftCorner<15, 15>()).norm(), 0.0);
}

TEST(ShearerState, PropagationFollowsTheMechanisation) {
  // Errors carried by the strapdown itself over 40 ms against the transition, column by column.
  const ShearerBelief b = belief(false);
  const double dt = 0.01;
  const ins::ImuIncrement raw{{2e-6, -1e-6, 5e-4}, {0.002, -0.001, 0.0985}, dt};
  const auto moved = [&](const Eigen::Matrix<double, 15, 1>& d) {
    ShearerState x = b.mean;
    ShearerVector full = d;
    inject(x, full);
    for (int i = 0; i < 4; ++i) {
      x.nav = ins::stepped(x.earth, x.nav,
                           {raw.angle - dt * x.gyro_bias, raw.velocity - dt * x.accelerometer_bias, dt});
    }
    return x;
  };
  const ShearerState centre = moved(Eigen::Matrix<double, 15, 1>::Zero());
  for (int i = 0; i < 15; ++i) {
    ShearerBelief one = b;
    one.mean = centre;
    one.covariance.setZero();
    one.covariance(i, i) = 1.0;
    propagate(one, b.mean.nav, quietUnit(), 0.04);
    Eigen::Matrix<double, 15, 1> d = Eigen::Matrix<double, 15, 1>::Zero();
    const double h = i < 3 ? 1e-5 : 1e-4;
    d[i] = h;
    const ShearerState up = moved(d);
    d[i] = -h;
    const ShearerState down = moved(d);
    Eigen::Matrix<double, 15, 1> column;
    column.segment<3>(kPhi) = rotationVector(up.nav.q_n_b * down.nav.q_n_b.conjugate());
    column.segment<3>(kVelocity) = up.nav.v_n - down.nav.v_n;
    column.segment<3>(kPosition) = up.nav.coordinates - down.nav.coordinates;
    column.segment<3>(9) = up.gyro_bias - down.gyro_bias;
    column.segment<3>(12) = up.accelerometer_bias - down.accelerometer_bias;
    column /= 2.0 * h;
    // P = column column'.
    // Of second order in time: of a gyro bias the position misses g t^3 / 6, once on each side of the
    // diagonal.
    const double third_order = i >= 9 && i < 12 ? std::numbers::sqrt2 * 9.81 * 0.04 * 0.04 * 0.04 / 6.0 : 0.0;
    EXPECT_LT((one.covariance - column * column.transpose()).norm(),
              2e-5 * column.squaredNorm() + 1.01 * third_order)
        << i;
  }
}

TEST(ShearerState, AStaticLegNeverTellsWhereAndWhitherOnAnEarthThatStands) {
  ShearerBelief b = started(false);
  RandomStream random(3, 2);
  const ImuNoise noise{};
  const double yaw_variance = b.covariance(2, 2);
  const double position = b.covariance(kPosition, kPosition);
  bool first = true;
  for (int scan = 0; scan < 1000; ++scan) {
    const ins::NavigationState before = b.mean.nav;
    for (int i = 0; i < 4; ++i) {
      b.mean.nav = ins::stepped(b.mean.earth, b.mean.nav,
                                {Eigen::Vector3d::Zero(), Eigen::Vector3d(0.0, 0.0, 0.09797), 0.01});
    }
    propagate(b, before, noise, 0.04);
    LegSight sight{.measured = {-9.0, 4.0, 0.0}, .covariance = 1e-4 * Eigen::Matrix3d::Identity()};
    for (int i = 0; i < 3; ++i) sight.measured[i] += random.normal(0.0, 0.01);
    if (first) {
      ASSERT_TRUE(addLandmark(b, 1, sight, kArm));
      first = false;
      continue;
    }
    const Eigen::Matrix3d C = b.mean.nav.C_n_b();
    correct(b, legInnovation(b.mean, sight, 0, kArm), C * sight.covariance * C.transpose(), 1e9);
    ASSERT_GE(b.covariance(2, 2), yaw_variance * (1.0 - 1e-9)) << scan;
    ASSERT_GE(b.covariance(kPosition, kPosition), position * (1.0 - 1e-9)) << scan;
    ASSERT_GE(b.covariance(kPosition + 1, kPosition + 1), position * (1.0 - 1e-9)) << scan;
  }
  // The corrections moved things all the same.
  EXPECT_GT((b.mean.nav.coordinates).norm(), 1e-5);
}

TEST(ShearerState, UncorrelatedLandmarksFeignAbsoluteFixes) {
  for (const Initialisation how : {Initialisation::Correlated, Initialisation::Uncorrelated}) {
    ShearerBelief b = started(false);
    b.covariance.block<3, 3>(kPosition, kPosition) = 0.04 * Eigen::Matrix3d::Identity();
    for (int leg = 0; leg < 40; ++leg) {
      const LegSight sight{.measured = {-9.0, 4.0, 0.0}, .covariance = 1e-4 * Eigen::Matrix3d::Identity()};
      ASSERT_TRUE(addLandmark(b, leg, sight, kArm, how));
      const Eigen::Matrix3d C = b.mean.nav.C_n_b();
      for (int i = 0; i < 20; ++i)
        correct(b, legInnovation(b.mean, sight, 0, kArm), C * sight.covariance * C.transpose(), 1e9);
      removeLandmark(b, 0);
    }
    if (how == Initialisation::Correlated) {
      EXPECT_GT(b.covariance(kPosition, kPosition), 0.04 * (1.0 - 1e-9));
    } else {
      EXPECT_LT(b.covariance(kPosition, kPosition), 0.5 * 0.04);
    }
  }
}

TEST(ShearerState, CovarianceStaysPositiveAndSymmetric) {
  ShearerBelief b = started(true);
  const ImuNoise noise{};
  for (int step = 0; step < 20000; ++step) {
    const ins::NavigationState before = b.mean.nav;
    b.mean.nav = ins::stepped(b.mean.earth, b.mean.nav,
                              {Eigen::Vector3d::Zero(), Eigen::Vector3d(0.0, 0.0, 0.39188), 0.04});
    propagate(b, before, noise, 0.04);
    const LegSight sight{.measured = {-9.0, 4.0, 0.0}, .covariance = kSight.covariance};
    if (step % 50 == 0) {
      if (b.mean.landmark_count == 3) removeLandmark(b, 0);
      ASSERT_TRUE(addLandmark(b, step, sight, kArm));
    }
    const Eigen::Matrix3d C = b.mean.nav.C_n_b();
    correct(b, legInnovation(b.mean, sight, step % b.mean.landmark_count, kArm),
            C * sight.covariance * C.transpose(), 1e9);
  }
  EXPECT_LE((b.covariance - b.covariance.transpose()).norm(), 1e-12 * b.covariance.norm());
  // Scaled to correlations: P spans fifteen orders.
  const Eigen::VectorXd root = b.covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = root.asDiagonal() * b.covariance * root.asDiagonal();
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled).eigenvalues().minCoeff(), 0.0);
}

TEST(LegSensorErrors, ThePapersPolynomialIsCorrectedExactly) {
  // theta = a1 m^2 + a2 m + a3 in degrees, about m = 90: yaw, scale and curvature of ours.
  const double a1 = 4e-5;
  const double a2 = 0.9925;
  const double a3 = 0.0531;
  LegSensor sensor;
  sensor.yaw = radians(a1 * 8100.0 + a2 * 90.0 + a3 - 90.0);
  sensor.angle_scale = 2.0 * a1 * 90.0 + a2 - 1.0;
  sensor.angle_curve = degrees(a1);
  sensor.scale = 6e-4;
  sensor.offset = 0.035;
  for (double m = 1.0; m < 180.0; m += 7.0) {
    const double truth = radians(a1 * m * m + a2 * m + a3);
    const double range = (1.0 + sensor.scale) * 8.0 + sensor.offset;
    const Eigen::Vector3d seen(range * std::cos(radians(m)), range * std::sin(radians(m)), 0.1);
    const Eigen::Vector3d leg = corrected(seen, sensor).p;
    EXPECT_NEAR(leg.x(), 8.0 * std::cos(truth), 1e-12);
    EXPECT_NEAR(leg.y(), 8.0 * std::sin(truth), 1e-12);
  }
}

TEST(LegSensorErrors, DerivativesAreThoseOfDifferences) {
  const LegSensor sensor{0.01, 0.002, 5e-4, 0.03, -0.004, 0.002};
  for (const Eigen::Vector3d& seen : {Eigen::Vector3d(-9, 4, 0.1), Eigen::Vector3d(5, 4.5, -0.2)}) {
    const auto J = corrected(seen, sensor).by_errors;
    for (int i = 0; i < LegSensor::kDof; ++i) {
      LegSensorTangent d = LegSensorTangent::Zero();
      d[i] = 1e-6;
      const Eigen::Vector3d difference =
          (corrected(seen, plus(sensor, d)).p - corrected(seen, plus(sensor, -d)).p) / 2e-6;
      EXPECT_LT((J.col(i) - difference).norm(), 1e-7) << i;
    }
  }
}

}  // namespace pos::estimation
