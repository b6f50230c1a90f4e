/// Is the covariance honest? NEES over independent runs with two-sided chi-square bounds: too small fails as
/// well.

#include <gtest/gtest.h>

#include "pos/core/chi_square.hpp"
#include "pos/estimation/range_odometry.hpp"
#include "support/small_run.hpp"

namespace pos::estimation {
namespace {

using pos::testing::runStamp;
using pos::testing::smallMap;
using pos::testing::smallRun;
using pos::testing::SmallRunOptions;
using pos::testing::truthAt;

/// The filter's noise is the simulator's, so that the filter's own algebra is all that is tested.
RangeOdometryConfig matchedConfig(const SmallRunOptions& options, std::uint64_t seed) {
  RandomStream random(seed, 99);
  RangeOdometryConfig config;
  config.range_sigma = options.range_sigma;
  config.odometry_noise = {options.distance_noise, options.lateral_noise, options.yaw_noise, 0.0, 0.0, 0.0};
  config.start.position_sigma = 0.2;
  config.start.yaw_sigma = 0.1;
  config.acceleration_density = 0.1;
  const Vector<3> error = normals(random).cwiseProduct(Vector<3>(0.2, 0.2, 0.1));
  config.start.pose = plus(truthAt(0.0), error);
  return config;
}

/// NEES of [x y yaw] at the end of one run.
double endNees(const SmallRunOptions& options, const RangeOdometryConfig& config) {
  RangeOdometry estimator(config, smallMap());
  const auto run = smallRun(options);
  for (const Measurement& m : run) (void)estimator.ingest(m);
  const auto estimate = estimator.estimateAt(run.back().stamp);
  const Pose2 truth = truthAt(seconds(run.back().stamp - runStamp(0.0)));
  const Vector<3> e = minus(estimate->T_map_body.planar(), truth);
  return e.dot(estimate->planarCovariance().llt().solve(e));
}

constexpr int kRuns = 200;

}  // namespace

TEST(RangeOdometryStatistics, NeesStaysWithinTwoSidedBoundsOverIndependentRuns) {
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const SmallRunOptions options{.seed = seed, .duration = 12.0};
    sum += endNees(options, matchedConfig(options, seed));
  }
  const Interval bounds = meanChiSquareBounds(0.998, 3.0, kRuns);
  EXPECT_GT(sum / kRuns, bounds.low);
  EXPECT_LT(sum / kRuns, bounds.high);
}

TEST(RangeOdometryStatistics, CalibrationStatesKeepTheCovarianceHonest) {
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    RandomStream random(seed, 100);
    SmallRunOptions options{.seed = seed, .duration = 12.0};
    options.range_scale = random.normal(1.0, 0.02);
    options.range_offset = random.normal(0.0, 0.2);
    options.gyro_bias = random.normal(0.0, 0.02);
    RangeOdometryConfig config = matchedConfig(options, seed);
    config.range_scale.sigma = 0.02;
    config.range_offset.sigma = 0.2;
    config.gyro_bias.sigma = 0.02;
    sum += endNees(options, config);
  }
  const Interval bounds = meanChiSquareBounds(0.998, 3.0, kRuns);
  EXPECT_GT(sum / kRuns, bounds.low);
  EXPECT_LT(sum / kRuns, bounds.high);
}

TEST(RangeOdometryStatistics, AnOverconfidentFilterWouldBeFound) {
  constexpr int kFew = 25;  // its doubts fork without end, and few runs suffice to find it out
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= kFew; ++seed) {
    const SmallRunOptions options{.seed = seed, .duration = 12.0};
    RangeOdometryConfig config = matchedConfig(options, seed);
    config.range_sigma = 0.5 * options.range_sigma;
    sum += endNees(options, config);
  }
  EXPECT_GT(sum / kFew, meanChiSquareBounds(0.998, 3.0, kFew).high);
}

}  // namespace pos::estimation
