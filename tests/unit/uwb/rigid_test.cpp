#include "pos/uwb/rigid.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <vector>

#include "pos/core/random.hpp"
#include "support/numeric_jacobian.hpp"

namespace pos::uwb {
namespace {

const std::vector<Eigen::Vector3d> kCorners{{0, 4, 0}, {29, 4, 0}, {29, -4, 0}, {0, -4, 0}};
const std::vector<Eigen::Vector3d> kWall{{0, 4, 0}, {14.5, 4, 0}, {29, 4, 0}};
const Eigen::Vector3d kLeft(0.0, 0.375, 0.0);
const Eigen::Vector3d kRight(0.0, -0.375, 0.0);
const ResidualTest kTest;

std::vector<BodyRange> exact(const std::vector<Eigen::Vector3d>& anchors, const Pose2& pose,
                             const std::vector<Eigen::Vector3d>& tags = {kLeft, kRight},
                             double sigma = 0.05) {
  std::vector<BodyRange> ranges;
  for (std::size_t t = 0; t < tags.size(); ++t) {
    for (const Eigen::Vector3d& a : anchors) {
      const double range = predictedRange(pose, 0.0, tags[t], a).distance;
      ranges.push_back({static_cast<TagId>(t), tags[t], a, range, sigma});
    }
  }
  return ranges;
}

void addNoise(std::vector<BodyRange>& ranges, double sigma, RandomStream& random) {
  for (BodyRange& r : ranges) r.range += random.normal(0.0, sigma);
}

Pose2 somewhere(RandomStream& random) {
  return {random.uniform(1, 28), random.uniform(-3, 3), random.uniform(-kPi, kPi)};
}

void expectPose(const Pose2& found, const Pose2& expected, double tolerance) {
  EXPECT_LE(minus(found, expected).norm(), tolerance)
      << found.x << " " << found.y << " " << found.yaw << " for " << expected.x << " " << expected.y << " "
      << expected.yaw;
}

TEST(Rigid, PredictedRangeHasTheDerivativeItClaims) {
  for (const double yaw : {0.0, 1e-7, 0.7, -2.0, kPi - 1e-7, -kPi + 1e-7}) {
    const Pose2 pose{3.0, -1.0, yaw};
    for (const Eigen::Vector3d& tag : {kLeft, Eigen::Vector3d(0.8, -0.3, 1.1)}) {
      const Eigen::Vector3d anchor(29.0, 4.0, 2.0);
      const auto numeric = pos::testing::numericJacobian(pose, 3, [&](const Pose2& q) {
        return Eigen::VectorXd::Constant(1, predictedRange(q, 0.5, tag, anchor).distance).eval();
      });
      EXPECT_LE((predictedRange(pose, 0.5, tag, anchor).row.transpose() - numeric).norm(), 1e-8);
    }
  }
}

TEST(Rigid, ExactRangesGiveThePoseBack) {
  RandomStream random(1, 1);
  for (int k = 0; k < 300; ++k) {
    const Pose2 pose = somewhere(random);
    const RigidFixes fixes = rigidFixes(exact(kCorners, pose), 0.0, kTest);
    ASSERT_EQ(fixes.verdict, FixVerdict::Solved);
    expectPose(fixes.fixes[0].pose.mean, pose, 1e-9);
  }
}

TEST(Rigid, AnyLeverArmsAndHeightsWillDo) {
  RandomStream random(2, 1);
  const std::vector<Eigen::Vector3d> tags{{1.5, 0.6, 1.0}, {-0.7, -0.5, 0.4}, {0.2, 0.0, 1.8}};
  std::vector<Eigen::Vector3d> anchors = kCorners;
  for (std::size_t k = 0; k < anchors.size(); ++k) anchors[k].z() = 2.0 + 0.3 * static_cast<double>(k);
  for (int k = 0; k < 100; ++k) {
    const Pose2 pose = somewhere(random);
    expectPose(rigidFixes(exact(anchors, pose, tags), 0.0, kTest).fixes[0].pose.mean, pose, 1e-8);
  }
}

TEST(Rigid, TwoAndTwoOrThreeAndOneRangesHoldTheTruthAmongTheirPoses) {
  RandomStream random(3, 1);
  for (int k = 0; k < 100; ++k) {
    const Pose2 pose = somewhere(random);
    const std::vector<BodyRange> all = exact(kCorners, pose);
    for (const std::vector<std::size_t>& chosen :
         {std::vector<std::size_t>{0, 1, 4, 6}, std::vector<std::size_t>{0, 1, 2, 7}}) {
      std::vector<BodyRange> ranges;
      for (const std::size_t i : chosen) ranges.push_back(all[i]);
      const RigidFixes fixes = rigidFixes(ranges, 0.0, kTest);
      ASSERT_GT(fixes.count, 0);
      double least = 1e9;
      for (const RigidFix& fix : fixes.all()) least = std::min(least, minus(fix.pose.mean, pose).norm());
      EXPECT_LE(least, 1e-6) << k;
    }
  }
}

TEST(Rigid, CollinearAnchorsMirrorTheWholeVehicle) {
  const Pose2 pose{9.0, 0.5, 0.3};
  const RigidFixes fixes = rigidFixes(exact(kWall, pose), 0.0, kTest);
  ASSERT_EQ(fixes.verdict, FixVerdict::Ambiguous);
  ASSERT_EQ(fixes.count, 2);  // not four: the baseline rules out one tag here and one there
  const Pose2 mirror{9.0, 7.5, wrapAngle(kPi - 0.3)};
  const bool first_is_pose = minus(fixes.fixes[0].pose.mean, pose).norm() < 1.0;
  expectPose(fixes.fixes[first_is_pose ? 0 : 1].pose.mean, pose, 1e-7);
  expectPose(fixes.fixes[first_is_pose ? 1 : 0].pose.mean, mirror, 1e-7);
  const RigidFixes kept =
      keptInside(fixes, [](const RigidFix& fix) { return std::abs(fix.pose.mean.y) <= 4.0; });
  ASSERT_EQ(kept.count, 1);
  expectPose(kept.fixes[0].pose.mean, pose, 1e-7);
}

TEST(Rigid, APredictionPicksTheImageNextToIt) {
  const Pose2 pose{9.0, 0.5, 0.3};
  const RigidFixes fixes = rigidFixNear(exact(kWall, pose), 0.0, {9.3, 0.2, 0.1}, kTest);
  ASSERT_EQ(fixes.count, 1);
  expectPose(fixes.fixes[0].pose.mean, pose, 1e-8);
}

// Spec A, 2.4: sigma of the yaw 0.98 to 1.35 rad per metre of range sigma along the double lane's path.
TEST(Rigid, CovarianceIsTheBoundOfTheSpecAndTheScatterWithinFivePercent) {
  const auto yawBound = [](double x) {
    const auto ranges = exact(kCorners, {x, 0.0, 0.0}, {kLeft, kRight}, 1.0);
    return std::sqrt(rigidFixNear(ranges, 0.0, {x, 0.0, 0.0}, kTest).fixes[0].pose.covariance(2, 2));
  };
  EXPECT_NEAR(yawBound(14.5), 0.98, 0.02);
  EXPECT_NEAR(yawBound(0.0), 1.35, 0.03);
  RandomStream random(4, 1);
  constexpr int kDraws = 2000;
  const Pose2 pose{5.0, 1.0, 0.4};
  const double sigma = 0.02;
  Matrix<3, 3> scatter = Matrix<3, 3>::Zero();
  double nees = 0.0;
  for (int k = 0; k < kDraws; ++k) {
    auto ranges = exact(kCorners, pose, {kLeft, kRight}, sigma);
    addNoise(ranges, sigma, random);
    const RigidFix fix = rigidFixes(ranges, 0.0, kTest).fixes[0];
    const Vector<3> e = minus(fix.pose.mean, pose);
    scatter += e * e.transpose() / kDraws;
    nees += e.dot(fix.pose.covariance.llt().solve(e)) / kDraws;
  }
  const auto fixes = rigidFixes(exact(kCorners, pose, {kLeft, kRight}, sigma), 0.0, kTest);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(std::sqrt(scatter(i, i) / fixes.fixes[0].pose.covariance(i, i)), 1.0, 0.05) << i;
  }
  EXPECT_NEAR(nees, 3.0, 4.0 * std::sqrt(6.0 / kDraws));  // mean of 2000 chi-square values, four sigmas
}

TEST(Rigid, RotatingTheSiteRotatesThePose) {
  RandomStream random(5, 1);
  const Pose2 T{100.0, -50.0, 1.1};
  for (int k = 0; k < 30; ++k) {
    auto ranges = exact(kCorners, somewhere(random));
    addNoise(ranges, 0.05, random);
    const Pose2 here = rigidFixes(ranges, 0.0, kTest).fixes[0].pose.mean;
    for (BodyRange& r : ranges) r.anchor_map.head<2>() = T * Eigen::Vector2d(r.anchor_map.head<2>());
    expectPose(rigidFixes(ranges, 0.0, kTest).fixes[0].pose.mean, T * here, 1e-6);
  }
}

TEST(Rigid, OrderOfTheRangesDoesNotMatter) {
  RandomStream random(6, 1);
  auto ranges = exact(kCorners, {11.0, 0.5, -2.0});
  addNoise(ranges, 0.05, random);
  const Pose2 pose = rigidFixes(ranges, 0.0, kTest).fixes[0].pose.mean;
  for (int k = 0; k < 20; ++k) {
    std::shuffle(ranges.begin(), ranges.end(), random);
    expectPose(rigidFixes(ranges, 0.0, kTest).fixes[0].pose.mean, pose, 1e-7);
  }
}

TEST(Rigid, SwappedTagsTurnTheHeadingRound) {
  const Pose2 pose{11.0, 0.5, 0.4};
  auto ranges = exact(kCorners, pose);
  for (BodyRange& r : ranges) r.tag_body = r.tag == 0 ? kRight : kLeft;
  expectPose(rigidFixes(ranges, 0.0, kTest).fixes[0].pose.mean, {11.0, 0.5, 0.4 - kPi}, 1e-7);
}

TEST(Rigid, BadRangesOfEitherSignAreLeftOut) {
  RandomStream random(7, 1);
  for (int k = 0; k < 60; ++k) {
    const Pose2 pose = somewhere(random);
    auto ranges = exact(kCorners, pose, {kLeft, kRight}, 0.03);
    addNoise(ranges, 0.03, random);
    const auto bad = static_cast<std::size_t>(k % 8);
    ranges[bad].range += k % 2 == 0 ? 2.0 : -std::min(2.0, ranges[bad].range - 0.05);
    const RigidFixes fixes = rigidFixes(ranges, 0.0, kTest);
    ASSERT_GE(fixes.count, 1);
    EXPECT_EQ(fixes.fixes[0].used & (1U << bad), 0U) << k;
    EXPECT_LT(minus(fixes.fixes[0].pose.mean, pose).head<2>().norm(), 0.25) << k;
  }
}

TEST(Rigid, TooLittleIsSaidSo) {
  const auto all = exact(kCorners, {9.0, 0.0, 0.0});
  EXPECT_EQ(rigidFixes({all.data(), 3}, 0.0, kTest).verdict, FixVerdict::TooFew);
  EXPECT_EQ(rigidFixes({all.data(), 4}, 0.0, kTest).verdict, FixVerdict::TooFew) << "four of one tag";
  EXPECT_EQ(rigidFixNear({all.data(), 4}, 0.0, {9.0, 0.0, 0.0}, kTest).verdict, FixVerdict::Degenerate);
}

}  // namespace
}  // namespace pos::uwb
