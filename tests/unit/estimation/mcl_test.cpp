#include "pos/estimation/mcl.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "pos/core/chi_square.hpp"
#include "pos/core/error.hpp"
#include "support/mcl_scene.hpp"

namespace pos::estimation {
namespace {

using scene::noisyOdometry;
using scene::rangeTo;

const Pose2 kStart{5.0, 2.0, 0.3};
const Pose2 kStep{0.4, 0.0, 0.05};
constexpr double kPeriod = 0.5;

MclConfig rangeConfig() {
  MclConfig config;
  config.start = {.mode = StartMode::Known, .pose = kStart, .position_sigma = 0.5, .yaw_sigma = 0.2};
  config.range = {.sigma = 0.15, .outlier_probability = 0.05, .range_max = 40.0, .correlation_length = 0.0};
  config.particles = {.min = 1500, .max = 5000};
  return config;
}

struct Sim {
  std::shared_ptr<const map::TunnelMap> map = scene::anchors();
  Pose2 truth = kStart;
  Stamp stamp = stampFromSeconds(100.0);
  OdometryNoise noise;
  double range_sigma = 0.15;
  RandomStream random{1, 77};

  explicit Sim(std::uint64_t seed) : random(seed, 77) {}

  Measurement move() {
    truth = truth * kStep;
    stamp += durationFromSeconds(kPeriod);
    return {stamp, "odometry", noisyOdometry(kStep, noise, kPeriod, random)};
  }
  Measurement range(std::size_t anchor, double error) const {
    return {stamp, "uwb", rangeTo(map->anchors[anchor], truth, error)};
  }
  std::vector<Measurement> ranges() {
    std::vector<Measurement> all;
    for (std::size_t a = 0; a < map->anchors.size(); ++a)
      all.push_back(range(a, random.normal(0.0, range_sigma)));
    return all;
  }
};

void feed(Mcl& mcl, const Measurement& measurement) {
  EXPECT_NE(mcl.ingest(measurement).verdict, Verdict::Degenerate);
}

void drive(Mcl& mcl, Sim& sim, int steps) {
  for (int k = 0; k < steps; ++k) {
    feed(mcl, sim.move());
    for (const Measurement& range : sim.ranges()) feed(mcl, range);
  }
}

Pose2 meanOf(const Mcl& mcl, Stamp stamp) {
  return mcl.estimateAt(stamp)->T_map_body.planar();
}

double nees(const Mcl& mcl, const Sim& sim) {
  const Estimate estimate = *mcl.estimateAt(sim.stamp);
  const Vector<3> error = minus(estimate.T_map_body.planar(), sim.truth);
  return error.dot(estimate.planarCovariance().ldlt().solve(error));
}

Belief<Pose2> belief(const Pose2& mean, double position, double yaw) {
  return {mean, Vector<3>(position * position, position * position, yaw * yaw).asDiagonal()};
}

}  // namespace

TEST(Mcl, RangesGiveAConsistentCovarianceOverManyRuns) {
  constexpr int kRuns = 80;
  double mean_nees = 0.0;
  for (int run = 1; run <= kRuns; ++run) {
    Sim sim(static_cast<std::uint64_t>(run));
    MclConfig config = rangeConfig();
    config.seed = static_cast<std::uint64_t>(run);
    config.start.pose = plus(kStart, Vector<3>(sim.random.normal(0.0, 0.5), sim.random.normal(0.0, 0.5),
                                               sim.random.normal(0.0, 0.2)));
    Mcl mcl(config, sim.map);
    drive(mcl, sim, 20);
    mean_nees += nees(mcl, sim) / kRuns;
    EXPECT_LT(minus(meanOf(mcl, sim.stamp), sim.truth).head<2>().norm(), 0.5);
  }
  const Interval bounds = meanChiSquareBounds(0.9999, 3.0, kRuns);
  EXPECT_GT(mean_nees, bounds.low);
  EXPECT_LT(mean_nees, bounds.high);
}

TEST(Mcl, AgreesWithAKalmanFilterInTheLinearGaussianLimit) {
  // Two anchors half a kilometre away along the axes: a range is linear in x, or y, over a few metres. The
  // heading is known, so the odometry is linear too.
  auto far = std::make_shared<map::TunnelMap>();
  far->anchors = {{.id = 1, .name = "east", .p_map = {500.0, 0.0, 0.0}},
                  {.id = 2, .name = "north", .p_map = {0.0, 500.0, 0.0}}};
  MclConfig config = rangeConfig();
  config.range = {.sigma = 0.3, .outlier_probability = 1e-6, .range_max = 1000.0, .correlation_length = 0.0};
  config.odometry_noise = {.distance_per_sqrt_m = 0.2,
                           .lateral_per_sqrt_m = 0.1,
                           .yaw_per_sqrt_m = 0.0,
                           .yaw_per_sqrt_rad = 0.0,
                           .yaw_per_sqrt_s = 0.0,
                           .position_per_sqrt_s = 0.0};
  config.particles = {.min = 40000, .max = 40000};
  Mcl mcl(config, far);
  Stamp stamp = stampFromSeconds(1.0);
  mcl.reset(stamp, belief({0.0, 0.0, 0.0}, 1.0, 0.0));
  Eigen::Vector2d x = Eigen::Vector2d::Zero();
  Eigen::Vector2d P = Eigen::Vector2d::Ones();  // the axes never mix
  RandomStream random(8, 8);
  for (int k = 0; k < 6; ++k) {
    stamp += durationFromSeconds(1.0);
    feed(mcl, {stamp, "odometry", OdometryIncrement{{0.5, 0.0, 0.0}, {}, {}}});
    x.x() += 0.5;
    P += Eigen::Vector2d(0.04, 0.01) * 0.5;
    for (int axis = 0; axis < 2; ++axis) {
      const double z = random.normal(axis == 0 ? 0.5 * (k + 1) : 0.0, 0.3);  // the coordinate measured
      BeaconRange range;
      range.anchor = axis + 1;
      range.range = std::hypot(500.0 - z, x[1 - axis]);
      feed(mcl, {stamp, "uwb", range});
      const double K = P[axis] / (P[axis] + 0.09);
      x[axis] += K * (z - x[axis]);
      P[axis] *= 1.0 - K;
    }
    const Estimate estimate = *mcl.estimateAt(stamp);
    for (int axis = 0; axis < 2; ++axis) {
      // Weighted and resampled six times: allow the noise of a quarter of the particles, five sigma.
      EXPECT_NEAR(estimate.T_map_body.translation[axis], x[axis], 5.0 * std::sqrt(P[axis] / 10000.0))
          << k << axis;
      EXPECT_NEAR(estimate.covariance(axis, axis) / P[axis], 1.0, 5.0 * std::sqrt(2.0 / 10000.0))
          << k << axis;
    }
  }
}

TEST(Mcl, SameSeedGivesTheSameBitsAndAnotherSeedDoesNot) {
  const auto run = [](std::uint64_t seed) {
    Sim sim(5);
    MclConfig config = rangeConfig();
    config.seed = seed;
    Mcl mcl(config, sim.map);
    drive(mcl, sim, 15);
    return *mcl.estimateAt(sim.stamp);
  };
  const Estimate a = run(1);
  const Estimate b = run(1);
  const Estimate c = run(2);
  EXPECT_EQ(a.T_map_body.translation, b.T_map_body.translation);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_NE(a.T_map_body.translation, c.T_map_body.translation);
}

TEST(Mcl, ResetForgetsEverythingBefore) {
  Sim first(5);
  Mcl used(rangeConfig(), first.map);
  drive(used, first, 5);
  Mcl fresh(rangeConfig(), first.map);
  const Belief<Pose2> prior = belief(first.truth, 0.3, 0.1);
  used.reset(first.stamp, prior);
  fresh.reset(first.stamp, prior);
  Sim second = first;
  drive(used, first, 5);
  drive(fresh, second, 5);
  EXPECT_EQ(used.estimateAt(first.stamp)->T_map_body.translation,
            fresh.estimateAt(first.stamp)->T_map_body.translation);
}

TEST(Mcl, FindsAnUnknownHeadingFromRangesAndMotion) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Sim sim(seed);
    MclConfig config = rangeConfig();
    config.start.mode = StartMode::UnknownHeading;
    config.seed = seed;
    Mcl mcl(config, sim.map);
    drive(mcl, sim, 25);
    EXPECT_LT(std::abs(minus(meanOf(mcl, sim.stamp), sim.truth)[2]), 0.15) << seed;
  }
}

