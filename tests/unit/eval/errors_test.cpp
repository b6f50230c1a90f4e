#include "pos/eval/errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pos/eval/relative_error.hpp"

namespace pos::eval {

namespace {

constexpr double kRadius = 50.0;
constexpr double kTurnRate = 0.05;  // rad/s, counter-clockwise: 2.5 m/s

/// Counter-clockwise round a circle at 20 Hz.
Truth circle(double length_s) {
  Truth truth;
  for (int i = 0; i <= static_cast<int>(20.0 * length_s); ++i) {
    const double a = kTurnRate * 0.05 * i;
    truth.poses.push_back(
        {stampFromSeconds(0.05 * i),
         Pose3::fromPlanar({kRadius * std::cos(a), kRadius * std::sin(a), wrapAngle(a + kPi / 2.0)})});
  }
  return truth;
}

/// The truth at every fifth pose, displaced in the body frame.
std::vector<Estimate> displaced(const Truth& truth, const Pose2& T_body_wrong,
                                const Matrix<3, 3>& covariance) {
  std::vector<Estimate> estimates;
  for (std::size_t i = 0; i < truth.poses.size(); i += 5) {
    const Pose2 pose = truth.poses[i].T_map_body.planar() * T_body_wrong;
    estimates.push_back(planarEstimate(truth.poses[i].stamp, pose, covariance));
  }
  return estimates;
}

ErrorSeries seriesOf(const std::vector<Estimate>& estimates, const Truth& truth) {
  return errorSeries(associate(estimates, truth).pairs, {}, truth);
}

}  // namespace

TEST(Errors, TruthSigmaEntersTheNeesAndNothingElse) {
  const Truth truth = circle(20.0);
  const Matrix<3, 3> P = Vector<3>(0.03, 0.03, 0.01).asDiagonal();
  const std::vector<Estimate> estimates = displaced(truth, {0.2, 0.0, 0.1}, P);
  const ErrorSeries raw = seriesOf(estimates, truth);
  const ErrorSeries counted = errorSeries(associate(estimates, truth).pairs, {}, truth, {}, 0.1);
  ASSERT_EQ(raw.size(), counted.size());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    EXPECT_NEAR(*raw[i].nees_xy, 0.04 / 0.03, 1e-9);
    EXPECT_NEAR(*counted[i].nees_xy, 0.04 / 0.04, 1e-9);          // 0.1^2 more on each axis
    EXPECT_NEAR(*counted[i].nees_pose, 1.0 + 0.01 / 0.01, 1e-9);  // the heading is not touched
    EXPECT_EQ(counted[i].x.sigma, raw[i].x.sigma);
    EXPECT_EQ(counted[i].xy, raw[i].xy);
  }
}

TEST(Errors, ACovarianceThatClaimsNothingHasNoNeesWithATruthSigmaEither) {
  const Truth truth = circle(20.0);
  const std::vector<Estimate> estimates = displaced(truth, {0.2, 0.0, 0.1}, Matrix<3, 3>::Zero());
  for (const ErrorSample& sample : errorSeries(associate(estimates, truth).pairs, {}, truth, {}, 0.1)) {
    EXPECT_FALSE(sample.nees_xy);
    EXPECT_FALSE(sample.nees_pose);
  }
}

TEST(Errors, SplitsAlongAndAcrossOnACircle) {
  const Truth truth = circle(100.0);
  const Matrix<3, 3> P = Vector<3>(0.04, 0.09, 0.01).asDiagonal();
  const ErrorSeries series = seriesOf(displaced(truth, {0.3, -0.2, 0.05}, P), truth);
  ASSERT_GT(series.size(), 300U);
  for (std::size_t i = 5; i + 5 < series.size(); ++i) {
    EXPECT_NEAR(series[i].along->value, 0.3, 1e-3);
    EXPECT_NEAR(series[i].cross->value, -0.2, 1e-3);
    EXPECT_NEAR(series[i].xy, std::hypot(0.3, 0.2), 1e-9);
    EXPECT_NEAR(series[i].yaw->value, 0.05, 1e-9);
    EXPECT_NEAR(
        series[i].along->sigma * series[i].along->sigma + series[i].cross->sigma * series[i].cross->sigma,
        0.13, 1e-9);
  }
}

