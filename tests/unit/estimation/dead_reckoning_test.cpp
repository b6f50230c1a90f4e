#include "pos/estimation/dead_reckoning.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/numeric_jacobian.hpp"
#include "support/small_run.hpp"

namespace pos::estimation {
namespace {

using pos::testing::runStamp;
using pos::testing::smallRun;
using pos::testing::truthAt;

DeadReckoningConfig atTruth() {
  DeadReckoningConfig config;
  config.start.pose = truthAt(0.0);
  return config;
}

}  // namespace

TEST(DeadReckoning, NoiseFreeIncrementsReproduceThePathExactly) {
  DeadReckoning estimator(atTruth());
  for (const Measurement& m : smallRun({.distance_noise = 0.0, .lateral_noise = 0.0, .yaw_noise = 0.0})) {
    if (estimator.ingest(m).verdict != Verdict::Applied) continue;
    const Pose2 truth = truthAt(seconds(m.stamp - runStamp(0.0)));
    EXPECT_LT(minus(estimator.estimateAt(m.stamp)->T_map_body.planar(), truth).norm(), 1e-9);
  }
}

TEST(DeadReckoning, RangesAreUnsupportedAndSaidSo) {
  DeadReckoning estimator(atTruth());
  BeaconRange range;
  range.range = 3.0;
  const IngestReport report = estimator.ingest({runStamp(1.0), "uwb", range});
  EXPECT_EQ(report.verdict, Verdict::Unsupported);
  EXPECT_FALSE(report.reason.empty());
}

TEST(DeadReckoning, CovarianceFollowsTheNumericJacobians) {
  const Belief<Pose2> previous{{1.0, 2.0, 0.8}, Vector<3>(0.04, 0.09, 0.01).asDiagonal()};
  const Pose2 increment{0.7, -0.1, 0.3};
  const Matrix<3, 3> Q = Vector<3>(0.01, 0.02, 0.003).asDiagonal();
  const Pose2 mean = previous.mean * increment;
  const Eigen::MatrixXd F = testing::numericJacobian(
      previous.mean, 3, [&](const Pose2& at) -> Eigen::VectorXd { return minus(at * increment, mean); });
  const Eigen::MatrixXd G = testing::numericJacobian(
      increment, 3, [&](const Pose2& at) -> Eigen::VectorXd { return minus(previous.mean * at, mean); });
  const Eigen::MatrixXd expected = F * previous.covariance * F.transpose() + G * Q * G.transpose();
  EXPECT_TRUE(compounded(previous, increment, Q).covariance.isApprox(expected, 1e-6));
}

TEST(DeadReckoning, ALogsOwnCovarianceIsUsed) {
  DeadReckoning estimator(atTruth());
  (void)estimator.ingest({runStamp(0.0), "wheels", OdometryIncrement{}});
  OdometryIncrement sure;
  sure.increment.x = 1.0;
  sure.covariance = 1e-12 * Matrix<3, 3>::Identity();
  const auto before = estimator.estimateAt(runStamp(0.0))->planarCovariance();
  (void)estimator.ingest({runStamp(1.0), "wheels", sure});
  EXPECT_NEAR(estimator.estimateAt(runStamp(1.0))->planarCovariance()(2, 2), before(2, 2), 1e-9);
  EXPECT_NEAR(estimator.diagnostics().front().value, 1.0, 1e-12);
}

}  // namespace pos::estimation
