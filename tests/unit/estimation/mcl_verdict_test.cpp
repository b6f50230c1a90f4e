/// What the particle filter says of each measurement, and what a measurement may not do.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "pos/core/error.hpp"
#include "support/mcl_drive.hpp"

namespace pos::estimation {
namespace {

using namespace scene;

}  // namespace

TEST(Mcl, GatedMeasurementLeavesBeliefUntouched) {
  Sim sim(2);
  Mcl mcl(rangeConfig(), sim.map);
  drive(mcl, sim, 10);
  const Estimate before = *mcl.estimateAt(sim.stamp);
  const IngestReport report = mcl.ingest(sim.range(0, -6.0));
  EXPECT_EQ(report.verdict, Verdict::Gated);
  EXPECT_NEAR(report.innovation, -6.0, 0.7);
  EXPECT_GT(report.nis, 100.0);
  const Estimate after = *mcl.estimateAt(sim.stamp);
  EXPECT_EQ(before.T_map_body.translation, after.T_map_body.translation);
  EXPECT_EQ(before.covariance, after.covariance);
  Sim later = sim;
  later.stamp += durationFromSeconds(0.1);
  EXPECT_EQ(mcl.ingest(later.range(0, 9.0)).verdict, Verdict::Gated);
  EXPECT_EQ(mcl.estimateAt(sim.stamp)->covariance, before.covariance);
}

TEST(Mcl, OrderOfRangesWithOneStampDoesNotMatter) {
  Sim sim(9);
  Mcl one(rangeConfig(), sim.map);
  Mcl two(rangeConfig(), sim.map);
  const Measurement move = sim.move();
  feed(one, move);
  feed(two, move);
  const std::vector<Measurement> ranges = sim.ranges();
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    feed(one, ranges[i]);
    feed(two, ranges[ranges.size() - 1 - i]);
  }
  EXPECT_LT(minus(meanOf(one, sim.stamp), meanOf(two, sim.stamp)).norm(), 1e-4);
}

TEST(Mcl, RangeRepeatedWithoutDrivingAddsLittle) {
  Sim sim(9);
  MclConfig config = rangeConfig();
  config.range.correlation_length = 2.5;
  const auto sigmaAfter = [&](int repeats) {
    Mcl mcl(config, sim.map);
    mcl.reset(sim.stamp, belief(sim.truth, 0.5, 0.01));
    for (int k = 0; k < repeats; ++k) feed(mcl, sim.range(0, 0.0));
    return std::sqrt(mcl.estimateAt(sim.stamp)->planarCovariance().topLeftCorner<2, 2>().determinant());
  };
  const double once = sigmaAfter(1);
  EXPECT_LT(sigmaAfter(10), once);
  EXPECT_GT(sigmaAfter(10), 0.85 * once);  // ten independent ones would give a third
}

TEST(Mcl, EveryVerdictHasItsCause) {
  Sim sim(1);
  MclConfig config = rangeConfig();
  Mcl mcl(config, sim.map);
  EXPECT_FALSE(mcl.estimateAt(sim.stamp));
  EXPECT_EQ(mcl.ingest({sim.stamp, "imu", ImuSample{}}).verdict, Verdict::Unsupported);
  EXPECT_EQ(mcl.ingest({sim.stamp, "laser", Scan2D{}}).verdict, Verdict::Unsupported);
  EXPECT_FALSE(mcl.estimateAt(sim.stamp));
  Measurement unknown = sim.range(0, 0.0);
  std::get<BeaconRange>(unknown.reading).anchor = 99;
  EXPECT_EQ(mcl.ingest(unknown).verdict, Verdict::Degenerate);
  Measurement bad = sim.range(0, 0.0);
  std::get<BeaconRange>(bad.reading).range = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(mcl.ingest(bad).verdict, Verdict::Degenerate);
  EXPECT_EQ(mcl.ingest(sim.range(0, 0.0)).verdict, Verdict::Applied);
  Measurement old = sim.range(1, 0.0);
  old.stamp -= Duration{1};
  EXPECT_EQ(mcl.ingest(old).verdict, Verdict::TooOld);
  EXPECT_FALSE(mcl.estimateAt(old.stamp));
  EXPECT_EQ(mcl.estimateAt(sim.stamp + durationFromSeconds(1.0))->covariance,
            mcl.estimateAt(sim.stamp)->covariance);
}

TEST(Mcl, RefusesAMapThatLacksWhatTheConfigurationUses) {
  const auto empty = std::make_shared<const map::TunnelMap>();
  EXPECT_THROW(Mcl(rangeConfig(), empty), ConfigError);
  MclConfig scans = rangeConfig();
  scans.use_ranges = false;
  EXPECT_THROW(Mcl(scans, scene::anchors()), ConfigError);  // neither kind
  scans.use_scans = true;
  EXPECT_THROW(Mcl(scans, scene::anchors()), ConfigError);  // no grid
  MclConfig numbers = rangeConfig();
  numbers.range.sigma = 0.0;
  EXPECT_THROW(Mcl(numbers, scene::anchors()), ConfigError);
}

}  // namespace pos::estimation
