#include "pos/eval/alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pos/core/error.hpp"
#include "pos/core/random.hpp"

namespace pos::eval {

namespace {

/// Estimates that are the truth moved by T^-1, so that aligning must find T.
std::vector<MatchedPose> displaced(const Pose3& T_truth_estimate) {
  std::vector<MatchedPose> pairs;
  for (int i = 0; i < 40; ++i) {
    const double a = 0.2 * i;
    const Pose3 truth = Pose3::fromXyzYawPitchRoll(30.0 * std::cos(a), 10.0 * std::sin(a),
                                                   2.0 * std::sin(3.0 * a), a, 0.05 * std::sin(a), 0.03);
    Estimate estimate{.stamp = stampFromSeconds(i), .T_map_body = inverse(T_truth_estimate) * truth};
    pairs.push_back({estimate, estimate.stamp, truth});
  }
  return pairs;
}

void expectNear(const Pose3& a, const Pose3& b) {
  EXPECT_LT(minus(a, b).norm(), 1e-9);
}

}  // namespace

TEST(Alignment, NoneMovesNothing) {
  const Alignment none =
      alignment(displaced(Pose3::fromXyzYawPitchRoll(5, 6, 7, 1, 0, 0)), AlignmentMode::None, {});
  expectNear(none.T_truth_estimate, {});
}

TEST(Alignment, Se2RecoversShiftAndHeading) {
  const Pose3 T = Pose3::fromXyzYawPitchRoll(120.0, -45.0, 0.0, 2.9, 0.0, 0.0);
  expectNear(alignment(displaced(T), AlignmentMode::Se2, {}).T_truth_estimate, T);
}

TEST(Alignment, Se2LeavesTheHeightAlone) {
  const Pose3 T = Pose3::fromXyzYawPitchRoll(1.0, 2.0, 9.0, 0.3, 0.0, 0.0);
  EXPECT_EQ(alignment(displaced(T), AlignmentMode::Se2, {}).T_truth_estimate.translation.z(), 0.0);
}

TEST(Alignment, PosYawRecoversShiftInSpaceAndHeading) {
  const Pose3 T = Pose3::fromXyzYawPitchRoll(-3.0, 8.0, 12.0, -1.2, 0.0, 0.0);
  expectNear(alignment(displaced(T), AlignmentMode::PosYaw, {}).T_truth_estimate, T);
}

TEST(Alignment, Se3RecoversEverything) {
  const Pose3 T = Pose3::fromXyzYawPitchRoll(-3.0, 8.0, 12.0, -1.2, 0.4, -0.7);
  expectNear(alignment(displaced(T), AlignmentMode::Se3, {}).T_truth_estimate, T);
}

TEST(Alignment, OriginLaysTheFirstPoseOnTheTruth) {
  const Pose3 T = Pose3::fromXyzYawPitchRoll(-3.0, 8.0, 12.0, -1.2, 0.4, -0.7);
  expectNear(alignment(displaced(T), AlignmentMode::Origin, {}).T_truth_estimate, T);
}

TEST(Alignment, Se2IsLeastSquares) {
  std::vector<MatchedPose> pairs = displaced(Pose3::fromXyzYawPitchRoll(4.0, -2.0, 0.0, 0.5, 0.0, 0.0));
  RandomStream noise(3, 1);
  for (MatchedPose& pair : pairs) {
    pair.estimate.T_map_body.translation += 0.5 * Eigen::Vector3d(noise.normal(), noise.normal(), 0.0);
  }
  const auto cost = [&pairs](const Pose3& T) {
    double sum = 0.0;
    for (const MatchedPose& pair : pairs) {
      const Eigen::Vector3d moved = T * pair.estimate.T_map_body.translation;
      sum += (moved - pair.T_map_truth.translation).head<2>().squaredNorm();
    }
    return sum;
  };
  const Pose3 best = alignment(pairs, AlignmentMode::Se2, {}).T_truth_estimate;
  for (const double step : {-1e-3, 1e-3}) {
    EXPECT_LT(cost(best), cost(Pose3::fromXyzYawPitchRoll(step, 0, 0, 0, 0, 0) * best));
    EXPECT_LT(cost(best), cost(Pose3::fromXyzYawPitchRoll(0, step, 0, 0, 0, 0) * best));
    EXPECT_LT(cost(best), cost(best * Pose3::fromXyzYawPitchRoll(0, 0, 0, step, 0, 0)));
  }
}

TEST(Alignment, TurnsTheCovarianceWithThePosition) {
  Estimate estimate;
  estimate.covariance.diagonal() << 4.0, 1.0, 0.25, 0.1, 0.2, 0.3;
  const Alignment quarter{AlignmentMode::Se2, Pose3::fromXyzYawPitchRoll(0, 0, 0, kPi / 2.0, 0, 0)};
  const Matrix<6, 6> P = aligned(estimate, quarter).covariance;
  EXPECT_NEAR(P(0, 0), 1.0, 1e-12);
  EXPECT_NEAR(P(1, 1), 4.0, 1e-12);
  EXPECT_NEAR(P(5, 5), 0.3, 1e-12);
}

TEST(Alignment, RefusesWhatTheTruthCannotTell) {
  const std::vector<MatchedPose> pairs = displaced({});
  Truth flat;
  flat.has_z = false;
  flat.has_yaw = false;
  EXPECT_THROW(alignment(pairs, AlignmentMode::Origin, flat), UsageError);
  EXPECT_THROW(alignment(pairs, AlignmentMode::Se3, flat), UsageError);
  EXPECT_NO_THROW(alignment(pairs, AlignmentMode::Se2, flat));
  const std::vector<MatchedPose> still(5, pairs.front());
  EXPECT_THROW(alignment(still, AlignmentMode::Se2, {}), DataError);
  EXPECT_THROW(alignment(still, AlignmentMode::Se3, {}), DataError);
}

TEST(Alignment, EmptyListGivesTheIdentity) {
  for (const AlignmentMode mode : kAlignmentModes) expectNear(alignment({}, mode, {}).T_truth_estimate, {});
}

}  // namespace pos::eval