TEST(Mcl, FindsItselfFromTheRingOfTheFirstRange) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Sim sim(seed);
    MclConfig config = rangeConfig();
    config.start.mode = StartMode::Unknown;
    config.particles = {.min = 1500, .max = 20000};
    config.seed = seed;
    Mcl mcl(config, sim.map);
    EXPECT_EQ(mcl.ingest(sim.move()).verdict, Verdict::NotInitialised);
    EXPECT_FALSE(mcl.estimateAt(sim.stamp));
    drive(mcl, sim, 30);
    EXPECT_LT(minus(meanOf(mcl, sim.stamp), sim.truth).head<2>().norm(), 0.4) << seed;
  }
}

TEST(Mcl, RecoversFromBeingCarriedElsewhere) {
  Sim sim(3);
  MclConfig config = rangeConfig();
  config.particles = {.min = 1500, .max = 20000};
  Mcl mcl(config, sim.map);
  drive(mcl, sim, 20);
  sim.truth = {14.0, 11.0, -2.0};  // no odometry told of it
  drive(mcl, sim, 40);
  EXPECT_LT(minus(meanOf(mcl, sim.stamp), sim.truth).head<2>().norm(), 0.5);
}

TEST(Mcl, StaysOnCourseWhenOneAnchorIsMetresShort) {
  Sim sim(4);
  Mcl mcl(rangeConfig(), sim.map);
  for (int k = 0; k < 40; ++k) {
    feed(mcl, sim.move());
    for (std::size_t a = 0; a < 3; ++a) feed(mcl, sim.range(a, sim.random.normal(0.0, 0.15)));
    feed(mcl, sim.range(3, -8.0));
  }
  EXPECT_LT(minus(meanOf(mcl, sim.stamp), sim.truth).head<2>().norm(), 0.4);
}

