#include "pos/uwb/dual_tag.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "pos/core/random.hpp"

namespace pos::uwb {
namespace {

const TagPair kTags{{0.0, 0.375}, {0.0, -0.375}};
const TagPair kOffset{{0.8, 0.5}, {-0.2, -0.3}};

struct Places {
  Eigen::Vector2d left;
  Eigen::Vector2d right;
};

Places placesOf(const Pose2& pose, const TagPair& tags) {
  return {pose * tags.left_body, pose * tags.right_body};
}

SnapshotPose snapshotAt(const Places& places, const TagPair& tags, double sigma = 0.05) {
  const Eigen::Matrix2d P = sigma * sigma * Eigen::Matrix2d::Identity();
  return *snapshotPose({places.left, P}, {places.right, P}, tags);
}

TagAdvance between(const Pose2& before, const Pose2& now, const TagPair& tags = kTags) {
  const Places a = placesOf(before, tags);
  const Places b = placesOf(now, tags);
  return tagAdvance(a.left, a.right, b.left, b.right);
}

Pose2 somewhere(RandomStream& random) {
  return {random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-kPi, kPi)};
}

/// Equation 5 of the paper as printed, row 3: |Delta p| / D.
double printedTurn(const Pose2& before, const Pose2& now) {
  return between(before, now).translation.norm() / kTags.length();
}

TEST(DualTag, PoseToTagsToPose) {
  RandomStream random(1, 1);
  for (int k = 0; k < 200; ++k) {
    const Pose2 pose = somewhere(random);
    for (const TagPair& tags : {kTags, kOffset}) {
      const Pose2 found = snapshotAt(placesOf(pose, tags), tags).pose.mean;
      EXPECT_LE(minus(found, pose).norm(), 1e-10);
    }
  }
}

TEST(DualTag, SwappedTagsTurnTheHeadingRound) {
  const Pose2 pose{3.0, 2.0, 0.6};
  const Places places = placesOf(pose, kTags);
  const Pose2 found = snapshotAt({places.right, places.left}, kTags).pose.mean;
  EXPECT_NEAR(std::abs(wrapAngle(found.yaw - pose.yaw)), kPi, 1e-9);
  EXPECT_NEAR(found.x, pose.x, 1e-9);
}

TEST(DualTag, HeadingSigmaIsRootTwoSigmaOverBaseline) {
  for (const double yaw : {0.0, 1.0, kPi, -2.5}) {
    const SnapshotPose snapshot = snapshotAt(placesOf({1.0, 2.0, yaw}, kTags), kTags, 0.05);
    EXPECT_NEAR(degrees(std::sqrt(snapshot.pose.covariance(2, 2))), 5.4, 0.01);
  }
}

TEST(DualTag, CovarianceFollowsTheTagsErrors) {
  // The claimed covariance against differences: move each coordinate of each tag and see the pose move.
  const Pose2 pose{2.0, -1.0, 2.2};
  const Places places = placesOf(pose, kOffset);
  Eigen::Matrix2d P_left;
  P_left << 0.04, 0.01, 0.01, 0.02;
  Eigen::Matrix2d P_right;
  P_right << 0.03, -0.02, -0.02, 0.05;
  const auto poseOf = [&](const Eigen::Vector4d& d) {
    return snapshotAt({places.left + d.head<2>(), places.right + d.tail<2>()}, kOffset).pose.mean;
  };
  Matrix<3, 4> J;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector4d d = 1e-6 * Eigen::Vector4d::Unit(k);
    J.col(k) = minus(poseOf(d), poseOf(-d)) / 2e-6;
  }
  Matrix<4, 4> P = Matrix<4, 4>::Zero();
  P.topLeftCorner<2, 2>() = P_left;
  P.bottomRightCorner<2, 2>() = P_right;
  const SnapshotPose snapshot = *snapshotPose({places.left, P_left}, {places.right, P_right}, kOffset);
  EXPECT_LE((snapshot.pose.covariance - J * P * J.transpose()).norm(), 1e-7);
}

TEST(DualTag, BaselineTestCountsTheExcessInSigmas) {
  Places places = placesOf({0.0, 0.0, 0.3}, kTags);
  EXPECT_NEAR(snapshotAt(places, kTags).baseline_chi_square, 0.0, 1e-20);
  const Eigen::Vector2d outward = (places.left - places.right).normalized();
  places.left += 3.0 * std::sqrt(2.0) * 0.05 * outward;
  EXPECT_NEAR(snapshotAt(places, kTags).baseline_chi_square, 9.0, 1e-9);
}

TEST(DualTag, TagsAtOnePlaceGiveNoHeading) {
  EXPECT_FALSE(snapshotPose({{1.0, 1.0}, Eigen::Matrix2d::Identity()},
                            {{1.0, 1.0}, Eigen::Matrix2d::Identity()}, kTags));
}

