#include "pos/filters/imm.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "pos/core/pose3.hpp"
#include "pos/core/random.hpp"
#include "pos/filters/ekf.hpp"
#include "pos/filters/fuzzy.hpp"

namespace pos::filters {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Matrix<2, 2> kPi{{0.95, 0.05}, {0.05, 0.95}};

template <int N>
Matrix<N, N> somePositiveMatrix(RandomStream& random) {
  Matrix<N, N> A;
  for (double& a : A.reshaped()) a = random.normal();
  return A * A.transpose() + 0.1 * Matrix<N, N>::Identity();
}

Pose3 somePose(RandomStream& random, double spread) {
  Vector<6> d;
  for (double& x : d) x = random.normal(0.0, spread);
  return plus(Pose3{{1.0, 2.0, 3.0}, Eigen::Quaterniond(Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ()))},
              d);
}

Modes<Pose3, 2> someModes(RandomStream& random, double spread) {
  const Pose3 first = somePose(random, spread);
  const Matrix<6, 6> P_first = somePositiveMatrix<6>(random);
  const Pose3 second = somePose(random, spread);
  return {Belief<Pose3>{first, P_first}, Belief<Pose3>{second, somePositiveMatrix<6>(random)}};
}

/// A vector state, for which mixtures have a closed form.
struct Point {
  static constexpr int kDof = 3;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
};
Point plus(const Point& x, const Vector<3>& d) {
  return {x.p + d};
}
Vector<3> minus(const Point& to, const Point& from) {
  return to.p - from.p;
}

}  // namespace

TEST(Imm, MixtureOfVectorsHasTheTextbookMoments) {
  RandomStream random(1, 0);
  Modes<Point, 3> modes;
  for (auto& mode : modes) {
    for (double& x : mode.mean.p) x = random.normal();
    mode.covariance = somePositiveMatrix<3>(random);
  }
  const Vector<3> w(0.2, 0.5, 0.3);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) mean += w[i] * modes[static_cast<std::size_t>(i)].mean.p;
  Matrix<3, 3> P = Matrix<3, 3>::Zero();
  for (int i = 0; i < 3; ++i) {
    const auto& mode = modes[static_cast<std::size_t>(i)];
    P += w[i] * (mode.covariance + (mode.mean.p - mean) * (mode.mean.p - mean).transpose());
  }
  const Belief<Point> got = combined<Point, 3>(modes, w);
  EXPECT_TRUE(got.mean.p.isApprox(mean, 1e-12));
  EXPECT_TRUE(got.covariance.isApprox(P, 1e-7));  // the transport is numeric here
}

TEST(Imm, IdenticalFiltersCombineToEachOfThem) {
  RandomStream random(2, 0);
  for (int trial = 0; trial < 20; ++trial) {
    Modes<Pose3, 2> modes = someModes(random, 0.5);
    modes[1] = modes[0];
    const double share = random.uniform();
    for (const Belief<Pose3>& got :
         {combined<Pose3, 2>(modes, {share, 1.0 - share}),
          mixed<Pose3, 2>(modes, mixingWeights<2>(kPi, {share, 1.0 - share}))[1]}) {
      EXPECT_LT(minus(got.mean, modes[0].mean).norm(), 1e-12);
      EXPECT_TRUE(got.covariance.isApprox(modes[0].covariance, 1e-6));
    }
  }
}

TEST(Imm, EqualMeansAddNoSpread) {
  RandomStream random(3, 0);
  Modes<Point, 2> modes;
  modes[0].covariance = somePositiveMatrix<3>(random);
  modes[1].covariance = somePositiveMatrix<3>(random);
  const auto got = combined<Point, 2>(modes, {0.3, 0.7});
  EXPECT_TRUE(got.covariance.isApprox(0.3 * modes[0].covariance + 0.7 * modes[1].covariance, 1e-7));
}

TEST(Imm, MeanDoesNotDependOnWhereTheIterationStarts) {
  RandomStream random(4, 0);
  for (int trial = 0; trial < 20; ++trial) {
    const Modes<Pose3, 2> modes = someModes(random, 0.3);
    const Vector<2> w(0.35, 0.65);
    const auto from_first = merged<Pose3, 2>(modes, w, modes[0].mean);
    const auto from_second = merged<Pose3, 2>(modes, w, modes[1].mean);
    EXPECT_LT(minus(from_first.mean, from_second.mean).norm(), 1e-9);
    EXPECT_TRUE(from_first.covariance.isApprox(from_second.covariance, 1e-6));
  }
}

