#include "pos/uwb/multilateration.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <vector>

#include "pos/core/pose2.hpp"
#include "pos/core/random.hpp"

namespace pos::uwb {
namespace {

using Points = std::vector<Eigen::Vector2d>;

const Points kCorners{{0.0, 4.0}, {29.0, 4.0}, {29.0, -4.0}, {0.0, -4.0}};  // paper A, double lane
const Points kWall{{0.0, 4.0}, {14.5, 4.0}, {29.0, 4.0}};                   // spec A6
const ResidualTest kTest;

std::vector<TagRange> exact(const Points& anchors, const Eigen::Vector2d& p, double sigma = 0.05) {
  std::vector<TagRange> ranges;
  for (const Eigen::Vector2d& a : anchors) ranges.push_back({a, 0.0, (p - a).norm(), sigma});
  return ranges;
}

std::vector<TagRange> noisy(const Points& anchors, const Eigen::Vector2d& p, double sigma,
                            RandomStream& random) {
  std::vector<TagRange> ranges = exact(anchors, p, sigma);
  for (TagRange& r : ranges) r.range += random.normal(0.0, sigma);
  return ranges;
}

Eigen::Vector2d somewhere(RandomStream& random) {
  return {random.uniform(0.5, 28.5), random.uniform(-3.5, 3.5)};
}

bool insideRoadway(const TagFix& fix) {
  return fix.p_map.x() >= 0.0 && fix.p_map.x() <= 29.0 && std::abs(fix.p_map.y()) <= 4.0;
}

TEST(Multilateration, ExactRangesGiveThePlaceBack) {
  RandomStream random(1, 1);
  for (int k = 0; k < 500; ++k) {
    const Eigen::Vector2d p = somewhere(random);
    const TagFixes fixes = multilaterated(exact(kCorners, p), kTest);
    ASSERT_EQ(fixes.verdict, FixVerdict::Solved);
    EXPECT_LE((fixes.fixes[0].p_map - p).norm(), 1e-9);
    EXPECT_EQ(fixes.fixes[0].used, 0b1111U);
  }
}

TEST(Multilateration, HeightsOfAnchorsEnterTheModel) {
  const Eigen::Vector2d p(1.0, 3.0);  // nearly below the first anchor: the level distance is the smaller part
  std::vector<TagRange> ranges = exact(kCorners, p);
  for (TagRange& r : ranges) {
    r.height = 2.5;
    r.range = std::hypot((p - r.anchor).norm(), r.height);
  }
  EXPECT_LE((multilaterated(ranges, kTest).fixes[0].p_map - p).norm(), 1e-9);
}

TEST(Multilateration, RigidMotionOfTheSiteMovesThePlaceWithIt) {
  RandomStream random(2, 1);
  const Pose2 T{5.6e5, -4.1e6, 2.0};  // as far off as a mine's own grid
  for (int k = 0; k < 50; ++k) {
    std::vector<TagRange> ranges = noisy(kCorners, somewhere(random), 0.05, random);
    const Eigen::Vector2d here = multilaterated(ranges, kTest).fixes[0].p_map;
    for (TagRange& r : ranges) r.anchor = T * r.anchor;
    EXPECT_LE((multilaterated(ranges, kTest).fixes[0].p_map - T * here).norm(), 1e-6);
  }
}

TEST(Multilateration, OrderOfTheAnchorsDoesNotMatter) {
  RandomStream random(3, 1);
  std::vector<TagRange> ranges = noisy(kCorners, {11.0, -1.2}, 0.1, random);
  const Eigen::Vector2d p = multilaterated(ranges, kTest).fixes[0].p_map;
  for (int k = 0; k < 20; ++k) {
    std::shuffle(ranges.begin(), ranges.end(), random);
    EXPECT_LE((multilaterated(ranges, kTest).fixes[0].p_map - p).norm(), 1e-8);
  }
}

TEST(Multilateration, ScalingAllWeightsDoesNotMoveThePlace) {
  RandomStream random(4, 1);
  std::vector<TagRange> ranges = noisy(kCorners, {20.0, 2.0}, 0.05, random);
  const Eigen::Vector2d p = multilaterated(ranges, kTest).fixes[0].p_map;
  for (TagRange& r : ranges) r.sigma *= 7.0;
  EXPECT_LE((multilaterated(ranges, kTest).fixes[0].p_map - p).norm(), 1e-8);
}

TEST(Multilateration, CovarianceIsTheScatterWithinFivePercent) {
  RandomStream random(5, 1);
  constexpr int kDraws = 2000;
  const Eigen::Vector2d p(5.0, 1.0);
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (int k = 0; k < kDraws; ++k) {
    const TagFixes fixes = multilaterated(noisy(kCorners, p, 0.02, random), kTest);
    const Eigen::Vector2d e = fixes.fixes[0].p_map - p;
    scatter += e * e.transpose() / kDraws;
  }
  const Eigen::Matrix2d bound = multilaterated(exact(kCorners, p, 0.02), kTest).fixes[0].covariance;
  EXPECT_NEAR(std::sqrt(scatter(0, 0) / bound(0, 0)), 1.0, 0.05);
  EXPECT_NEAR(std::sqrt(scatter(1, 1) / bound(1, 1)), 1.0, 0.05);
}

// Spec A, 2.3: the lateral direction is the weak one in mid-corridor.
TEST(Multilateration, DilutionIsThatOfTheSpec) {
  const auto at = [](double x) { return dilutionAt({x, 0.0}, exact(kCorners, {x, 0.0})); };
  EXPECT_NEAR(at(0.0).x, 0.71, 0.01);
  EXPECT_NEAR(at(0.0).y, 0.70, 0.01);
  EXPECT_NEAR(at(5.0).x, 0.56, 0.01);
  EXPECT_NEAR(at(5.0).y, 1.09, 0.01);
  EXPECT_NEAR(at(14.5).x, 0.52, 0.01);
  EXPECT_NEAR(at(14.5).y, 1.88, 0.01);
  const Points three{kCorners[0], kCorners[1], kCorners[2]};
  EXPECT_NEAR(dilutionAt({14.5, 0.0}, exact(three, {14.5, 0.0})).y, 2.30, 0.01);
  EXPECT_TRUE(std::isinf(dilutionAt({14.5, 4.0}, exact(kWall, {14.5, 4.0})).y));
}

TEST(Multilateration, CollinearAnchorsGiveBothMirrorImages) {
  RandomStream random(6, 1);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector2d p = somewhere(random);
    const TagFixes fixes = multilaterated(exact(kWall, p, 0.005), kTest);
    ASSERT_EQ(fixes.verdict, FixVerdict::Ambiguous) << p.transpose();
    const Eigen::Vector2d mirror(p.x(), 8.0 - p.y());
    const auto distance = [&](const Eigen::Vector2d& q) {
      return std::min((fixes.fixes[0].p_map - q).norm(), (fixes.fixes[1].p_map - q).norm());
    };
    EXPECT_LE(distance(p), 1e-7);
    EXPECT_LE(distance(mirror), 1e-7);
    const TagFixes kept = keptInside(fixes, insideRoadway);
    ASSERT_EQ(kept.verdict, FixVerdict::Solved);
    EXPECT_LE((kept.fixes[0].p_map - p).norm(), 1e-7);
  }
}

TEST(Multilateration, TwoAnchorsGiveTwoPlaces) {
  const Points two{kCorners[0], kCorners[1]};
  const Eigen::Vector2d p(9.0, 1.0);
  const TagFixes fixes = multilaterated(exact(two, p), kTest);
  ASSERT_EQ(fixes.count, 2);
  EXPECT_LE((keptInside(fixes, insideRoadway).fixes[0].p_map - p).norm(), 1e-7);
}

TEST(Multilateration, AMapThatRefusesEveryPlaceIsNoJudge) {
  const TagFixes fixes = multilaterated(exact(kWall, {9.0, 1.0}), kTest);
  EXPECT_EQ(keptInside(fixes, [](const TagFix&) { return false; }).count, 2);
}

TEST(Multilateration, OnTheLineItselfTheDistanceFromItIsReportedAsUnknown) {
  const Eigen::Vector2d p(9.0, 4.0);
  const TagFixes fixes = multilaterated(exact(kWall, p), kTest);
  ASSERT_EQ(fixes.count, 1);
  EXPECT_LE((fixes.fixes[0].p_map - p).norm(), 1e-6);
  EXPECT_GT(std::sqrt(fixes.fixes[0].covariance(1, 1)), 0.5);  // sqrt(2 * 12 m * 0.05 m / sqrt 3) = 0.8 m
  EXPECT_LT(std::sqrt(fixes.fixes[0].covariance(0, 0)), 0.05);
}

TEST(Multilateration, NearTheLineTheTruthStaysWithinTheClaimedSigma) {
  RandomStream random(7, 1);
  int beyond = 0;
  constexpr int kDraws = 400;
  for (int k = 0; k < kDraws; ++k) {
    const Eigen::Vector2d p(random.uniform(3.0, 26.0), 4.0 - random.uniform(0.0, 0.5));
    const TagFixes fixes = multilaterated(noisy(kWall, p, 0.05, random), kTest);
    ASSERT_GT(fixes.count, 0);
    double least = 1e9;
    for (const TagFix& fix : fixes.all()) {
      const Eigen::Vector2d e = fix.p_map - p;
      least = std::min(least, e.dot(fix.covariance.llt().solve(e)));
    }
    beyond += least > 13.8 ? 1 : 0;
  }
  EXPECT_LE(beyond, kDraws / 20);  // the distance is not Gaussian there; a twentieth is the promise
}

TEST(Multilateration, OneBadRangeOfEitherSignIsLeftOut) {
  Points anchors = kCorners;
  anchors.push_back({14.5, 4.0});
  RandomStream random(8, 1);
  for (const double outlier : {3.0, -3.0}) {
    for (std::size_t bad = 0; bad < anchors.size(); ++bad) {
      const Eigen::Vector2d p(8.0, 1.0);
      std::vector<TagRange> ranges = noisy(anchors, p, 0.02, random);
      ranges[bad].range += outlier;
      const TagFixes fixes = multilaterated(ranges, kTest);
      ASSERT_GE(fixes.count, 1);
      EXPECT_TRUE(fixes.fixes[0].consistent);
      EXPECT_EQ(fixes.fixes[0].used & (1U << bad), 0U) << bad;
      EXPECT_LT((fixes.fixes[0].p_map - p).norm(), 0.25) << bad;
    }
  }
}

TEST(Multilateration, TwoBadRangesOfEightDoNotMoveThePlaceFar) {
  Points anchors;
  for (int k = 0; k < 8; ++k)
    anchors.push_back(10.0 * Eigen::Vector2d(std::cos(0.785 * k), std::sin(0.785 * k)));
  RandomStream random(9, 1);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector2d p(random.uniform(-5, 5), random.uniform(-5, 5));
    std::vector<TagRange> ranges = noisy(anchors, p, 0.03, random);
    ranges[1].range += 2.0;
    ranges[4].range -= std::min(1.5, ranges[4].range - 0.1);
    EXPECT_LT((multilaterated(ranges, kTest).fixes[0].p_map - p).norm(), 0.2);
  }
}

