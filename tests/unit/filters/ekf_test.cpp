#include "pos/filters/ekf.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "pos/core/pose2.hpp"
#include "pos/core/random.hpp"

namespace pos::filters {
namespace {

Matrix<3, 3> somePositiveMatrix(RandomStream& random) {
  Matrix<3, 3> A;
  for (double& a : A.reshaped()) a = random.normal();
  return A * A.transpose() + 0.1 * Matrix<3, 3>::Identity();
}

Innovation<Pose2, 2> someInnovation(RandomStream& random) {
  Innovation<Pose2, 2> innovation;
  for (double& h : innovation.H.reshaped()) h = random.normal();
  innovation.nu = {random.normal(), random.normal()};
  return innovation;
}

}  // namespace

TEST(Ekf, CorrectionEqualsTheTextbookInformationForm) {
  RandomStream random(3, 0);
  for (int trial = 0; trial < 50; ++trial) {
    Belief<Pose2> belief{{1.0, -2.0, 0.3}, somePositiveMatrix(random)};
    const Matrix<3, 3> P = belief.covariance;
    const auto innovation = someInnovation(random);
    const Matrix<2, 2> R = Vector<2>(0.3, 0.7).asDiagonal();
    // Information form, an independent route to the same posterior: P+ = (P^-1 + H' R^-1 H)^-1, d = P+ H'
    // R^-1 nu.
    const Matrix<3, 3> expected =
        (P.inverse() + innovation.H.transpose() * R.inverse() * innovation.H).inverse();
    const Vector<3> moved = expected * innovation.H.transpose() * R.inverse() * innovation.nu;
    const Pose2 before = belief.mean;
    const auto correction = correct(belief, innovation, R);
    EXPECT_EQ(correction.verdict, Verdict::Applied);
    EXPECT_TRUE(belief.covariance.isApprox(expected, 1e-9));
    EXPECT_TRUE(minus(belief.mean, before).isApprox(minus(plus(before, moved), before), 1e-9));
    const Matrix<2, 2> S = innovation.H * P * innovation.H.transpose() + R;
    EXPECT_NEAR(correction.nis, innovation.nu.dot(S.inverse() * innovation.nu), 1e-9);
  }
}

TEST(Ekf, GatedMeasurementLeavesBeliefUntouched) {
  RandomStream random(4, 0);
  Belief<Pose2> belief{{1.0, -2.0, 0.3}, somePositiveMatrix(random)};
  const Belief<Pose2> before = belief;
  auto innovation = someInnovation(random);
  innovation.nu *= 1e3;
  const auto correction = correct(belief, innovation, Matrix<2, 2>(Matrix<2, 2>::Identity()), Gate{9.21});
  EXPECT_EQ(correction.verdict, Verdict::Gated);
  EXPECT_GT(correction.nis, 9.21);
  EXPECT_EQ(belief.covariance, before.covariance);
  EXPECT_EQ(minus(belief.mean, before.mean).norm(), 0.0);
}

TEST(Ekf, DegenerateCovarianceIsReportedAndChangesNothing) {
  Belief<Pose2> belief{{0.0, 0.0, 0.0}, Matrix<3, 3>::Zero()};
  Innovation<Pose2, 1> innovation{Vector<1>(0.5), TangentRows<Pose2, 1>::Zero()};
  EXPECT_EQ(correct(belief, innovation, Matrix<1, 1>(Matrix<1, 1>::Zero())).verdict, Verdict::Degenerate);
  innovation.nu[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(correct(belief, innovation, Matrix<1, 1>(Matrix<1, 1>::Identity())).verdict, Verdict::Degenerate);
  EXPECT_EQ(belief.covariance.norm(), 0.0);
}

TEST(Ekf, ScalarSequentialCorrectionsEqualOneJointCorrection) {
  RandomStream random(5, 0);
  Belief<Pose2> joint{{0.0, 0.0, 0.0}, somePositiveMatrix(random)};
  Belief<Pose2> sequential = joint;
  const auto both = someInnovation(random);
  const Vector<2> variances(0.2, 0.5);
  correct(joint, both, Matrix<2, 2>(variances.asDiagonal()));
  for (int row = 0; row < 2; ++row) {
    Innovation<Pose2, 1> one{both.nu.segment<1>(row), both.H.row(row)};
    one.nu -= one.H * minus(sequential.mean, Pose2{});
    correct(sequential, one, Matrix<1, 1>(variances[row]));
  }
  EXPECT_TRUE(sequential.covariance.isApprox(joint.covariance, 1e-9));
  EXPECT_LT(minus(sequential.mean, joint.mean).norm(), 1e-9);
}

TEST(Ekf, CovarianceStaysPositiveThroughManyPreciseCorrections) {
  RandomStream random(6, 0);
  Belief<Pose2> belief{{0.0, 0.0, 0.0}, 1e6 * Matrix<3, 3>::Identity()};
  for (int i = 0; i < 2000; ++i) {
    auto innovation = someInnovation(random);
    innovation.nu *= 1e-3;
    correct(belief, innovation, Matrix<2, 2>(1e-6 * Matrix<2, 2>::Identity()));
  }
  const Eigen::SelfAdjointEigenSolver<Matrix<3, 3>> eigen(belief.covariance);
  EXPECT_GE(eigen.eigenvalues().minCoeff(), 0.0);
  EXPECT_TRUE(belief.covariance.isApprox(belief.covariance.transpose(), 0.0));
}

TEST(Ekf, PredictionAddsProcessNoiseThroughTheJacobian) {
  Belief<Pose2> belief{{0.0, 0.0, 0.0}, Vector<3>(0.1, 0.2, 0.3).asDiagonal()};
  Step<Pose2> step{{2.0, 0.0, 0.0}, Matrix<3, 3>::Identity(), Matrix<3, 3>::Zero()};
  step.F(1, 2) = 2.0;
  step.Qd(0, 0) = 0.05;
  predict(belief, step);
  EXPECT_DOUBLE_EQ(belief.mean.x, 2.0);
  EXPECT_NEAR(belief.covariance(0, 0), 0.15, 1e-12);
  EXPECT_NEAR(belief.covariance(1, 1), 0.2 + 4.0 * 0.3, 1e-12);
  EXPECT_NEAR(belief.covariance(1, 2), 2.0 * 0.3, 1e-12);
}

}  // namespace pos::filters