TEST(Imm, AQuaternionAndItsNegativeAreTheSameAttitude) {
  RandomStream random(5, 0);
  Modes<Pose3, 2> modes = someModes(random, 0.4);
  const auto before = combined<Pose3, 2>(modes, {0.4, 0.6});
  modes[1].mean.rotation.coeffs() *= -1.0;
  const auto after = combined<Pose3, 2>(modes, {0.4, 0.6});
  EXPECT_LT(minus(before.mean, after.mean).norm(), 1e-12);
  EXPECT_TRUE(before.covariance.isApprox(after.covariance, 1e-9));
}

TEST(Imm, OppositeAttitudesGiveFiniteNumbers) {
  Modes<Pose3, 2> modes;
  for (auto& mode : modes) mode.covariance = 0.01 * Matrix<6, 6>::Identity();
  modes[1].mean.rotation = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ());
  for (const double share : {0.0, 1e-3, 0.5, 0.999}) {
    const auto got = combined<Pose3, 2>(modes, {share, 1.0 - share});
    EXPECT_TRUE(got.mean.rotation.coeffs().allFinite());
    EXPECT_TRUE(got.covariance.allFinite());
    const Eigen::SelfAdjointEigenSolver<Matrix<6, 6>> eigen(got.covariance);
    EXPECT_GT(eigen.eigenvalues().minCoeff(), 0.0);
  }
}

TEST(Imm, WithoutTransitionsNothingIsMixed) {
  RandomStream random(6, 0);
  const Modes<Pose3, 2> modes = someModes(random, 0.5);
  const auto next = mixed<Pose3, 2>(modes, mixingWeights<2>(Matrix<2, 2>::Identity(), {0.3, 0.7}));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(minus(next[i].mean, modes[i].mean).norm(), 0.0);
    EXPECT_EQ(next[i].covariance, modes[i].covariance);
  }
}

TEST(Imm, WithoutEvidenceProbabilitiesRunToTheStationaryOnes) {
  Vector<2> mu(0.98, 0.02);
  for (int k = 0; k < 200; ++k) mu = bayes<2>(predictedModes<2>(kPi, mu), {-3.0, -3.0});
  EXPECT_NEAR(mu[0], 0.5, 1e-9);
  EXPECT_NEAR(mu.sum(), 1.0, 1e-12);
}

TEST(Imm, ProbabilitiesStayInBoundsWhateverTheLikelihoods) {
  constexpr double kFloor = 1e-3;
  const double wild[] = {0.0,    -1e5,       -1e300,
                         1e300,  -kInfinity, kInfinity,
                         -700.0, 12.0,       std::numeric_limits<double>::quiet_NaN()};
  for (const FuzzyVariant variant :
       {FuzzyVariant::Paper, FuzzyVariant::PaperSym, FuzzyVariant::Centroid, FuzzyVariant::Incremental}) {
    const FuzzyController controller({.variant = variant});
    Vector<2> mu(0.98, 0.02);
    for (const double a : wild) {
      for (const double b : wild) {
        const Vector<2> hat = bayes<2>(predictedModes<2>(kPi, mu), {a, b});
        for (const Vector<2>& next : {hat, controller.controlled<2>(mu, hat)}) {
          const Vector<2> kept = floored<2>(next, kFloor);
          ASSERT_NEAR(kept.sum(), 1.0, 1e-12) << a << " " << b;
          ASSERT_GE(kept.minCoeff(), kFloor - 1e-15) << a << " " << b;
          ASSERT_LE(kept.maxCoeff(), 1.0 - kFloor + 1e-15);
        }
        mu = floored<2>(controller.controlled<2>(mu, hat), kFloor);
      }
    }
  }
}

TEST(Imm, FloorHoldsForThreeModesAndLeavesGoodProbabilitiesAlone) {
  const Vector<3> low = floored<3>({1.0, 0.0, 0.0}, 0.01);
  EXPECT_NEAR(low.sum(), 1.0, 1e-12);
  EXPECT_NEAR(low[1], 0.01, 1e-15);
  EXPECT_TRUE(floored<3>({0.5, 0.3, 0.2}, 0.01).isApprox(Vector<3>(0.5, 0.3, 0.2), 1e-12));
}