TEST(Errors, SignIsEstimateMinusTruth) {
  Truth truth;
  truth.poses = {{stampFromSeconds(0), {}}, {stampFromSeconds(1), Pose3::fromPlanar({1.0, 0.0, 0.0})}};
  const auto series = seriesOf(
      {planarEstimate(stampFromSeconds(1), {1.5, 0.25, -0.1}, Matrix<3, 3>::Identity(), 0.7)}, truth);
  ASSERT_EQ(series.size(), 1U);
  EXPECT_NEAR(series[0].x.value, 0.5, 1e-12);
  EXPECT_NEAR(series[0].y.value, 0.25, 1e-12);
  EXPECT_NEAR(series[0].z->value, 0.7, 1e-12);
  EXPECT_NEAR(series[0].yaw->value, -0.1, 1e-12);
  EXPECT_NEAR(series[0].along->value, 0.5, 1e-12);   // ahead
  EXPECT_NEAR(series[0].cross->value, 0.25, 1e-12);  // left
}

TEST(Errors, DirectionIsHeldWhileStanding) {
  Truth truth;  // east for 10 s, standing for 10 s while the recorded heading spins
  for (int i = 0; i <= 200; ++i) {
    truth.poses.push_back(
        {stampFromSeconds(0.1 * i), Pose3::fromPlanar({std::min(0.1 * i, 10.0), 0.0, 0.1 * i})});
  }
  const auto series =
      seriesOf({planarEstimate(stampFromSeconds(18.0), {10.2, 0.1, 0.0}, Matrix<3, 3>::Identity())}, truth);
  EXPECT_NEAR(series.at(0).along->value, 0.2, 1e-9);
  EXPECT_NEAR(series.at(0).cross->value, 0.1, 1e-9);
}

TEST(Errors, BeforeTheFirstMotionTheFirstDirectionToComeCounts) {
  Truth truth;
  for (int i = 0; i <= 200; ++i) {
    truth.poses.push_back(
        {stampFromSeconds(0.1 * i), Pose3::fromPlanar({0.0, std::max(0.1 * i - 10.0, 0.0), 0.0})});
  }
  const auto series =
      seriesOf({planarEstimate(stampFromSeconds(1.0), {0.0, 0.4, 0.0}, Matrix<3, 3>::Identity())}, truth);
  EXPECT_NEAR(series.at(0).along->value, 0.4, 1e-9);
}

TEST(Errors, TruthThatNeverMovesHasNoAlongAndCross) {
  Truth truth;
  truth.poses = {{stampFromSeconds(0), {}}, {stampFromSeconds(1), {}}};
  const auto series =
      seriesOf({planarEstimate(stampFromSeconds(0.5), {1, 0, 0}, Matrix<3, 3>::Identity())}, truth);
  EXPECT_FALSE(series.at(0).along);
  EXPECT_FALSE(series.at(0).cross);
  EXPECT_TRUE(values(series, Component::Along).empty());
}

TEST(Errors, MissingHeadingOrHeightLeavesThemOut) {
  Truth truth = circle(2.0);
  truth.has_yaw = false;
  truth.has_z = false;
  const auto series = seriesOf(displaced(truth, {0.1, 0, 0}, Matrix<3, 3>::Identity()), truth);
  EXPECT_FALSE(series.at(0).yaw);
  EXPECT_FALSE(series.at(0).nees_pose);
  EXPECT_FALSE(series.at(0).z);
  EXPECT_TRUE(series.at(0).nees_xy);
}

