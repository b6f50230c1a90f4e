#include "pos/estimation/range_odometry.hpp"

#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "support/small_run.hpp"

namespace pos::estimation {
namespace {

using pos::testing::runStamp;
using pos::testing::smallMap;
using pos::testing::smallRun;
using pos::testing::SmallRunOptions;
using pos::testing::truthAt;

RangeOdometryConfig configAtTruth() {
  RangeOdometryConfig config;
  config.start.pose = truthAt(0.0);
  config.acceleration_density = 0.3;
  return config;
}

double errorAt(const Estimator& estimator, Stamp stamp) {
  const auto estimate = estimator.estimateAt(stamp);
  if (!estimate) return 1e9;
  const Pose2 truth = truthAt(seconds(stamp - runStamp(0.0)));
  return (estimate->T_map_body.translation.head<2>() - truth.translation()).norm();
}

/// RMS position error after `skip` seconds.
double rmsError(Estimator& estimator, const std::vector<Measurement>& run, double skip) {
  double squares = 0.0;
  int count = 0;
  for (const Measurement& m : run) {
    (void)estimator.ingest(m);
    if (m.stamp < runStamp(skip)) continue;
    const double e = errorAt(estimator, m.stamp);
    squares += e * e;
    ++count;
  }
  return std::sqrt(squares / count);
}

double diagnostic(const Estimator& estimator, const std::string& name) {
  for (const NamedValue& value : estimator.diagnostics()) {
    if (value.name == name) return value.value;
  }
  ADD_FAILURE() << "no diagnostic " << name;
  return 0.0;
}

}  // namespace

TEST(RangeOdometry, TracksFromAKnownStart) {
  RangeOdometry estimator(configAtTruth(), smallMap());
  EXPECT_LT(rmsError(estimator, smallRun({.duration = 60.0}), 0.0), 0.12);
  EXPECT_EQ(diagnostic(estimator, "gate_openings"), 0.0);
}

TEST(RangeOdometry, FindsItsHeadingFromAnyStart) {
  for (const double wrong : {0.0, 0.5 * kPi, kPi}) {
    RangeOdometryConfig config = configAtTruth();
    config.start.mode = StartMode::UnknownHeading;
    config.start.pose.yaw = wrapAngle(config.start.pose.yaw + wrong);
    RangeOdometry estimator(config, smallMap());
    EXPECT_LT(rmsError(estimator, smallRun({.duration = 60.0}), 8.0), 0.15) << wrong;
    EXPECT_LE(diagnostic(estimator, "hypotheses"),
              4.0);  // a doubted range may have forked the winner just now
  }
}

TEST(RangeOdometry, FindsItsPlaceFromRangesAlone) {
  RangeOdometryConfig config = configAtTruth();
  config.start.mode = StartMode::Unknown;
  RangeOdometry estimator(config, smallMap());
  EXPECT_LT(rmsError(estimator, smallRun({.duration = 60.0}), 8.0), 0.15);
}

TEST(RangeOdometry, EstimatesScaleOffsetAndGyroBias) {
  RangeOdometryConfig config = configAtTruth();
  config.range_scale.sigma = 0.05;
  config.range_offset.sigma = 0.5;
  config.gyro_bias.sigma = 0.01;
  RangeOdometry estimator(config, smallMap());
  SmallRunOptions options{.duration = 300.0, .gyro_bias = 0.006, .range_scale = 1.05, .range_offset = 0.3};
  EXPECT_LT(rmsError(estimator, smallRun(options), 60.0), 0.12);
  EXPECT_NEAR(diagnostic(estimator, "range_scale"), 1.05, 0.005);
  EXPECT_NEAR(diagnostic(estimator, "range_offset_m"), 0.3, 0.06);
  EXPECT_NEAR(diagnostic(estimator, "gyro_bias_rad_per_s"), 0.006, 0.001);
}

TEST(RangeOdometry, EstimatesTheLatencyOfItsRangesAgainstOdometry) {
  RangeOdometryConfig config = configAtTruth();
  config.latency = {.value = 0.0, .sigma = 0.2};
  RangeOdometry estimator(config, smallMap());
  EXPECT_LT(rmsError(estimator, smallRun({.duration = 120.0, .latency = 0.25}), 40.0), 0.12);
  EXPECT_NEAR(diagnostic(estimator, "latency_s"), 0.25, 0.05);
}

TEST(RangeOdometry, SurvivesATwentyPercentShareOfOutliersOfBothSigns) {
  RangeOdometry clean(configAtTruth(), smallMap());
  RangeOdometry dirty(configAtTruth(), smallMap());
  const double without = rmsError(clean, smallRun({.duration = 120.0}), 5.0);
  const double with = rmsError(dirty, smallRun({.duration = 120.0, .outlier_share = 0.2}), 5.0);
  EXPECT_LT(with, 1.35 * without);
}

TEST(RangeOdometry, RecoversAfterBeingCarriedAway) {
  RangeOdometryConfig config = configAtTruth();
  config.start.pose = truthAt(12.0);  // sure of the wrong place
  RangeOdometry estimator(config, smallMap());
  const auto run = smallRun({.duration = 90.0});
  int gated = 0;
  for (const Measurement& m : run) gated += estimator.ingest(m).verdict == Verdict::Gated ? 1 : 0;
  EXPECT_GT(gated, 0);
  EXPECT_LT(errorAt(estimator, run.back().stamp), 0.3);
  EXPECT_GE(diagnostic(estimator, "gate_openings"), 1.0);
}

TEST(RangeOdometry, OneAnchorFarTooShortIsGatedForeverWithoutHarm) {
  RangeOdometryConfig config = configAtTruth();
  RangeOdometry estimator(config, smallMap());
  int gated = 0;
  double worst = 0.0;
  for (Measurement m : smallRun({.duration = 60.0})) {
    if (auto* range = std::get_if<BeaconRange>(&m.reading); range != nullptr && range->anchor == 1) {
      range->range = std::max(0.3, range->range - 6.0);
    }
    gated += estimator.ingest(m).verdict == Verdict::Gated ? 1 : 0;
    worst = std::max(worst, errorAt(estimator, m.stamp));
  }
  EXPECT_GT(gated, 140);
  EXPECT_LT(worst, 0.5);
  EXPECT_EQ(diagnostic(estimator, "gate_openings"), 0.0);
}

TEST(RangeOdometry, KeepsGoingThroughAHoleInTheOdometryAndSaysItIsLessSure) {
  RangeOdometry estimator(configAtTruth(), smallMap());
  const auto run = smallRun({.duration = 20.0});
  for (const Measurement& m : run) (void)estimator.ingest(m);
  const auto now = estimator.estimateAt(run.back().stamp);
  const auto later = estimator.estimateAt(run.back().stamp + durationFromSeconds(4.0));
  ASSERT_TRUE(now && later);
  EXPECT_GT(later->covariance(0, 0), 4.0 * now->covariance(0, 0));
}

TEST(RangeOdometry, ConstantVelocityMotionNeedsNoOdometry) {
  RangeOdometryConfig config = configAtTruth();
  config.motion = RangeOdometryConfig::Motion::ConstantVelocity;
  config.start.mode = StartMode::Unknown;
  config.heading_hypotheses = 1;
  config.max_speed = 3.0;
  config.tags = {{0, {0.0, 0.0, 1.0}}};
  RangeOdometry estimator(config, smallMap());
  EXPECT_LT(rmsError(estimator, smallRun({.duration = 60.0, .tag_body = {0.0, 0.0, 1.0}}), 5.0), 0.25);
}

TEST(RangeOdometry, NeedsAnchors) {
  EXPECT_THROW(RangeOdometry(configAtTruth(), std::make_shared<map::TunnelMap>()), ConfigError);
}

TEST(RangeOdometry, SaysWhyAReadingWasNotUsed) {
  RangeOdometry estimator(configAtTruth(), smallMap());
  BeaconRange stranger;
  stranger.anchor = 42;
  stranger.range = 3.0;
  const IngestReport report = estimator.ingest({runStamp(1.0), "uwb", stranger});
  EXPECT_EQ(report.verdict, Verdict::Degenerate);
  EXPECT_EQ(report.reason, "the map has no anchor of this id");
}

}  // namespace pos::estimation