TEST(Multilateration, ThreeRangesThatDisagreeAreReportedWithALargerCovariance) {
  const Points three{kCorners[0], kCorners[1], kCorners[2]};
  std::vector<TagRange> ranges = exact(three, {10.0, 0.0});
  const Eigen::Matrix2d calm = multilaterated(ranges, kTest).fixes[0].covariance;
  ranges[0].range += 1.0;
  const TagFixes fixes = multilaterated(ranges, kTest);
  ASSERT_GE(fixes.count, 1);
  EXPECT_FALSE(fixes.fixes[0].consistent);
  EXPECT_GT(fixes.fixes[0].covariance.trace(), 5.0 * calm.trace());
}

TEST(Multilateration, TooLittleIsSaidSo) {
  EXPECT_EQ(multilaterated({}, kTest).verdict, FixVerdict::TooFew);
  EXPECT_EQ(multilaterated(exact({{1.0, 1.0}}, {3.0, 0.0}), kTest).verdict, FixVerdict::TooFew);
  const Points same{{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}};
  EXPECT_EQ(multilaterated(exact(same, {3.0, 0.0}), kTest).verdict, FixVerdict::Degenerate);
}

TEST(ResidualTest, FailsTheShareOfGoodFitsItWasToldTo) {
  const ResidualTest test(0.05);
  RandomStream random(10, 1);
  int failed = 0;
  constexpr int kDraws = 4000;
  for (int k = 0; k < kDraws; ++k) {
    double sum = 0.0;
    for (int i = 0; i < 4; ++i) sum += std::pow(random.normal(), 2);
    failed += test.passes(sum, 4) ? 0 : 1;
  }
  EXPECT_NEAR(static_cast<double>(failed) / kDraws, 0.05, 0.014);  // four binomial sigmas
  EXPECT_TRUE(test.passes(1e9, 0));
}

}  // namespace
}  // namespace pos::uwb
