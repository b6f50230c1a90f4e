#include "pos/ins/eskf.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "pos/core/pose3.hpp"
#include "pos/core/random.hpp"
#include "support/eskf_samples.hpp"
#include "support/numeric_jacobian.hpp"

namespace pos::ins {
namespace {

constexpr double kGravity = 9.80665;

using testing::overSigmas;
using testing::someCovariance;
using testing::someSample;
using testing::someState;

TEST(Eskf, TransitionIsTheDerivativeOfTheStep) {
  RandomStream random(1, 0);
  for (const double dt : {0.001, 0.005, 0.01, 0.05}) {
    for (int i = 0; i < 10; ++i) {
      const EskfState x = someState(random);
      const ImuIncrement sample = someSample(random, dt);
      const EskfStep step = stepped(x, sample, kGravity);
      const Eigen::MatrixXd numeric = testing::numericJacobian(x, 15, [&](const EskfState& y) {
        return Eigen::VectorXd(minus(steppedMean(y, sample, kGravity), step.next));
      });
      EXPECT_LT((step.F.dense() - numeric).cwiseAbs().maxCoeff(), 1e-9 + 4.0 * std::pow(dt, 5)) << dt;
    }
  }
}

TEST(Eskf, PrintedTransitionMissesWhatTheFullOneHolds) {
  // The paper's F: position row [I, I dt, 0, 0, 0], -I dt for the gyro bias.
  RandomStream random(2, 0);
  const EskfState x = someState(random);
  const ImuIncrement sample = someSample(random, 0.1);
  Matrix<15, 15> F = stepped(x, sample, kGravity).F.dense();
  const Matrix<15, 15> full = F;
  F.block<3, 9>(0, 6).setZero();
  F.block<3, 3>(3, 12).setZero();
  F.block<3, 3>(6, 12) = -0.1 * Eigen::Matrix3d::Identity();
  EXPECT_GT((F - full).cwiseAbs().maxCoeff(), 0.02);
}

TEST(Eskf, BlocksCarryACovarianceAsTheFullMatricesDo) {
  RandomStream random(3, 0);
  const EskfProcess process;
  for (const double dt : {0.001, 0.01, 0.1}) {
    for (int i = 0; i < 20; ++i) {
      const EskfStep step = stepped(someState(random), someSample(random, dt), kGravity);
      const Matrix<15, 15> before = someCovariance(random);
      const Vector<15> Q = processNoise(process, dt);
      Matrix<15, 15> P = before;
      carry(P, step.F, Q);
      const Matrix<15, 15> dense = carriedDense(before, step.F, Q);
      EXPECT_LT(overSigmas(P - dense, dense).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_EQ(P, P.transpose());
    }
  }
}

TEST(Eskf, OtherColumnsAreCarriedLikeTheStatesOwn) {
  RandomStream random(4, 0);
  const EskfTransition F = stepped(someState(random), someSample(random, 0.01), kGravity).F;
  const Matrix<15, 15> X = someCovariance(random);
  EXPECT_LT((F.carried(X.leftCols(4)) - F.dense() * X.leftCols(4)).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Eskf, ConstantForceAndTurnRateAreIntegratedExactly) {
  // Level circle: 2 m/s, 0.1 rad/s; the whole of it in ever so many samples.
  for (const int rate : {100, 1000}) {
    EskfState x;
    x.v_map = {2.0, 0.0, 0.0};
    const double dt = 1.0 / rate;
    const ImuIncrement sample{dt * Eigen::Vector3d(0, 0, 0.1), dt * Eigen::Vector3d(0, 0.2, kGravity), dt};
    const int samples = 60 * rate;
    for (int i = 0; i < samples; ++i) x = steppedMean(x, sample, kGravity);
    const Eigen::Vector3d truth(20.0 * std::sin(6.0), 20.0 * (1.0 - std::cos(6.0)), 0.0);
    EXPECT_LT((x.p_map - truth).norm(), 0.1 * dt * dt) << rate;  // the trapezoid's position
    EXPECT_LT((x.v_map - Eigen::Vector3d(2.0 * std::cos(6.0), 2.0 * std::sin(6.0), 0.0)).norm(), 1e-9);
    EXPECT_NEAR((Pose3{{}, x.q_map_body}).yaw(), 6.0 - 2.0 * M_PI, 1e-9);
  }
}

TEST(Eskf, NoTimeChangesNothing) {
  RandomStream random(5, 0);
  const EskfState x = someState(random);
  Belief<EskfState> belief(x, someCovariance(random));
  const Matrix<15, 15> P = belief.covariance;
  propagate(belief, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0}, {});
  EXPECT_EQ(belief.covariance, P);
  EXPECT_EQ(belief.mean.p_map, x.p_map);
  EXPECT_EQ(stepped(x, {}, kGravity).F.dense(), (Matrix<15, 15>::Identity()));
}

TEST(Eskf, RateOfTheUnitDoesNotChangeTheCovariance) {
  const Eigen::Vector3d rate(0.05, -0.1, 0.3);
  const Eigen::Vector3d force(0.4, 0.2, kGravity);
  const auto after = [&](int hertz) {
    Belief<EskfState> belief(EskfState{}, Matrix<15, 15>::Zero());
    const double dt = 1.0 / hertz;
    for (int i = 0; i < hertz; ++i) propagate(belief, {dt * rate, dt * force, dt}, {});
    return belief.covariance;
  };
  const Matrix<15, 15> reference = after(1000);
  for (const int hertz : {50, 100, 200}) {
    const Vector<15> share = after(hertz).diagonal().cwiseQuotient(reference.diagonal());
    EXPECT_LT((share.array() - 1.0).abs().maxCoeff(), 0.02) << hertz;
  }
}

TEST(Eskf, SignOfTheQuaternionMeansNothing) {
  RandomStream random(6, 0);
  const EskfState x = someState(random);
  EskfState y = x;
  y.q_map_body.coeffs() *= -1.0;
  const ImuIncrement sample = someSample(random, 0.01);
  EXPECT_LT(minus(x, y).norm(), 1e-15);
  const EskfStep a = stepped(x, sample, kGravity);
  const EskfStep b = stepped(y, sample, kGravity);
  EXPECT_LT(minus(a.next, b.next).norm(), 1e-15);
  EXPECT_EQ(a.F.dense(), b.F.dense());
}

TEST(Eskf, QuaternionStaysAUnitAndCovariancePositiveOverAMillionSteps) {
  Belief<EskfState> belief;
  belief.covariance = 1e-4 * Matrix<15, 15>::Identity();
  RandomStream random(7, 0);
  std::vector<ImuIncrement> samples;
  for (int i = 0; i < 64; ++i) samples.push_back(someSample(random, 0.001));
  for (int i = 0; i < 1000000; ++i) {
    const EskfStep step = stepped(belief.mean, samples[static_cast<std::size_t>(i) % 64], kGravity);
    belief.mean.q_map_body = step.next.q_map_body;
    // Without readings the variances grow without bound; a leak keeps them where a filter has them.
    carry(belief.covariance, step.F, processNoise({}, 0.001));
    belief.covariance *= 0.99;
    if (i % 1000 == 999) {
      ASSERT_EQ(belief.covariance, belief.covariance.transpose());
      const Matrix<15, 15> scaled = overSigmas(belief.covariance, belief.covariance);
      ASSERT_GT((Eigen::SelfAdjointEigenSolver<Matrix<15, 15>>(scaled).eigenvalues().minCoeff()), 0.0) << i;
    }
  }
  EXPECT_NEAR(belief.mean.q_map_body.norm(), 1.0, 1e-12);
}

}  // namespace
}  // namespace pos::ins
