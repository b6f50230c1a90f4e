#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "pos/estimation/range_odometry.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/small_run.hpp"

namespace pos::estimation {
namespace {

using testing::numericJacobian;
using testing::runStamp;
using testing::smallMap;
using testing::smallRun;
using testing::truthAt;

RangeOdometryConfig sureOfItself() {
  RangeOdometryConfig config;
  config.start.pose = truthAt(0.0);
  config.start.position_sigma = 1.0;
  config.start.yaw_sigma = 0.1;
  return config;
}

Measurement fixAt(double t, const Pose2& pose, double along, double across) {
  PassageFix fix{.place = "C3", .p_map = {pose.x, pose.y, 0.0}};
  const Eigen::Matrix2d R = rotation2(pose.yaw);
  fix.covariance.topLeftCorner<2, 2>() =
      R * Eigen::Vector2d(along * along, across * across).asDiagonal() * R.transpose();
  return {runStamp(t), "passage", fix};
}

Measurement withYaw(Measurement fix, double yaw, double sigma) {
  std::get<PassageFix>(fix.reading).yaw = yaw;
  std::get<PassageFix>(fix.reading).yaw_sigma = sigma;
  return fix;
}

/// An estimator that has driven on odometry alone for `duration` seconds.
void drive(RangeOdometry& estimator, double duration) {
  for (const Measurement& m : smallRun({.duration = duration})) {
    if (std::holds_alternative<OdometryIncrement>(m.reading)) (void)estimator.ingest(m);
  }
}

Pose2 poseOf(const Estimate& estimate) {
  return estimate.T_map_body.planar();
}

}  // namespace

TEST(RangeFix, PoseJacobianMatchesNumericDifferences) {
  for (const auto kind :
       {RangeOdometryConfig::Motion::Odometry, RangeOdometryConfig::Motion::ConstantVelocity}) {
    RangeOdometryConfig config;
    config.motion = kind;
    config.gyro_bias.sigma = config.wheel_scale.sigma = 0.1;
    const RangeLayout layout(config, {});
    const BodyVelocity v =
        kind == RangeOdometryConfig::Motion::Odometry ? BodyVelocity{{1.4, -0.1}, 0.3} : BodyVelocity{};
    for (const double yaw : {1e-9, 3.14159, -3.14159, 0.7, -2.2}) {
      RangeState x{RangeState::Values::Constant(layout.size(), 0.4)};
      x.values.head<3>() << 3.0, -2.0, yaw;
      const SeenPoint seen{{4.0, -1.0}, {1.5, -0.4}};
      const auto H = numericJacobian(x, layout.size(), [&](const RangeState& at) -> Eigen::VectorXd {
        return -poseInnovation(at, layout, seen, yaw + 0.1, 0.2, v).nu;  // nu = reading - prediction
      });
      const auto innovation = poseInnovation(x, layout, seen, yaw + 0.1, 0.2, v);
      EXPECT_TRUE(innovation.H.isApprox(TangentRows<RangeState, 3>(H), 1e-6)) << yaw;
    }
  }
}

TEST(RangeFix, AFixMovesTheEstimateTowardsItselfAndMakesItSurer) {
  RangeOdometry estimator(sureOfItself(), smallMap());
  drive(estimator, 5.0);
  const Estimate before = *estimator.estimateAt(runStamp(5.0));
  const IngestReport report = estimator.ingest(fixAt(5.0, truthAt(5.0), 0.1, 0.1));
  const Estimate after = *estimator.estimateAt(runStamp(5.0));
  ASSERT_EQ(report.verdict, Verdict::Applied);
  EXPECT_EQ(report.dof, 2);
  EXPECT_LT((poseOf(after).translation() - truthAt(5.0).translation()).norm(), 0.1);
  EXPECT_LT(after.covariance.trace(), 0.1 * before.covariance.trace());
}

TEST(RangeFix, AFixThatIsLooseAlongTheRoadwayMovesOnlyAcross) {
  RangeOdometryConfig config = sureOfItself();
  config.start.yaw_sigma = 1e-3;  // else heading and position are correlated, rightly
  RangeOdometry estimator(config, smallMap());
  drive(estimator, 0.1);
  const Estimate before = *estimator.estimateAt(runStamp(0.1));
  Pose2 line = poseOf(before);
  const Eigen::Matrix2d R = rotation2(line.yaw);
  const Eigen::Vector2d aside = line.translation() + R * Eigen::Vector2d(300.0, 1.0);
  line.x = aside.x();
  line.y = aside.y();
  ASSERT_EQ(estimator.ingest(fixAt(0.1, line, 1e4, 0.5)).verdict, Verdict::Applied);
  const Eigen::Vector2d moved = R.transpose() * (poseOf(*estimator.estimateAt(runStamp(0.1))).translation() -
                                                 poseOf(before).translation());
  EXPECT_NEAR(moved.y(), 0.8, 0.02);  // 1 / (1 + 0.25)
  EXPECT_NEAR(moved.x(), 0.0, 0.02);
}

TEST(RangeFix, AHeadingIsTakenTheShortWayRound) {
  RangeOdometry estimator(sureOfItself(), smallMap());
  drive(estimator, 0.1);
  const Pose2 pose = poseOf(*estimator.estimateAt(runStamp(0.1)));
  const Measurement fix = withYaw(fixAt(0.1, pose, 100.0, 100.0), pose.yaw + 0.05 - 2.0 * kPi, 0.01);
  const IngestReport report = estimator.ingest(fix);
  ASSERT_EQ(report.verdict, Verdict::Applied);
  EXPECT_EQ(report.dof, 3);
  EXPECT_NEAR(wrapAngle(poseOf(*estimator.estimateAt(runStamp(0.1))).yaw - pose.yaw), 0.05, 2e-3);
}

TEST(RangeFix, AFixFarOutsideTheGateLeavesTheEstimateUntouched) {
  RangeOdometry estimator(sureOfItself(), smallMap());
  drive(estimator, 2.0);
  const Estimate before = *estimator.estimateAt(runStamp(2.0));
  Pose2 wrong = truthAt(2.0);
  wrong.x += 50.0;
  const IngestReport report = estimator.ingest(fixAt(2.0, wrong, 0.3, 0.3));
  EXPECT_EQ(report.verdict, Verdict::Gated);
  EXPECT_GT(report.nis, 100.0);
  const Estimate after = *estimator.estimateAt(runStamp(2.0));
  EXPECT_EQ(after.covariance, before.covariance);
  EXPECT_EQ(after.T_map_body.translation, before.T_map_body.translation);
}

TEST(RangeFix, AFixNeverMakesTheEstimateLessSure) {
  RandomStream random(3, 0);
  RangeOdometry estimator(sureOfItself(), smallMap());
  for (const Measurement& m : smallRun({.duration = 20.0})) {
    (void)estimator.ingest(m);
    const double t = seconds(m.stamp - runStamp(0.0));
    const double before = estimator.estimateAt(m.stamp)->covariance.trace();
    Pose2 near = truthAt(t);
    near.x += random.normal(0.0, 0.5);
    (void)estimator.ingest(fixAt(t, near, random.uniform(0.2, 20.0), random.uniform(0.2, 2.0)));
    EXPECT_LE(estimator.estimateAt(m.stamp)->covariance.trace(), before * (1.0 + 1e-9)) << t;
  }
}

TEST(RangeFix, AHeadingWithoutSigmaIsRefusedAndSaysWhy) {
  RangeOdometry estimator(sureOfItself(), smallMap());
  drive(estimator, 1.0);
  Measurement fix = fixAt(1.0, truthAt(1.0), 0.3, 0.3);
  std::get<PassageFix>(fix.reading).yaw = 0.0;
  const IngestReport report = estimator.ingest(fix);
  EXPECT_EQ(report.verdict, Verdict::Degenerate);
  EXPECT_FALSE(report.reason.empty());
}

}  // namespace pos::estimation
