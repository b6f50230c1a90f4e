#include "pos/estimation/eskf_models.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <vector>

#include "pos/estimation/inertial_filters.hpp"
#include "pos/estimation/pseudorange.hpp"
#include "support/eskf_samples.hpp"
#include "support/numeric_jacobian.hpp"

namespace pos::estimation {
namespace {

using pos::testing::numericJacobian;
using pos::testing::overSigmas;
using pos::testing::someCovariance;
using pos::testing::someSample;
using pos::testing::someState;
using pos::testing::triple;

constexpr int kStates = 5;
constexpr double kSame = 1e-8;  // of numbers of order 1 by central differences

/// nu = reading - h, so that dh/dx = -d nu/dx.
template <class Model>
void expectDerivative(const Model& model, std::uint64_t seed) {
  RandomStream random(seed, 0);
  for (int i = 0; i < kStates; ++i) {
    const EskfState x = someState(random);
    const auto told = model(x);
    const Eigen::MatrixXd numeric =
        numericJacobian(x, 15, [&](const EskfState& y) { return Eigen::VectorXd(-model(y).nu); });
    EXPECT_LT((told.H - numeric).cwiseAbs().maxCoeff(), kSame);
    EXPECT_GT(told.H.norm(), 0.1);
  }
}

const Eigen::Vector3d kLever(0.6, -0.3, 0.5);
const Eigen::Vector3d kGyro(0.1, -0.2, 0.4);

TEST(EskfModels, EveryJacobianIsTheDerivative) {
  const Eigen::Vector3d anchor(4, -7, 3);
  expectDerivative(
      [&](const EskfState& x) {
        const RangeSeen seen = seenRange(x, kLever, anchor, 5.0);
        return filters::Innovation<EskfState, 1>{Vector<1>(seen.row.nu), seen.row.dense()};
      },
      1);
  expectDerivative([&](const EskfState& x) { return pointFix(x, {1, 2, 3}, kLever); }, 2);
  expectDerivative([&](const EskfState& x) { return pointVelocity(x, {1, 2, 3}, kLever, kGyro); }, 3);
  expectDerivative([&](const EskfState& x) { return pointHeight(x, 2.0, kLever); }, 4);
  expectDerivative([&](const EskfState& x) { return atRest(x); }, 5);
  expectDerivative([&](const EskfState& x) { return notTurning(x, kGyro); }, 6);
  expectDerivative([&](const EskfState& x) { return noSideSlip(x, kLever, kGyro); }, 7);
  expectDerivative([&](const EskfState& x) { return wheelSpeed(x, 1.0, kLever, kGyro); }, 8);
  expectDerivative([&](const EskfState& x) { return heading(x, 0.3); }, 9);
}

TEST(EskfModels, ReadingsOfTheStateItselfSurpriseNobody) {
  RandomStream random(11, 0);
  const EskfState x = someState(random);
  const Eigen::Matrix3d R = x.R_map_body();
  const Eigen::Vector3d swing = R * (kGyro - x.gyro_bias).cross(kLever);
  EXPECT_LT(pointFix(x, x.p_map + R * kLever, kLever).nu.norm(), 1e-14);
  EXPECT_LT(pointVelocity(x, x.v_map + swing, kLever, kGyro).nu.norm(), 1e-14);
  const double forward = (R.transpose() * (x.v_map + swing)).x();
  EXPECT_LT(wheelSpeed(x, forward, kLever, kGyro).nu.norm(), 1e-14);
}

TEST(Pseudorange, JacobianAndTransitionAreTheDerivatives) {
  RandomStream random(12, 0);
  const Eigen::Vector3d satellite(1.2e3, -2.5e3, 2.0e3);  // near enough for central differences
  for (int i = 0; i < kStates; ++i) {
    ClockedState x{someState(random), 30.0, 0.5};
    const auto told = pseudorange(x, 3500.0, satellite, kLever);
    const Eigen::MatrixXd numeric = numericJacobian(x, 17, [&](const ClockedState& y) {
      return Eigen::VectorXd(-pseudorange(y, 3500.0, satellite, kLever).nu);
    });
    EXPECT_LT((told.H - numeric).cwiseAbs().maxCoeff(), 1e-6);
    const ins::ImuIncrement sample = someSample(random, 0.01);
    const auto step = stepped(x, sample, {}, {});
    const Eigen::MatrixXd F = numericJacobian(x, 17, [&](const ClockedState& y) {
      return Eigen::VectorXd(minus(stepped(y, sample, {}, {}).next, step.next));
    });
    EXPECT_LT((step.F - F).cwiseAbs().maxCoeff(), 2e-8);
  }
}

TEST(Pseudorange, FourSatellitesFindPlaceAndClock) {
  ClockedState truth;
  truth.inertial.p_map = {3, -2, 1};
  truth.clock = 120.0;
  Belief<ClockedState> belief;
  belief.covariance = Matrix<17, 17>::Identity();
  belief.covariance.diagonal().head<3>().setConstant(1e4);
  belief.covariance(ClockedState::kClock, ClockedState::kClock) = 1e6;
  const Eigen::Vector3d satellites[] = {
      {2e7, 1e6, 5e6}, {-1e7, 1.5e7, 9e6}, {-8e6, -1.6e7, 8e6}, {1e6, 2e6, 2.2e7}};
  for (int round = 0; round < 2; ++round) {
    for (const Eigen::Vector3d& s : satellites) {
      const double range = (truth.inertial.p_map - s).norm() + truth.clock;
      filters::correct(belief, pseudorange(belief.mean, range, s, Eigen::Vector3d::Zero()),
                       Matrix<1, 1>(1e-4));
    }
  }
  EXPECT_LT((belief.mean.inertial.p_map - truth.inertial.p_map).norm(), 0.01);
  EXPECT_NEAR(belief.mean.clock, truth.clock, 0.01);
}

TEST(Pseudorange, EarthTurnsWhileTheSignalTravels) {
  const Eigen::Vector3d p(2e7, 1e7, 5e6);
  const Eigen::Vector3d turned = atReception(p, 0.07);
  EXPECT_NEAR(turned.norm(), p.norm(), 1e-6);
  EXPECT_NEAR((turned - p).norm(), 7.292115e-5 * 0.07 * p.head<2>().norm(), 1e-3);
  EXPECT_GT(turned.x(), p.x());  // the axes turned eastward under it
}

// ---------------------------------------------------------------- corrections

std::vector<PoseRow> rowsOf(const EskfState& x) {
  std::vector<PoseRow> rows;
  for (const Eigen::Vector3d& anchor : {Eigen::Vector3d(5, 4, 3), {-6, 4, 2}, {5, -7, 2.5}, {-4, -5, 3}})
    rows.push_back(seenRange(x, kLever, anchor, 6.5).row);
  return rows;
}

TEST(SequentialCorrection, EqualsTheStackedCorrectionInAnyOrder) {
  RandomStream random(21, 0);
  const Belief<EskfState> start(someState(random), someCovariance(random));
  std::vector<PoseRow> rows = rowsOf(start.mean);
  filters::Innovation<EskfState, 4> stacked;
  for (int i = 0; i < 4; ++i) {
    stacked.nu[i] = rows[static_cast<std::size_t>(i)].nu;
    stacked.H.row(i) = rows[static_cast<std::size_t>(i)].dense();
  }
  Belief<EskfState> whole = start;
  const auto told = correctError<4>(whole, stacked, 0.09 * Matrix<4, 4>::Identity());
  ASSERT_EQ(told.verdict, Verdict::Applied);
  for (int order = 0; order < 3; ++order) {
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
    SequentialCorrection sequential(start);
    for (const PoseRow& row : rows) ASSERT_EQ(sequential.take(row, 0.09).verdict, Verdict::Applied);
    const Belief<EskfState> found = sequential.injected();
    EXPECT_LT(minus(found.mean, whole.mean).norm(), 1e-9);
    EXPECT_LT(overSigmas(found.covariance - whole.covariance, start.covariance).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_EQ(found.covariance, found.covariance.transpose());
  }
}

TEST(SequentialCorrection, ShortFormOfTheCovarianceEqualsJoseph) {
  RandomStream random(22, 0);
  const Belief<EskfState> start(someState(random), someCovariance(random));
  const PoseRow row = rowsOf(start.mean).front();
  SequentialCorrection sequential(start);
  (void)sequential.take(row, 0.04);
  const auto H = row.dense();
  const double S = (H * start.covariance * H.transpose())(0) + 0.04;
  const Vector<15> K = start.covariance * H.transpose() / S;
  const Matrix<15, 15> A = Matrix<15, 15>::Identity() - K * H;
  const Matrix<15, 15> joseph = A * start.covariance * A.transpose() + 0.04 * K * K.transpose();
  EXPECT_LT(overSigmas(sequential.covariance() - joseph, start.covariance).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((H * sequential.covariance() * H.transpose())(0), (H * start.covariance * H.transpose())(0));
}

TEST(SequentialCorrection, GatedOrBrokenRowChangesNothing) {
  RandomStream random(23, 0);
  const Belief<EskfState> start(someState(random), someCovariance(random));
  PoseRow row = rowsOf(start.mean).front();
  SequentialCorrection sequential(start);
  row.nu = 100.0;
  EXPECT_EQ(sequential.take(row, 0.04, {9.0}).verdict, Verdict::Gated);
  row.nu = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(sequential.take(row, 0.04).verdict, Verdict::Degenerate);
  EXPECT_EQ(sequential.covariance(), start.covariance);
  EXPECT_LT(minus(sequential.injected().mean, start.mean).norm(), 1e-15);
}

TEST(Filters, CovarianceStaysPositiveOverALongRunOfCorrections) {
  RandomStream random(24, 0);
  EskfFilter filter({EskfState{}, someCovariance(random)}, {});
  const ins::ImuIncrement sample{{0, 0, 1e-3}, {0, 0, 0.0980665}, 0.01};
  for (int i = 0; i < 100000; ++i) {
    filter.propagate(sample);
    const Eigen::Vector3d anchor(10.0 * std::cos(0.7 * i), 10.0 * std::sin(0.7 * i), 3.0);
    // What it expects, so that it stays where it is; only the covariance is looked at.
    const double range = (filter.mean().p_map + filter.mean().q_map_body * kLever - anchor).norm();
    (void)filter.take({kLever, anchor, 0, range}, 1e-4);
    if (i % 5000 != 0) continue;
    const Matrix<15, 15> P = filter.belief().covariance;
    ASSERT_EQ(P, P.transpose());
    ASSERT_GT((Eigen::SelfAdjointEigenSolver<Matrix<15, 15>>(overSigmas(P, P)).eigenvalues().minCoeff()),
              0.0);
  }
}

// ---------------------------------------------------------------- three filters

/// Small uncertainty: then the three are the same filter to second order.
TEST(Filters, AgreeWhereTheModelIsNearlyLinear) {
  RandomStream random(31, 0);
  const Belief<EskfState> start(someState(random), 1e-6 * someCovariance(random));
  EskfFilter eskf(start, {});
  AdditiveEkf ekf(start, {});
  ManifoldUkf ukf(start, {}, 1e-3);
  ManifoldUkf wide(start, {}, 0.5);
  const auto all = [&](const auto& act) {
    act(eskf);
    act(ekf);
    act(ukf);
    act(wide);
  };
  for (int i = 0; i < 50; ++i) {
    const ins::ImuIncrement sample = someSample(random, 0.005);
    all([&](auto& f) { f.propagate(sample); });
    const RangeLink link{kLever, triple(random, 8.0) + Eigen::Vector3d(12, 0, 0), 0, 0.0};
    RangeLink read = link;
    read.range = (eskf.mean().p_map + eskf.mean().q_map_body * kLever - link.anchor_map).norm() + 1e-4;
    all([&](auto& f) { (void)f.take(read, 1e-6); });
    const Eigen::Vector3d p = eskf.mean().p_map;
    all([&](auto& f) {
      (void)f.template correct<3>([&](const EskfState& x) { return pointFix(x, p, kLever); },
                                  Matrix<3, 3>(Matrix<3, 3>::Identity()), filters::Gate{});
    });
  }
  const Belief<EskfState> reference = eskf.belief();
  const Vector<15> sigma = reference.covariance.diagonal().cwiseSqrt();
  const auto expectSame = [&](const Belief<EskfState>& other) {
    EXPECT_LT(minus(other.mean, reference.mean).cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 0.05);
    EXPECT_LT(overSigmas(other.covariance - reference.covariance, reference.covariance).cwiseAbs().maxCoeff(),
              0.02);
  };
  expectSame(ekf.belief());
  expectSame(ukf.belief());
  expectSame(wide.belief());
}

TEST(Filters, AdditiveQuaternionHasNoUncertaintyAlongItself) {
  RandomStream random(32, 0);
  AdditiveEkf ekf({someState(random), someCovariance(random)}, {});
  for (int i = 0; i < 20; ++i) {
    ekf.propagate(someSample(random, 0.01));
    (void)ekf.take({kLever, {5, 5, 2}, 0, 7.0}, 0.09);
    const Eigen::Quaterniond q = ekf.mean().q_map_body;
    EXPECT_NEAR(q.norm(), 1.0, 1e-12);
    const Eigen::Vector4d along(q.w(), q.x(), q.y(), q.z());
    EXPECT_LT((ekf.covariance16().block<4, 4>(6, 6) * along).norm(), 1e-12);
  }
}

TEST(Filters, AnchorOffsetBecomesKnownAndGoesWithoutATrace) {
  EskfFilter filter({EskfState{}, 1e-4 * Matrix<15, 15>::Identity()}, {});
  const Matrix<15, 15> before = filter.belief().covariance;
  constexpr AnchorBiasConfig kSlow{.sigma = 0.5, .time = 100.0};
  filter.offsets().add(7, kSlow);
  filter.offsets().add(3, kSlow);
  filter.offsets().drop(7);  // before anything was learnt of it
  EXPECT_EQ(filter.belief().covariance, before);
  const Eigen::Vector3d anchor(10, 0, 0);
  for (int i = 0; i < 10; ++i) (void)filter.take({Eigen::Vector3d::Zero(), anchor, 3, 10.4}, 0.01);
  const auto offsets = filter.offsets().list();
  ASSERT_EQ(offsets.size(), 1U);
  EXPECT_EQ(offsets[0].anchor, 3);
  EXPECT_NEAR(offsets[0].mean, 0.4, 0.02);
  EXPECT_LT(offsets[0].sigma, 0.05);
  EXPECT_LT(filter.mean().p_map.norm(), 0.01);  // the offset took it, not the position
  EXPECT_NEAR(filter.expected({Eigen::Vector3d::Zero(), anchor, 3, 10.4}).nu, 0.0, 0.02);
  EXPECT_NEAR(filter.expected({Eigen::Vector3d::Zero(), anchor, 5, 10.4}).nu, 0.4, 0.02);
}

}  // namespace
}  // namespace pos::estimation