TEST(Errors, NeesIsTheSquaredErrorInUnitsOfTheCovariance) {
  Truth truth = circle(1.0);
  Matrix<3, 3> P;
  P << 0.04, 0.01, 0.0, 0.01, 0.09, 0.0, 0.0, 0.0, 0.01;
  const Pose2 t = truth.poses.front().T_map_body.planar();
  const auto series =
      seriesOf({planarEstimate(truth.poses.front().stamp, plus(t, Vector<3>(0.2, 0.3, 0.1)), P)}, truth);
  const double det = 0.04 * 0.09 - 1e-4;
  const double xy = (0.09 * 0.04 - 2.0 * 0.01 * 0.06 + 0.04 * 0.09) / det;
  EXPECT_NEAR(*series.at(0).nees_xy, xy, 1e-9);
  EXPECT_NEAR(*series.at(0).nees_pose, xy + 1.0, 1e-9);
}

TEST(Errors, ZeroCovarianceHasNoNees) {
  const Truth truth = circle(1.0);
  const auto series = seriesOf(displaced(truth, {0.1, 0, 0}, Matrix<3, 3>::Zero()), truth);
  EXPECT_FALSE(series.at(0).nees_xy);
  EXPECT_EQ(series.at(0).x.sigma, 0.0);
}

TEST(RelativeErrors, ConstantDisplacementDriftsNowhere) {
  const Truth truth = circle(60.0);
  const auto series = seriesOf(displaced(truth, {0.3, -0.2, 0.0}, Matrix<3, 3>::Identity()), truth);
  RelativeErrorOptions options{{10.0}, {10.0}};
  for (const RelativeError& e : relativeErrors(series, options)) {
    ASSERT_GT(e.translation.count, 100U);
    EXPECT_LT(e.yaw.max, 1e-9);
  }
}

TEST(RelativeErrors, ScaleErrorOnAStraightLineGrowsWithTheLength) {
  Truth truth;
  std::vector<Estimate> estimates;
  for (int i = 0; i <= 200; ++i) {
    truth.poses.push_back({stampFromSeconds(i), Pose3::fromPlanar({1.0 * i, 0.0, 0.0})});
    estimates.push_back(planarEstimate(stampFromSeconds(i), {1.02 * i, 0.0, 0.0}, Matrix<3, 3>::Identity()));
  }
  const auto series = seriesOf(estimates, truth);
  const auto all = relativeErrors(series, {{10.0, 100.0, 500.0}, {50.0}});
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(all[0].translation.count, 191U);
  EXPECT_NEAR(all[0].translation.rmse, 0.2, 1e-9);
  EXPECT_NEAR(all[1].translation.rmse, 2.0, 1e-9);
  EXPECT_EQ(all[2].translation.count, 0U);
  EXPECT_NEAR(all[3].translation.rmse, 1.0, 1e-9);
  EXPECT_EQ(all[3].duration, 50.0);
}

TEST(RelativeErrors, AWrongHeadingAtTheStartDoesNotCount) {
  Truth truth;
  std::vector<Estimate> estimates;
  const double heading = 0.7;
  const double wrong = 1.0;
  for (int i = 0; i <= 50; ++i) {
    truth.poses.push_back(
        {stampFromSeconds(i), Pose3::fromPlanar({i * std::cos(heading), i * std::sin(heading), heading})});
    estimates.push_back(planarEstimate(stampFromSeconds(i), {i * std::cos(wrong), i * std::sin(wrong), wrong},
                                       Matrix<3, 3>::Identity()));
  }
  const RelativeErrorOptions options{{20.0}, {}};
  EXPECT_LT(relativeErrors(seriesOf(estimates, truth), options).at(0).translation.max, 1e-9);
  truth.has_yaw = false;  // then it does: a chord of 20 m seen under 0.3 rad
  EXPECT_NEAR(relativeErrors(seriesOf(estimates, truth), options).at(0).translation.max,
              40.0 * std::sin(0.15), 1e-9);
}

}  // namespace pos::eval
