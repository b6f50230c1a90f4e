#include "pos/estimation/range_models.hpp"

#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "pos/core/random.hpp"
#include "support/numeric_jacobian.hpp"

namespace pos::estimation {
namespace {

using testing::numericJacobian;

RangeOdometryConfig everythingFreed(RangeOdometryConfig::Motion motion) {
  RangeOdometryConfig config;
  config.motion = motion;
  for (CalibrationState* c : {&config.range_scale, &config.range_offset, &config.anchor_offset,
                              &config.gyro_bias, &config.wheel_scale, &config.latency}) {
    c->sigma = 0.1;
  }
  return config;
}

/// Random states, with headings near zero and near +-pi among them.
std::vector<RangeState> states(const RangeLayout& layout) {
  RandomStream random(11, 0);
  std::vector<RangeState> result;
  for (const double yaw : {1e-9, -1e-7, 3.14159, -3.14159, 0.7, -2.2}) {
    RangeState x{RangeState::Values::Zero(layout.size())};
    for (double& value : x.values) value = random.normal(0.0, 0.3);
    x.values[0] = random.uniform(-20.0, 20.0);
    x.values[1] = random.uniform(-20.0, 20.0);
    x.values[2] = yaw;
    for (const StateTerm scale : {StateTerm::WheelScale, StateTerm::RangeScale}) {
      if (const auto row = layout.row(scale)) x.values[*row] = 1.0 + random.normal(0.0, 0.05);
    }
    result.push_back(x);
  }
  return result;
}

RangeGeometry geometry(RandomStream& random, const RangeOdometryConfig& config) {
  RangeGeometry g;
  g.anchor = 7;
  g.anchor_map = {random.uniform(-30.0, 30.0), random.uniform(-30.0, 30.0), 2.0};
  g.tag_body = {0.4, -0.3, 1.1};
  g.body_height = 0.2;
  g.range_bias = 0.05;
  g.age = 0.13;
  if (config.motion == RangeOdometryConfig::Motion::Odometry) g.odometry_velocity = {{1.4, -0.1}, 0.3};
  return g;
}

const auto kMotions = {RangeOdometryConfig::Motion::Odometry, RangeOdometryConfig::Motion::ConstantVelocity};

}  // namespace

TEST(RangeModels, PredictPoseAgreesWithTheDenseKernel) {
  RandomStream random(13, 0);
  for (const auto motion : kMotions) {
    auto config = everythingFreed(motion);
    config.anchor_offset.walk_per_sqrt_s = 0.02;
    const RangeLayout layout(config, {7, 9});
    for (const RangeState& x : states(layout)) {
      TangentMatrix<RangeState> root(layout.size(), layout.size());
      for (double& value : root.reshaped()) value = random.normal(0.0, 0.5);
      Belief<RangeState> dense{x, root * root.transpose()};
      filters::symmetrise(dense.covariance);
      Belief<RangeState> sparse = dense;
      const auto step = motion == RangeOdometryConfig::Motion::Odometry
                            ? OdometryMotion{&layout, &config}.step(x, {0.4, -0.1, 0.2}, 0.3)
                            : ConstantVelocityMotion{&layout, &config}.step(x, {}, 0.3);
      filters::predict(dense, step);
      predictPose(sparse, step);
      EXPECT_EQ(sparse.mean.values, dense.mean.values);
      EXPECT_TRUE(sparse.covariance.isApprox(dense.covariance, 1e-13));
      EXPECT_EQ(sparse.covariance, sparse.covariance.transpose());
    }
  }
}

TEST(RangeModels, OdometryJacobianMatchesNumericDifferences) {
  const auto config = everythingFreed(RangeOdometryConfig::Motion::Odometry);
  const RangeLayout layout(config, {7, 9});
  const OdometryMotion motion{&layout, &config};
  const Pose2 increment{0.8, 0.05, 0.4};
  for (const RangeState& x : states(layout)) {
    const auto F = numericJacobian(x, layout.size(), [&](const RangeState& at) -> Eigen::VectorXd {
      return minus(motion.step(at, increment, 0.25).next, motion.step(x, increment, 0.25).next);
    });
    EXPECT_TRUE(motion.step(x, increment, 0.25).F.isApprox(F, 1e-6)) << x.values.transpose();
  }
}

TEST(RangeModels, ConstantVelocityJacobianMatchesNumericDifferences) {
  const auto config = everythingFreed(RangeOdometryConfig::Motion::ConstantVelocity);
  const RangeLayout layout(config, {7, 9});
  const ConstantVelocityMotion motion{&layout, &config};
  for (const RangeState& x : states(layout)) {
    const auto F = numericJacobian(x, layout.size(), [&](const RangeState& at) -> Eigen::VectorXd {
      return minus(motion.step(at, {}, 0.25).next, motion.step(x, {}, 0.25).next);
    });
    EXPECT_TRUE(motion.step(x, {}, 0.25).F.isApprox(F, 1e-6));
  }
}

TEST(RangeModels, RangeJacobianMatchesNumericDifferences) {
  RandomStream random(12, 0);
  for (const auto kind : kMotions) {
    const auto config = everythingFreed(kind);
    const RangeLayout layout(config, {7, 9});
    const TangentMatrix<RangeState> P = TangentMatrix<RangeState>::Identity(layout.size(), layout.size());
    for (const RangeState& x : states(layout)) {
      const RangeGeometry g = geometry(random, config);
      const auto H = numericJacobian(x, layout.size(), [&](const RangeState& at) -> Eigen::VectorXd {
        return Vector<1>(predictedRange(at, layout, P, g).range);
      });
      EXPECT_TRUE(predictedRange(x, layout, P, g).H.isApprox(TangentRows<RangeState, 1>(H), 1e-6));
    }
  }
}

TEST(RangeModels, PositionJacobianMatchesNumericDifferences) {
  const SeenPoint seen{{3.0, 4.0}, {1.5, -0.4}};
  for (const auto kind : kMotions) {
    const auto config = everythingFreed(kind);
    const RangeLayout layout(config, {});
    const BodyVelocity v =
        kind == RangeOdometryConfig::Motion::Odometry ? BodyVelocity{{1.4, -0.1}, 0.3} : BodyVelocity{};
    for (const RangeState& x : states(layout)) {
      const auto H = numericJacobian(x, layout.size(), [&](const RangeState& at) -> Eigen::VectorXd {
        return -positionInnovation(at, layout, seen, 0.2, v).nu;  // nu = reading - prediction
      });
      EXPECT_TRUE(
          positionInnovation(x, layout, seen, 0.2, v).H.isApprox(TangentRows<RangeState, 2>(H), 1e-6));
    }
  }
}

TEST(RangeModels, CurvatureTermsMatchTheNumericHessianAndTheSampledMean) {
  RangeOdometryConfig config;
  const RangeLayout layout(config, {});
  RangeState x{RangeState::Values::Zero(3)};
  x.values << 3.0, 1.0, 0.0;
  TangentMatrix<RangeState> P = TangentMatrix<RangeState>::Zero(3, 3);
  P.topLeftCorner<2, 2>() << 0.20, 0.05, 0.05, 0.30;
  const RangeGeometry g;  // anchor at the origin
  const RangePrediction predicted = predictedRange(x, layout, P, g);
  const Eigen::MatrixXd hessian = numericJacobian(x, 3, [&](const RangeState& at) -> Eigen::VectorXd {
    return predictedRange(at, layout, P, g).H.transpose();
  });
  const Eigen::Matrix2d spread = hessian.topLeftCorner<2, 2>() * P.topLeftCorner<2, 2>();
  EXPECT_NEAR(predicted.curvature_mean, 0.5 * spread.trace(), 1e-6);
  EXPECT_NEAR(predicted.curvature_variance, 0.5 * (spread * spread).trace(), 1e-6);

  RandomStream random(13, 0);
  const Eigen::Matrix2d L = P.topLeftCorner<2, 2>().llt().matrixL();
  double sum = 0.0;
  constexpr int kSamples = 200000;
  for (int i = 0; i < kSamples; ++i) {
    RangeState at = x;
    at.values.head<2>() += L * Eigen::Vector2d(random.normal(), random.normal());
    sum += predictedRange(at, layout, P, g).range;
  }
  // The curvature lifts the mean by 0.042 m; sampling error is 0.0011 m, fourth-order terms about 0.002 m.
  EXPECT_NEAR(sum / kSamples, predicted.range + predicted.curvature_mean, 0.006);
}

TEST(RangeModels, OdometryNoiseGrowsWithDistanceTurnAndTime) {
  const OdometryNoise noise{0.1, 0.02, 0.03, 0.04, 0.05, 0.06};
  const Matrix<3, 3> Q = odometryCovariance(noise, Pose2{3.0, 4.0, -0.5}, 2.0);
  EXPECT_NEAR(Q(0, 0), 0.01 * 5.0 + 0.0036 * 2.0, 1e-12);
  EXPECT_NEAR(Q(1, 1), 0.0004 * 5.0 + 0.0036 * 2.0, 1e-12);
  EXPECT_NEAR(Q(2, 2), 0.0009 * 5.0 + 0.0016 * 0.5 + 0.0025 * 2.0, 1e-12);
  EXPECT_EQ(odometryCovariance(noise, Pose2{}, 0.0).norm(), 0.0);
}

TEST(RangeModels, ZeroTimeAndZeroIncrementAreTheIdentity) {
  for (const auto kind : kMotions) {
    const auto config = everythingFreed(kind);
    const RangeLayout layout(config, {7});
    const RangeState x = states(layout).front();
    const auto step = kind == RangeOdometryConfig::Motion::Odometry
                          ? OdometryMotion{&layout, &config}.step(x, Pose2{}, 0.0)
                          : ConstantVelocityMotion{&layout, &config}.step(x, {}, 0.0);
    EXPECT_EQ(minus(step.next, x).norm(), 0.0);
    EXPECT_EQ(step.Qd.norm(), 0.0);
  }
}

TEST(RangeLayout, HoldsTermsWithoutSigmaAndFreesTheOthers) {
  RangeOdometryConfig config;
  config.range_scale = {1.02, 0.05, 0.0};
  config.range_offset = {0.3, 0.0, 0.0};
  const RangeLayout layout(config, {4, 2});
  EXPECT_EQ(layout.size(), 4);
  EXPECT_EQ(layout.row(StateTerm::RangeScale), 3);
  EXPECT_FALSE(layout.row(StateTerm::RangeOffset));
  EXPECT_DOUBLE_EQ(layout.held(StateTerm::RangeOffset), 0.3);
  EXPECT_FALSE(layout.anchorRow(4));
}

TEST(RangeLayout, TooManyAnchorOffsetsAreRefusedWithARemedy) {
  RangeOdometryConfig config;
  config.anchor_offset.sigma = 0.1;
  std::vector<AnchorId> anchors(62);
  for (std::size_t i = 0; i < anchors.size(); ++i) anchors[i] = static_cast<AnchorId>(i);
  EXPECT_THROW(RangeLayout(config, anchors), ConfigError);
  anchors.resize(61);
  const RangeLayout layout(config, anchors);
  EXPECT_EQ(layout.size(), 64);
  EXPECT_EQ(layout.anchorRow(0), 3);
  EXPECT_EQ(layout.anchorRow(60), 63);
}

}  // namespace pos::estimation
