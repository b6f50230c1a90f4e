#include "pos/estimation/mcl.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "pos/core/chi_square.hpp"
#include "support/mcl_drive.hpp"

namespace pos::estimation {
namespace {

using namespace scene;

double nees(const Mcl& mcl, const Sim& sim) {
  const Estimate estimate = *mcl.estimateAt(sim.stamp);
  const Vector<3> error = minus(estimate.T_map_body.planar(), sim.truth);
  return error.dot(estimate.planarCovariance().ldlt().solve(error));
}

}  // namespace

TEST(Mcl, RangesGiveAConsistentCovarianceOverManyRuns) {
  constexpr int kRuns = 80;
  double mean_nees = 0.0;
  for (int run = 1; run <= kRuns; ++run) {
    Sim sim(static_cast<std::uint64_t>(run));
    MclConfig config = rangeConfig();
    config.seed = static_cast<std::uint64_t>(run);
    const Vector<3> off = normals(sim.random);
    config.start.pose = plus(kStart, Vector<3>(0.5 * off[2], 0.5 * off[1], 0.2 * off[0]));
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
  constexpr int kRuns = 20;
  double offset = 0.0;
  double none = 0.0;
  for (std::uint64_t run = 1; run <= kRuns; ++run) {
    Sim sim(run);
    MclConfig config = rangeConfig();
    config.range.bias_sigma = 0.5;
    config.range.bias_time = 200.0;
    config.seed = run;
    Mcl mcl(config, sim.map);
    for (int k = 0; k < 60; ++k) {
      feed(mcl, sim.move());
      for (std::size_t a = 0; a < 4; ++a) {
        feed(mcl, sim.range(a, sim.random.normal(a == 1 ? 0.5 : 0.0, 0.15)));
      }
    }
    const Diagnostics lines = mcl.diagnostics();
    ASSERT_EQ(lines.size(), 7U);
    EXPECT_EQ(lines[4].name, "range_offset_m[2]");
    offset += lines[4].value / kRuns;
    none += lines[3].value / kRuns;
  }
  // Not the whole 0.5 m, since the offset's correlation with the pose is not kept (docs/math/mcl.md): 0.32 m
  // on average over 200 drives, 0.10 m from drive to drive.
  EXPECT_NEAR(offset, 0.32, 4.0 * 0.10 / std::sqrt(kRuns));
  EXPECT_NEAR(none, 0.0, 0.25);
}

}  // namespace pos::estimation