TEST(Imm, ACommonFactorOnAllLikelihoodsChangesNothing) {
  const Vector<2> c(0.3, 0.7);
  const Vector<2> lnL(-4.0, -2.5);
  EXPECT_TRUE(bayes<2>(c, lnL).isApprox(bayes<2>(c, lnL + Vector<2>::Constant(1e4)), 1e-10));
}

TEST(Imm, RelabelledModesSwapTheirProbabilities) {
  const Matrix<2, 2> Pi{{0.9, 0.1}, {0.03, 0.97}};
  const Matrix<2, 2> swapped{{0.97, 0.03}, {0.1, 0.9}};
  const Vector<2> mu(0.8, 0.2);
  const Vector<2> lnL(-3.0, -1.0);
  const Vector<2> one = bayes<2>(predictedModes<2>(Pi, mu), lnL);
  const Vector<2> other = bayes<2>(predictedModes<2>(swapped, mu.reverse()), lnL.reverse());
  EXPECT_TRUE(one.reverse().isApprox(other, 1e-12));
  EXPECT_TRUE(mixingWeights<2>(Pi, mu).reverse().isApprox(mixingWeights<2>(swapped, mu.reverse()), 1e-12));
}

TEST(Imm, NormalisedLikelihoodDoesNotCountAnchorsAndKeepsDecisionsWhenUnitsChange) {
  const Evidence one{.d2 = 1.2, .log_det_S = -4.0, .dof = 1};
  const Evidence six{.d2 = 7.2, .log_det_S = -24.0, .dof = 6};  // six times the same reading
  EXPECT_NEAR(logLikelihood(LikelihoodForm::Normalised, one), logLikelihood(LikelihoodForm::Normalised, six),
              1e-12);
  EXPECT_GT(std::abs(logLikelihood(LikelihoodForm::Raw, one) - logLikelihood(LikelihoodForm::Raw, six)), 1.0);
  const double shift = std::log(1e6);  // of ln det S per number, from m^2 to mm^2
  const Evidence g{.d2 = 2.0, .log_det_S = -1.0, .dof = 3};
  const Evidence u{.d2 = 4.0, .log_det_S = -6.0, .dof = 6};
  const auto difference = [](const Evidence& a, const Evidence& b) {
    return logLikelihood(LikelihoodForm::Normalised, a) - logLikelihood(LikelihoodForm::Normalised, b);
  };
  EXPECT_NEAR(difference(g, u),
              difference({g.d2, g.log_det_S + 3 * shift, 3}, {u.d2, u.log_det_S + 6 * shift, 6}), 1e-9);
}

TEST(Imm, OneWildReadingDoesNotRuleAModeOut) {
  const Evidence wild{.d2 = 1e6, .log_det_S = 0.0, .dof = 3};
  const double lnL = logLikelihood(LikelihoodForm::Normalised, wild, 21.1);
  EXPECT_GT(bayes<2>({0.5, 0.5}, {lnL, -4.0})[0], 1e-5);
}

TEST(Imm, OneModeIsThePlainFilter) {
  RandomStream random(7, 0);
  Belief<Point> plain{{}, somePositiveMatrix<3>(random)};
  Modes<Point, 1> modes{plain};
  Vector<1> mu(1.0);
  for (int k = 0; k < 20; ++k) {
    Innovation<Point, 1> reading;
    reading.nu[0] = random.normal();
    for (double& h : reading.H.reshaped()) h = random.normal();
    const Matrix<1, 1> R(0.25);
    modes = mixed<Point, 1>(modes, mixingWeights<1>(Matrix<1, 1>(1.0), mu));
    correct(plain, reading, R);
    correct(modes[0], reading, R);
    mu = bayes<1>(predictedModes<1>(Matrix<1, 1>(1.0), mu), Vector<1>(-1.0));
  }
  const auto got = combined<Point, 1>(modes, mu);
  EXPECT_TRUE(got.mean.p.isApprox(plain.mean.p, 1e-12));
  EXPECT_TRUE(got.covariance.isApprox(plain.covariance, 1e-6));
}

}  // namespace pos::filters
