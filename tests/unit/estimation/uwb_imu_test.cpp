#include "pos/estimation/uwb_imu.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "pos/core/error.hpp"
#include "support/circle_run.hpp"

namespace pos::estimation {
namespace {

using pos::testing::circleConfig;
using pos::testing::circleMap;
using pos::testing::CircleOptions;
using pos::testing::circlePose;
using pos::testing::circleRun;
using pos::testing::circleStamp;
using Form = filters::RobustConfig::Form;
using Variant = UwbImuConfig::Variant;

/// What happened to one run.
struct Told {
  double mean = 0.0;  ///< m, horizontal
  double worst = 0.0;
  double last = 0.0;
  double sigma = 0.0;  ///< m, at the end
  int gated = 0;
  std::vector<std::string> events;
};

Told driven(Estimator& estimator, const std::vector<Measurement>& log) {
  Told told;
  int count = 0;
  for (const Measurement& m : log) {
    const IngestReport report = estimator.ingest(m);
    told.gated += report.verdict == Verdict::Gated ? 1 : 0;
    if (!report.event.empty()) told.events.emplace_back(report.event);
    const auto estimate = estimator.estimateAt(m.stamp);
    if (!estimate) continue;
    const Pose3 truth = circlePose(seconds(m.stamp - circleStamp(0.0)));
    told.last = (estimate->T_map_body.translation - truth.translation).head<2>().norm();
    told.mean += told.last;
    told.worst = std::max(told.worst, told.last);
    told.sigma = std::sqrt(estimate->covariance.topLeftCorner<2, 2>().trace());
    ++count;
  }
  told.mean /= std::max(count, 1);
  return told;
}

Told driven(const UwbImuConfig& config, const std::vector<Measurement>& log) {
  const auto estimator = makeUwbImu(validated(config), circleMap());
  return driven(*estimator, log);
}

/// Changes every range of the log.
std::vector<Measurement> withRanges(std::vector<Measurement> log,
                                    const std::function<void(double, BeaconRange&)>& change) {
  for (Measurement& m : log) {
    if (auto* range = std::get_if<BeaconRange>(&m.reading))
      change(seconds(m.stamp - circleStamp(0.0)), *range);
  }
  return log;
}

CircleOptions perfect() {
  CircleOptions options;
  options.range_sigma = 1e-9;
  options.unit_errors = 0.0;
  return options;
}

TEST(UwbImu, ReproducesAPerfectRun) {
  for (const auto& [rate, bound] : {std::pair{100, 1e-4}, std::pair{1000, 1e-6}}) {
    CircleOptions options = perfect();
    options.imu_rate = rate;
    options.uwb_every = 1000000;  // the inertial unit alone, from the start
    EXPECT_LT(driven(circleConfig(CircleOptions{}), circleRun(options)).worst, bound) << rate;
  }
}

TEST(UwbImu, EveryVariantFollowsTheCircle) {
  CircleOptions options;
  options.duration = 25.0;
  const auto log = circleRun(options);
  UwbImuConfig config = circleConfig(options);
  std::vector<double> means;
  for (const Variant variant : {Variant::Ekf, Variant::Ukf, Variant::Eskf}) {
    config.variant = variant;
    const Told told = driven(config, log);
    EXPECT_LT(told.worst, 0.6);
    means.push_back(told.mean);
  }
  // The same model and data: the paper's gaps of 40 % are no property of the filters.
  EXPECT_NEAR(means[0] / means[2], 1.0, 0.02);
  EXPECT_NEAR(means[1] / means[2], 1.0, 0.02);
  config.variant = Variant::UwbOnly;
  const Told alone = driven(config, log);
  EXPECT_GT(alone.mean, 1.5 * means[2]);
  EXPECT_LT(alone.mean, 0.6);
}

TEST(UwbImu, WorldMovedAndTurnedMovesAndTurnsTheAnswer) {
  CircleOptions options;
  options.duration = 15.0;
  const auto log = circleRun(options);
  UwbImuConfig config = circleConfig(options);
  const auto here = makeUwbImu(config, circleMap());
  const Pose3 moved = Pose3::fromXyzYawPitchRoll(300.0, -200.0, 40.0, 0.7, 0, 0);
  auto map = std::make_shared<map::TunnelMap>(*circleMap());
  for (map::Anchor& anchor : map->anchors) anchor.p_map = moved * anchor.p_map;
  config.start.pose = (moved * Pose3::fromPlanar(config.start.pose)).planar();
  config.height = 40.0;
  const auto there = makeUwbImu(config, map);
  for (const Measurement& m : log) {
    (void)here->ingest(m);
    (void)there->ingest(m);
  }
  const Pose3 a = here->estimateAt(log.back().stamp)->T_map_body;
  const Pose3 b = there->estimateAt(log.back().stamp)->T_map_body;
  EXPECT_LT((minus(moved * a, b)).norm(), 1e-9);
}

TEST(UwbImu, OrderOfAnchorsAtOneMomentHardlyMatters) {
  CircleOptions options;
  options.duration = 15.0;
  auto log = circleRun(options);
  const UwbImuConfig config = circleConfig(options);
  const auto forward = makeUwbImu(config, circleMap());
  for (const Measurement& m : log) (void)forward->ingest(m);
  // Within each epoch of four.
  for (auto it = log.begin(); it != log.end();) {
    const auto end = std::find_if(
        it, log.end(), [&](const Measurement& m) { return m.stamp != it->stamp || m.sensor != it->sensor; });
    std::reverse(it, end);
    it = end;
  }
  const auto backward = makeUwbImu(config, circleMap());
  for (const Measurement& m : log) (void)backward->ingest(m);
  const auto difference = minus(forward->estimateAt(log.back().stamp)->T_map_body,
                                backward->estimateAt(log.back().stamp)->T_map_body);
  EXPECT_LT(difference.norm(), 2e-3);  // each is linearised where the one before left the state
}

TEST(UwbImu, ReadingsBetweenSamplesAreMetWhereTheyWere) {
  for (const double phase : {0.0031, -0.0062}) {
    CircleOptions options = perfect();
    options.duration = 30.0;
    options.uwb_phase = phase;
    UwbImuConfig config = circleConfig(options);
    config.range_sigma = 0.05;
    EXPECT_LT(driven(config, circleRun(options)).worst, 2e-3) << phase;
  }
}

TEST(UwbImu, LateReadingsGiveWhatReadingsInOrderGive) {
  CircleOptions options;
  options.duration = 12.0;
  options.uwb_phase = 0.0031;
  const auto log = circleRun(options);
  UwbImuConfig config = circleConfig(options);
  config.robust.form = Form::Huber;
  const auto in_order = makeUwbImu(config, circleMap());
  for (const Measurement& m : log) (void)in_order->ingest(m);
  config.lag = 0.3;
  const auto late = makeUwbImu(config, circleMap());
  // Every range arrives 0.2 s after the samples it belongs to.
  auto arriving = log;
  const auto arrival = [](const Measurement& m) {
    return m.sensor == "uwb" ? m.stamp + durationFromSeconds(0.2) : m.stamp;
  };
  std::stable_sort(arriving.begin(), arriving.end(),
                   [&](const auto& a, const auto& b) { return arrival(a) < arrival(b); });
  int refused = 0;
  for (const Measurement& m : arriving) refused += late->ingest(m).verdict == Verdict::TooOld ? 1 : 0;
  EXPECT_LE(refused, 4);  // those of the first moment, before there is a state to go back to
  const auto end = log.back().stamp;
  const Vector<6> difference =
      minus(in_order->estimateAt(end)->T_map_body, late->estimateAt(end)->T_map_body);
  EXPECT_LT(difference.norm(), 5e-3);
  Measurement too_late = log[log.size() / 2];
  EXPECT_EQ(late->ingest(too_late).verdict, Verdict::TooOld);
}

TEST(UwbImu, OneSampleOutOfOrderEqualsInOrder) {
  CircleOptions options;
  options.duration = 5.0;
  options.uwb_phase = 0.0031;
  auto log = circleRun(options);
  UwbImuConfig config = circleConfig(options);
  config.lag = 0.5;
  const auto in_order = makeUwbImu(config, circleMap());
  const auto swapped = makeUwbImu(config, circleMap());
  for (const Measurement& m : log) (void)in_order->ingest(m);
  for (std::size_t i = 40; i + 1 < log.size(); i += 37) {
    if (log[i].stamp < log[i + 1].stamp) std::swap(log[i], log[i + 1]);
  }
  for (const Measurement& m : log) EXPECT_NE(swapped->ingest(m).verdict, Verdict::TooOld);
  const Stamp end = std::max(log.back().stamp, log[log.size() - 2].stamp);
  const Estimate a = *in_order->estimateAt(end);
  const Estimate b = *swapped->estimateAt(end);
  EXPECT_EQ(a.T_map_body.translation, b.T_map_body.translation);
  EXPECT_EQ(a.T_map_body.rotation.coeffs(), b.T_map_body.rotation.coeffs());
  EXPECT_EQ(a.covariance, b.covariance);
}

// ---------------------------------------------------------------- hidden anchors and worse

TEST(UwbImu, OneLongAnchorCostsLessThanThreeTimesTheFreeError) {
  CircleOptions options;
  options.range_sigma = 0.1;
  options.duration = 40.0;
  const auto log = circleRun(options);
  UwbImuConfig config = circleConfig(options);
  config.robust.form = Form::Huber;
  const double free = driven(config, log).mean;
  const auto hidden = withRanges(log, [](double, BeaconRange& r) { r.range += r.anchor == 2 ? 2.0 : 0.0; });
  EXPECT_LT(driven(config, hidden).mean, 3.0 * free);
}

TEST(UwbImu, TooShortRangesAreRejectedAsWell) {
  CircleOptions options;
  options.range_sigma = 0.1;
  options.duration = 30.0;
  int k = 0;
  const auto spoilt = withRanges(circleRun(options), [&](double, BeaconRange& r) {
    if (++k % 50 == 0) r.range = std::max(1.0, r.range - 8.0);
  });
  UwbImuConfig config = circleConfig(options);
  config.robust.form = Form::Huber;
  const Told told = driven(config, spoilt);
  EXPECT_GE(told.gated, k / 50 - 1);
  EXPECT_LT(told.worst, 0.5);
}

TEST(UwbImu, AllHiddenDoesNotDivergeAndSaysSo) {
  CircleOptions options;
  options.range_sigma = 0.1;
  options.duration = 30.0;
  const auto log = withRanges(circleRun(options), [](double t, BeaconRange& r) {
    if (t > 10.0 && t < 14.0) r.range += 5.0;
  });
  UwbImuConfig config = circleConfig(options);
  config.robust.form = Form::Huber;
  const Told told = driven(config, log);
  const auto doubts = std::count_if(told.events.begin(), told.events.end(), [](const auto& e) {
    return e.find("doubts itself") != std::string::npos;
  });
  EXPECT_GE(doubts, 1);
  EXPECT_LT(told.last, 0.6);  // back again at the end
}

TEST(UwbImu, CovarianceGrowsWhileEverythingIsRejected) {
  CircleOptions options;
  options.range_sigma = 0.1;
  options.duration = 12.5;
  const auto clean = circleRun(options);
  const auto log = withRanges(clean, [](double t, BeaconRange& r) { r.range += t > 10.0 ? 30.0 : 0.0; });
  UwbImuConfig config = circleConfig(options);
  config.robust.form = Form::Huber;
  config.recovery.after = 10.0;
  EXPECT_GT(driven(config, log).sigma, 2.0 * driven(config, clean).sigma);
}

TEST(UwbImu, FindsItselfAgainAfterAKidnapping) {
  // Ranges of five seconds are those of a vehicle that stands 15 m away; then the true ones again.
  CircleOptions options;
  options.range_sigma = 0.1;
  options.duration = 45.0;
  const auto map = circleMap();
  const auto log = withRanges(circleRun(options), [&](double t, BeaconRange& r) {
    if (t < 15.0 || t > 20.0) return;
    const Eigen::Vector3d elsewhere = circlePose(t).translation + Eigen::Vector3d(0.0, 15.0, 0.5);
    r.range = (elsewhere - map->anchors[static_cast<std::size_t>(r.anchor - 1)].p_map).norm();
  });
  UwbImuConfig config = circleConfig(options);
  config.robust.form = Form::Huber;
  const Told told = driven(config, log);
  EXPECT_LT(told.last, 0.7);
  EXPECT_GT(told.worst, 1.0);  // it was led astray, or it was never tried
}

TEST(UwbImu, OffsetOfAnAnchorIsLearntWhereItIsAllowed) {
  CircleOptions options;
  options.range_sigma = 0.1;
  options.duration = 60.0;
  const auto log = withRanges(circleRun(options), [](double, BeaconRange& r) {
    if (r.anchor == 3) r.range += 0.3;
  });
  UwbImuConfig config = circleConfig(options);
  config.robust.form = Form::Huber;
  const double without = driven(config, log).mean;
  config.anchor_bias = {.sigma = 0.3, .time = 60.0, .after = 1.0, .drop_after = 30.0};
  EXPECT_LT(driven(config, log).mean, without);
}

// ---------------------------------------------------------------- starts and refusals

TEST(UwbImu, LevelsItselfAtRest) {
  const Eigen::Vector3d bias(1e-3, -2e-3, 5e-4);
  const Eigen::Quaterniond q = Pose3::fromXyzYawPitchRoll(0, 0, 0, 0.4, 0.05, -0.03).rotation;
  UwbImuConfig config;
  config.start.pose = {5, 6, 0.4};
  const auto estimator = makeUwbImu(config, circleMap());
  ImuSample still;
  still.angular = bias;
  still.linear = q.conjugate() * Eigen::Vector3d(0, 0, 9.80665);
  for (int k = 0; k <= 300; ++k) (void)estimator->ingest({circleStamp(0.01 * k), "imu", still});
  const Pose3 found = estimator->estimateAt(circleStamp(3.0))->T_map_body;
  EXPECT_LT(found.rotation.angularDistance(q), 1e-4);
  const Diagnostics told = estimator->diagnostics();
  const auto gyro = std::find_if(told.begin(), told.end(),
                                 [](const NamedValue& v) { return v.name == "gyro_bias_x_rad_per_s"; });
  ASSERT_NE(gyro, told.end());
  EXPECT_NEAR(gyro->value, 1e-3, 1e-6);
}

TEST(UwbImu, WithoutAnInertialUnitItSaysWhatItMisses) {
  UwbImuConfig config;
  const auto estimator = makeUwbImu(config, circleMap());
  BeaconRange range;
  range.anchor = 1;
  range.tag_body = Eigen::Vector3d::Zero();
  range.range = 8.0;
  const IngestReport report = estimator->ingest({circleStamp(0.0), "uwb", range});
  EXPECT_EQ(report.verdict, Verdict::NotInitialised);
  EXPECT_NE(report.reason.find("needs an inertial unit"), std::string::npos);
}

TEST(UwbImu, GapOfMinutesLeavesItUnsureAndAlive) {
  CircleOptions options;
  options.duration = 5.0;
  auto log = circleRun(options);
  UwbImuConfig config = circleConfig(options);
  const auto estimator = makeUwbImu(config, circleMap());
  for (const Measurement& m : log) (void)estimator->ingest(m);
  Measurement late = *std::find_if(log.begin(), log.end(), [](const auto& m) { return m.sensor == "imu"; });
  late.stamp = circleStamp(300.0);
  EXPECT_FALSE(estimator->ingest(late).event.empty());
  const auto estimate = estimator->estimateAt(late.stamp);
  ASSERT_TRUE(estimate);
  EXPECT_TRUE(estimate->covariance.allFinite());
  EXPECT_GT(estimate->covariance(0, 0), 100.0);
}

TEST(UwbImu, MapWithoutAnchorsIsRefused) {
  EXPECT_THROW((void)makeUwbImu({}, std::make_shared<map::TunnelMap>()), ConfigError);
}

TEST(UwbImu, BiasStatesBelongToTheErrorStateFilter) {
  UwbImuConfig config;
  config.variant = Variant::Ukf;
  config.anchor_bias.sigma = 0.3;
  EXPECT_THROW((void)validated(config), ConfigError);
}

}  // namespace
}  // namespace pos::estimation
