#include "pos/eval/association.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace pos::eval {

namespace {

Stamp at(double s) {
  return stampFromSeconds(s);
}

/// x = t along the x axis, yaw 0.1 t, at the given moments.
Truth truthAt(const std::vector<double>& moments) {
  Truth truth;
  for (const double t : moments)
    truth.poses.push_back({at(t), Pose3::fromPlanar({t, 2.0 * t, 0.1 * t}, 3.0 * t)});
  return truth;
}

Estimate estimateAt(double t) {
  return planarEstimate(at(t), {t, 0.0, 0.0}, Matrix<3, 3>::Identity());
}

const Duration kSecond = durationFromSeconds(1.0);

}  // namespace

TEST(Interpolate, IsLinearInPositionAndTurnsEvenly) {
  const auto pose = interpolate(truthAt({0.0, 1.0, 2.0}), at(1.25), kSecond);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->translation.x(), 1.25, 1e-12);
  EXPECT_NEAR(pose->translation.y(), 2.5, 1e-12);
  EXPECT_NEAR(pose->translation.z(), 3.75, 1e-12);
  EXPECT_NEAR(pose->yaw(), 0.125, 1e-12);
}

TEST(Interpolate, TurnsTheShortWayAcrossPi) {
  Truth truth;
  truth.poses = {{at(0.0), Pose3::fromPlanar({0, 0, kPi - 0.1})},
                 {at(1.0), Pose3::fromPlanar({0, 0, -kPi + 0.1})}};
  EXPECT_NEAR(std::abs(interpolate(truth, at(0.5), kSecond)->yaw()), kPi, 1e-9);
}

TEST(Interpolate, KnowsNothingOutsideOrAcrossAGap) {
  const Truth truth = truthAt({0.0, 1.0, 5.0});
  EXPECT_FALSE(interpolate(truth, at(-0.001), kSecond));
  EXPECT_FALSE(interpolate(truth, at(5.001), kSecond));
  EXPECT_FALSE(interpolate(truth, at(3.0), kSecond));
  EXPECT_TRUE(interpolate(truth, at(3.0), durationFromSeconds(4.0)));
  EXPECT_TRUE(interpolate(truth, at(5.0), kSecond));  // exactly at a pose needs no neighbour
  EXPECT_TRUE(interpolate(truth, at(0.0), kSecond));
  EXPECT_FALSE(interpolate(Truth{}, at(0.0), kSecond));
}

TEST(Associate, CountsMatchesCoverageAndLargestGap) {
  Truth truth;
  for (int i = 0; i <= 100; ++i) truth.poses.push_back({at(0.1 * i), {}});
  std::vector<Estimate> estimates;
  for (const double t : {-1.0, 2.0, 3.0, 4.0, 8.0, 9.0, 12.0}) estimates.push_back(estimateAt(t));
  const Association a = associate(estimates, truth).association;
  EXPECT_EQ(a.total, 7U);
  EXPECT_EQ(a.matched, 5U);
  EXPECT_NEAR(a.coverage, 0.3, 1e-9);  // 2..4 and 8..9 of ten seconds
  EXPECT_EQ(a.largest_gap, durationFromSeconds(4.0));
  EXPECT_EQ(a.truth_span, durationFromSeconds(10.0));
}

TEST(Associate, AppliesTheTimeOffsetToTheQuestion) {
  AssociationOptions options;
  options.time_offset = durationFromSeconds(0.5);
  const Matches matches = associate({estimateAt(1.0)}, truthAt({0.0, 1.0, 2.0}), options);
  ASSERT_EQ(matches.pairs.size(), 1U);
  EXPECT_NEAR(matches.pairs[0].T_map_truth.translation.x(), 1.5, 1e-12);
  EXPECT_EQ(matches.pairs[0].truth_stamp, at(1.5));
}

TEST(Associate, LeavesOutAndCountsPosesThatAreNoNumbers) {
  Estimate broken = estimateAt(0.5);
  broken.T_map_body.translation.x() = std::numeric_limits<double>::quiet_NaN();
  const Matches matches = associate({broken, estimateAt(0.7)}, truthAt({0.0, 1.0}));
  EXPECT_EQ(matches.association.not_finite, 1U);
  EXPECT_EQ(matches.association.matched, 1U);
}

TEST(Associate, EmptyTruthOrNoEstimatesMatchNothing) {
  EXPECT_EQ(associate({estimateAt(0.0)}, Truth{}).association.matched, 0U);
  const Association a = associate({}, truthAt({0.0, 1.0})).association;
  EXPECT_EQ(a.coverage, 0.0);
  EXPECT_EQ(a.largest_gap, kSecond);
}

}  // namespace pos::eval