TEST(Mcl, TracksAConstantOffsetOfOneAnchor) {
  Sim sim(6);
  MclConfig config = rangeConfig();
  config.range.bias_sigma = 0.5;
  config.range.bias_time = 200.0;
  Mcl mcl(config, sim.map);
  for (int k = 0; k < 60; ++k) {
    feed(mcl, sim.move());
    for (std::size_t a = 0; a < 4; ++a) feed(mcl, sim.range(a, sim.random.normal(a == 1 ? 0.5 : 0.0, 0.15)));
  }
  const Diagnostics lines = mcl.diagnostics();
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_EQ(lines[4].name, "range_offset_m[2]");
  EXPECT_NEAR(lines[4].value, 0.5, 0.25);
  EXPECT_NEAR(lines[3].value, 0.0, 0.25);
}

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

TEST(OdometrySigma, VariancesOfTwoHalvesAddUpToTheWhole) {
  const OdometryNoise noise;
  const Vector<3> whole = incrementSigma(noise, {1.2, 0.0, 0.4}, 2.0);
  const Vector<3> half = incrementSigma(noise, {0.6, 0.0, 0.2}, 1.0);
  EXPECT_TRUE(whole.cwiseAbs2().isApprox(2.0 * half.cwiseAbs2(), 1e-12));
  EXPECT_NEAR(whole[0], std::sqrt(0.03 * 0.03 * 1.2 + 0.001 * 0.001 * 2.0), 1e-12);
  EXPECT_EQ(incrementSigma(noise, {}, 0.0), (Vector<3>::Zero()));
}

}  // namespace pos::estimation
