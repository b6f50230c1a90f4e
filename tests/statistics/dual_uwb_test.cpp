/// The filter of spec A over many seeds on the paper's two drives: the reference figures of section 2.7, an
/// honest covariance, the levels of section 3.4.

#include <gtest/gtest.h>

#include "pos/core/chi_square.hpp"
#include "support/dual_uwb_score.hpp"

namespace pos::estimation {
namespace {

using pos::testing::DualUwbRunOptions;
using pos::testing::DualUwbScore;
using Variant = DualUwbConfig::Variant;

constexpr int kRuns = 100;

enum class Drive { DoubleLane, QuarterTurn };

DualUwbScore overSeeds(Drive drive, DualUwbRunOptions options,
                       const std::function<void(DualUwbConfig&)>& edit = {}) {
  const bool lane = drive == Drive::DoubleLane;
  const auto site = lane ? pos::testing::doubleLaneSite() : pos::testing::quarterTurnSite();
  const auto path = lane ? pos::testing::doubleLaneDrive() : pos::testing::quarterTurnDrive();
  options.corner_rock = !lane;
  std::vector<DualUwbScore> scores;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    options.seed = seed;
    DualUwbConfig config = pos::testing::dualUwbConfig(options);
    if (edit) edit(config);
    scores.push_back(pos::testing::scored(config, site, path, pos::testing::dualUwbRun(site, path, options)));
  }
  return pos::testing::pooled(scores);
}

/// Mean over runs of the run's mean NEES: bounded like the mean of as many independent values. The values of
/// one run are not independent of each other, and count as one.
void expectHonest(const DualUwbScore& score) {
  const Interval bounds = meanChiSquareBounds(0.95, 3.0, kRuns);
  EXPECT_GT(score.nees, bounds.low);
  EXPECT_LT(score.nees, bounds.high);
}

struct Reference {
  Drive drive;
  double sigma;  ///< m
  double x;      ///< m, rms
  double y;
  double yaw_deg;
};

TEST(DualUwbStatistics, FilterReproducesTheReferenceFiguresOfTheSpec) {
  // spec 2.7; "within 25 % or better"
  for (const Reference& reference : {Reference{Drive::DoubleLane, 0.02, 0.007, 0.006, 0.89},
                                     Reference{Drive::DoubleLane, 0.05, 0.016, 0.015, 1.87},
                                     Reference{Drive::DoubleLane, 0.10, 0.029, 0.029, 3.17},
                                     Reference{Drive::QuarterTurn, 0.05, 0.017, 0.011, 1.90},
                                     Reference{Drive::QuarterTurn, 0.10, 0.031, 0.021, 3.19}}) {
    DualUwbRunOptions options;
    options.range_sigma = reference.sigma;
    const DualUwbScore score = overSeeds(reference.drive, options);
    EXPECT_LE(score.x, 1.25 * reference.x);
    EXPECT_LE(score.y, 1.25 * reference.y);
    EXPECT_LE(degrees(score.yaw), 1.25 * reference.yaw_deg);
    expectHonest(score);
  }
}

TEST(DualUwbStatistics, GyroKeepsTheYawWithinNineTenthsOfADegree) {
  DualUwbRunOptions options;
  options.gyro_rate = 100.0;
  options.gyro_noise = 0.01;
  options.gyro_bias = 0.005;
  for (const Drive drive : {Drive::DoubleLane, Drive::QuarterTurn}) {
    const DualUwbScore score = overSeeds(drive, options, [](DualUwbConfig& config) {
      config.variant = Variant::FilterGyro;
      config.gyro_noise = 0.001;  // 0.01 rad/s at 100 Hz
      config.gyro_bias = {0.0, 0.01, 1e-5};
    });
    EXPECT_LE(degrees(score.yaw), 0.9);
    expectHonest(score);
  }
}

TEST(DualUwbStatistics, RigidEpochsAreAsGoodAsTheirCovarianceSays) {
  const DualUwbScore score =
      overSeeds(Drive::DoubleLane, {}, [](DualUwbConfig& config) { config.variant = Variant::Rigid; });
  expectHonest(score);
  EXPECT_LE(degrees(score.yaw), 3.6);  // spec 2.7, raw yaw
}

// Spec A5: three anchors for good, two for ten seconds.
TEST(DualUwbStatistics, AnchorsMayDropOut) {
  DualUwbRunOptions options;
  options.fault = [](double t, int, AnchorId anchor, double range) {
    const bool lost = (t > 10.0 && anchor == 3) || (t > 12.0 && t < 22.0 && anchor == 4);
    return lost ? -1.0 : range;
  };
  const DualUwbScore score = overSeeds(Drive::DoubleLane, options);
  EXPECT_LE(score.x, 0.03);
  EXPECT_LE(score.y, 0.03);
  expectHonest(score);
}

TEST(DualUwbStatistics, AnOverconfidentFilterWouldBeFound) {
  const DualUwbScore score = overSeeds(Drive::DoubleLane, {.range_sigma = 0.1},
                                       [](DualUwbConfig& config) { config.range_sigma = 0.05; });
  EXPECT_GT(score.nees, meanChiSquareBounds(0.95, 3.0, kRuns).high);
}

}  // namespace
}  // namespace pos::estimation