TEST(DualTag, StraightDriveDoesNotTurnAndSpinningDoesNotMove) {
  const TagAdvance straight = between({0.0, 0.0, 0.4}, Pose2{0.0, 0.0, 0.4} * Pose2{1.0, 0.0, 0.0});
  EXPECT_NEAR(straight.rotation, 0.0, 1e-12);
  EXPECT_NEAR(straight.translation.norm(), 1.0, 1e-12);
  const TagAdvance spin = between({3.0, 1.0, 0.4}, {3.0, 1.0, 0.9});
  EXPECT_NEAR(spin.rotation, 0.5, 1e-12);
  EXPECT_NEAR(spin.translation.norm(), 0.0, 1e-12);
}

TEST(DualTag, TurnsCarryTheirSignAndMayBeNearHalfATurn) {
  for (const double turn : {-3.1, -0.1, 1e-9, 0.1, 3.1}) {
    EXPECT_NEAR(between({1.0, 2.0, 3.0}, {1.0, 2.0, 3.0 + turn}).rotation, turn, 1e-9);
  }
}

TEST(DualTag, RunningBackInTimeNegatesTheAdvance) {
  const Pose2 a{1.0, 2.0, 3.0};
  const Pose2 b{1.5, 2.4, -2.9};
  const TagAdvance there = between(a, b);
  const TagAdvance back = between(b, a);
  EXPECT_NEAR(there.rotation, -back.rotation, 1e-12);
  EXPECT_LE((there.translation + back.translation).norm(), 1e-12);
}

TEST(DualTag, AdvancesTelescopeToTheSnapshotWithoutDrift) {
  RandomStream random(2, 1);
  const Pose2 start{1.0, 2.0, 0.5};
  Places places = placesOf(start, kOffset);
  DifferentialMapper mapper(start, kOffset, places.left, places.right);
  Pose2 pose = start;
  for (int k = 0; k < 500; ++k) {  // several turns round the circle, with noise on every tag position
    pose = pose * Pose2{0.1, 0.0, 0.05};
    places = placesOf(pose, kOffset);
    places.left += Eigen::Vector2d(random.normal(0.0, 0.05), random.normal(0.0, 0.05));
    places.right += Eigen::Vector2d(random.normal(0.0, 0.05), random.normal(0.0, 0.05));
    mapper.advance(places.left, places.right);
    EXPECT_LE(minus(mapper.pose(), snapshotAt(places, kOffset).pose.mean).norm(), 1e-9) << k;
  }
}

TEST(DualTag, AnErrorOfTheStartStaysAsItIs) {
  const Pose2 start{1.0, 2.0, 0.5};
  Places places = placesOf(start, kTags);
  DifferentialMapper mapper({1.2, 2.0, 0.6}, kTags, places.left, places.right);
  const Pose2 end{8.0, -3.0, -2.0};
  places = placesOf(end, kTags);
  mapper.advance(places.left, places.right);
  EXPECT_NEAR(mapper.pose().x - end.x, 0.2, 1e-9);
  EXPECT_NEAR(wrapAngle(mapper.pose().yaw - end.yaw), 0.1, 1e-9);
}

// Erratum A4: the printed Delta psi is no rotation.
TEST(DualTag, PrintedEquationFiveTurnsOnTheStraightAndLosesTheSign) {
  const Pose2 origin;
  EXPECT_NEAR(printedTurn(origin, {1.0, 0.0, 0.0}), 1.333, 1e-3);    // true: 0
  EXPECT_NEAR(printedTurn(origin, {25.0, 0.0, 0.0}), 33.3, 0.1);     // true: 0
  EXPECT_NEAR(printedTurn(origin, {0.0, 0.0, 0.5}), 0.0, 1e-12);     // true: 0.5
  EXPECT_GT(printedTurn(origin, Pose2{0.104, -0.005, -0.1}), 0.13);  // true: -0.1
  EXPECT_NEAR(between(origin, {25.0, 0.0, 0.0}).rotation, 0.0, 1e-12);
}

// Erratum A5: with x_l(t) in place of x_r(t) the midpoint jumps by (x_r - x_l) / 2 every step.
TEST(DualTag, PrintedEquationFourJumpsAtHeadingsOtherThanZero) {
  const Pose2 before{0.0, 0.0, kPi / 2};
  const Places a = placesOf(before, kTags);
  const Places b = placesOf(before * Pose2{0.1, 0.0, 0.0}, kTags);
  const double printed = 0.5 * ((b.right.x() - a.left.x()) + (b.left.x() - a.left.x()));
  const double correct = between(before, before * Pose2{0.1, 0.0, 0.0}).translation.x();
  EXPECT_NEAR(correct, 0.0, 1e-12);
  EXPECT_NEAR(printed, 0.5 * (a.right.x() - a.left.x()), 1e-12);
}

}  // namespace
}  // namespace pos::uwb
