/// The particle filter on simulated scans, and its weights against slow double-precision sums.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "pos/core/chi_square.hpp"
#include "pos/estimation/mcl.hpp"
#include "pos/estimation/scan_points.hpp"
#include "support/mcl_scene.hpp"

namespace pos::estimation {
namespace {

const Pose2 kStep{0.3, 0.0, 0.09};
constexpr double kPeriod = 0.5;
constexpr double kScanSigma = 0.02;

MclConfig scanConfig() {
  MclConfig config;
  config.use_ranges = false;
  config.use_scans = true;
  config.start = {.mode = StartMode::Known,
                  .pose = scene::room().T_map_grid * Pose2{4.0, 2.5, 0.0},
                  .position_sigma = 0.2,
                  .yaw_sigma = 0.1};
  return config;
}

struct Drive {
  std::shared_ptr<const map::TunnelMap> map = scene::roomMap();
  Pose2 truth = map->grid->T_map_grid * Pose2{4.0, 2.5, 0.0};
  Stamp stamp = stampFromSeconds(10.0);
  RandomStream random;

  explicit Drive(std::uint64_t seed) : random(seed, 5) {}

  /// On a circle of 3.3 m radius: one motion and one scan a step. The last report is the scan's.
  IngestReport step(Mcl& mcl) {
    truth = truth * kStep;
    stamp += durationFromSeconds(kPeriod);
    const auto odometry = scene::noisyOdometry(kStep, OdometryNoise{}, kPeriod, random);
    EXPECT_EQ(mcl.ingest({stamp, "odometry", odometry}).verdict, Verdict::Applied);
    return mcl.ingest({stamp, "laser", scene::scanFrom(*map->grid, truth, kScanSigma, random)});
  }
  Vector<3> error(const Mcl& mcl) const { return minus(mcl.estimateAt(stamp)->T_map_body.planar(), truth); }
};

}  // namespace

TEST(MclScan, TracksToCentimetresAndDoesNotClaimMoreThanItHas) {
  constexpr int kRuns = 20;
  double mean_nees = 0.0;
  for (int run = 1; run <= kRuns; ++run) {
    Drive drive(static_cast<std::uint64_t>(run));
    MclConfig config = scanConfig();
    config.seed = static_cast<std::uint64_t>(run);
    Mcl mcl(config, drive.map);
    for (int k = 0; k < 25; ++k) EXPECT_EQ(drive.step(mcl).verdict, Verdict::Applied);
    const Vector<3> error = drive.error(mcl);
    EXPECT_LT(error.head<2>().norm(), 0.12) << run;
    mean_nees += error.dot(mcl.estimateAt(drive.stamp)->planarCovariance().ldlt().solve(error)) / kRuns;
  }
  // The scans have no error of the map, which the likelihood allows for: the covariance may only be too wide.
  EXPECT_LT(mean_nees, meanChiSquareBounds(0.999, 3.0, kRuns).high);
  EXPECT_GT(mean_nees, 0.05);
}

TEST(MclScan, FindsItselfAnywhereInTheRoom) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Drive drive(seed);
    MclConfig config = scanConfig();
    config.start.mode = StartMode::Unknown;
    config.seed = seed;
    Mcl mcl(config, drive.map);
    for (int k = 0; k < 30; ++k) (void)drive.step(mcl);
    if (drive.error(mcl).head<2>().norm() < 0.3) ++found;
  }
  EXPECT_GE(found, 5);
}

TEST(MclScan, ScanFromElsewhereIsGatedAndLeavesBeliefUntouched) {
  Drive drive(2);
  Mcl mcl(scanConfig(), drive.map);
  for (int k = 0; k < 10; ++k) (void)drive.step(mcl);
  const Estimate before = *mcl.estimateAt(drive.stamp);
  Scan2D strange = scene::scanFrom(*drive.map->grid, drive.truth, 0.0, drive.random);
  std::fill(strange.ranges.begin(), strange.ranges.end(), 0.6F);
  EXPECT_EQ(mcl.ingest({drive.stamp, "laser", strange}).verdict, Verdict::Gated);
  EXPECT_EQ(mcl.estimateAt(drive.stamp)->covariance, before.covariance);
  std::fill(strange.valid.begin(), strange.valid.end(), std::uint8_t{0});
  EXPECT_EQ(mcl.ingest({drive.stamp, "laser", strange}).verdict, Verdict::Degenerate);
}

TEST(MclScan, SameSeedGivesTheSameBits) {
  const auto run = [] {
    Drive drive(4);
    Mcl mcl(scanConfig(), drive.map);
    for (int k = 0; k < 5; ++k) (void)drive.step(mcl);
    return mcl.estimateAt(drive.stamp)->covariance;
  };
  EXPECT_EQ(run(), run());
}

TEST(BeamPoints, BeamsThatEndTogetherShareOneWeight) {
  Scan2D scan;
  scan.angle_first = 0.0;
  scan.angle_step = 0.001;
  scan.ranges.assign(101, 5.05F);  // an arc of half a metre, all within one square of 2 m
  scan.ranges[100] = 10.05F;
  scan.valid.assign(101, 1);
  scan.valid[50] = 0;
  scan.range_max = 20.0;
  const ScanLikelihood config{.beams = 200, .tempering = 0.5, .correlation_length = 2.0};
  const lidar::BeamPoints points = beamPoints(scan, config);
  ASSERT_EQ(points.size(), 100U);
  EXPECT_FLOAT_EQ(points.weight[0], 0.5F / 99.0F);
  EXPECT_FLOAT_EQ(points.weight[99], 0.5F);
  EXPECT_FLOAT_EQ(points.x[0], 5.05F);
}

TEST(BeamPoints, ChoosesTheWantedNumberEvenlyAmongValidBeams) {
  Scan2D scan;
  scan.angle_step = 0.01;
  scan.range_max = 8.0;
  scan.ranges.assign(300, 3.0F);
  scan.valid.assign(300, 1);
  for (std::size_t i = 0; i < 100; ++i) scan.ranges[i] = 8.0F;  // nothing in reach
  const lidar::BeamPoints points = beamPoints(scan, {.beams = 10, .correlation_length = 0.0});
  ASSERT_EQ(points.size(), 10U);
  EXPECT_NEAR(std::atan2(points.y[0], points.x[0]), 0.01 * 110.0, 1e-5);
  EXPECT_NEAR(std::atan2(points.y[9], points.x[9]), 0.01 * 290.0, 1e-5);
}

}  // namespace pos::estimation
