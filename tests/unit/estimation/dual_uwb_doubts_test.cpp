// What `dual_uwb` does when the ranges do not go together: mirror images, swapped tags, hidden anchors,
// jerks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/dual_uwb_score.hpp"

namespace pos::estimation {
namespace {

using pos::testing::diagnostic;
using pos::testing::doubleLaneDrive;
using pos::testing::doubleLaneSite;
using pos::testing::drive;
using pos::testing::dualStamp;
using pos::testing::dualUwbConfig;
using pos::testing::dualUwbMap;
using pos::testing::dualUwbRun;
using pos::testing::DualUwbRunOptions;
using pos::testing::DualUwbScore;
using pos::testing::onDoubleLane;
using pos::testing::scored;
using Variant = DualUwbConfig::Variant;

// Spec A6: anchors in line on one wall. The roadway tells the side; without it both sides stay.
TEST(DualUwb, MirrorImageIsResolvedByTheRoadwayOrReported) {
  auto site = doubleLaneSite();
  site.anchors = {{1, "", {0, 4, 0}}, {2, "", {14.5, 4, 0}}, {3, "", {29, 4, 0}}};
  const auto path = doubleLaneDrive();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const DualUwbRunOptions options{.seed = seed};
    const auto log = dualUwbRun(site, path, options);
    for (const Variant variant : {Variant::Snapshot, Variant::Rigid, Variant::Filter}) {
      DualUwbConfig config = dualUwbConfig(options);
      config.variant = variant;
      const auto blind = makeEstimator(config, dualUwbMap(site));
      (void)drive(*blind, log);
      EXPECT_EQ(diagnostic(*blind, "hypotheses"), 2.0);
      const auto estimate = blind->estimateAt(log.back().stamp);
      EXPECT_GT(std::sqrt(estimate->planarCovariance()(1, 1)), 3.0) << "the other image counts in the sigma";
      config.roadway = site.roadway;
      const DualUwbScore score = scored(config, site, path, log, 0.5);
      EXPECT_GT(score.answers, 250);
      EXPECT_LT(score.y_max, 1.0) << "always on the right side";
    }
  }
}

TEST(DualUwb, DrivingBackwardsRulesOutTheMirrorImageWhereThatCannotBe) {
  auto site = doubleLaneSite();
  site.anchors = {{1, "", {0, 4, 0}}, {2, "", {14.5, 4, 0}}, {3, "", {29, 4, 0}}};
  const DualUwbRunOptions options;
  DualUwbConfig config = dualUwbConfig(options);
  config.never_reverses = true;
  const DualUwbScore score =
      scored(config, site, doubleLaneDrive(), dualUwbRun(site, doubleLaneDrive(), options), 10.0);
  EXPECT_LT(score.y_max, 0.3);
}

TEST(DualUwb, SwappedTagsRaiseAnAlarm) {
  DualUwbRunOptions options;
  options.wheel_rate = 10.0;
  const auto log = dualUwbRun(doubleLaneSite(), doubleLaneDrive(), options);
  DualUwbConfig config = dualUwbConfig(options);
  std::swap(config.tags[0].p_body, config.tags[1].p_body);
  config.never_reverses = true;
  const auto by_course = makeEstimator(config, dualUwbMap(doubleLaneSite()));
  EXPECT_THAT(drive(*by_course, log), ::testing::Contains(::testing::HasSubstr("tags swapped")));
  config.never_reverses = false;
  config.wheel_speed_sigma = 0.05;
  const auto by_wheels = makeEstimator(config, dualUwbMap(doubleLaneSite()));
  EXPECT_THAT(drive(*by_wheels, log), ::testing::Contains(::testing::HasSubstr("tags swapped")));
  std::swap(config.tags[0].p_body, config.tags[1].p_body);
  config.never_reverses = true;
  const auto right = makeEstimator(config, dualUwbMap(doubleLaneSite()));
  EXPECT_THAT(drive(*right, log), ::testing::Not(::testing::Contains(::testing::HasSubstr("swapped"))));
}

// Spec A4: one anchor reads 0.5 to 2 m long for 3 s in mid-corridor.
TEST(DualUwb, AHiddenAnchorIsMarkedAndCostsLittle) {
  DualUwbRunOptions options;
  const double clear = onDoubleLane(dualUwbConfig(options), options).y;
  options.fault = [](double t, int, AnchorId anchor, double range) {
    return t > 13.0 && t < 16.0 && anchor == 3 ? range + 0.5 + 0.5 * std::abs(std::sin(7.0 * t)) : range;
  };
  EXPECT_LE(onDoubleLane(dualUwbConfig(options), options).y, 2.0 * clear);
  const auto filter = makeEstimator(dualUwbConfig(options), dualUwbMap(doubleLaneSite()));
  (void)drive(*filter, dualUwbRun(doubleLaneSite(), doubleLaneDrive(), options));
  EXPECT_GE(diagnostic(*filter, "anchors_blocked"), 2.0);
  EXPECT_EQ(diagnostic(*filter, "restarts"), 0.0);
}

TEST(DualUwb, AResetFilterIsLikeANewOne) {
  DualUwbRunOptions options;
  options.fault = [](double t, int, AnchorId, double range) {
    return t > 12.0 && t < 14.0 ? range + 1.0 : range;
  };
  const auto log = dualUwbRun(doubleLaneSite(), doubleLaneDrive(), options);
  const Belief<Pose2> prior{{0.0, 0.0, 0.0}, Vector<3>(0.01, 0.01, 0.01).asDiagonal()};
  const auto fresh = makeEstimator(dualUwbConfig(options), dualUwbMap(doubleLaneSite()));
  const auto used = makeEstimator(dualUwbConfig(options), dualUwbMap(doubleLaneSite()));
  const std::size_t in_doubt = static_cast<std::size_t>(
      std::count_if(log.begin(), log.end(), [](const Measurement& m) { return m.stamp < dualStamp(13.2); }));
  (void)drive(*used, {log.begin(), log.begin() + static_cast<long>(in_doubt)});
  fresh->reset(dualStamp(0.0), prior);
  used->reset(dualStamp(0.0), prior);
  EXPECT_EQ(drive(*used, log), drive(*fresh, log));
  EXPECT_EQ(used->estimateAt(log.back().stamp)->T_map_body.translation,
            fresh->estimateAt(log.back().stamp)->T_map_body.translation);
}

TEST(DualUwb, AKidnappedFilterStartsOver) {
  const DualUwbRunOptions options;
  DualUwbConfig config = dualUwbConfig(options);
  config.still_at_start = 0.0;
  const auto filter = makeEstimator(config, dualUwbMap(doubleLaneSite()));
  filter->reset(dualStamp(0.0), {{20.0, 2.0, 2.0}, Vector<3>(1e-4, 1e-4, 1e-4).asDiagonal()});
  (void)drive(*filter, dualUwbRun(doubleLaneSite(), doubleLaneDrive(), options));
  EXPECT_GE(diagnostic(*filter, "restarts"), 1.0);
  const auto estimate = filter->estimateAt(dualStamp(30.0));
  ASSERT_TRUE(estimate);
  EXPECT_LT((estimate->T_map_body.translation.head<2>() - Eigen::Vector2d(23.945, 0.0)).norm(), 0.2);
}

// With the noise for 5 cm the same ranges contradict the model at every jerk; the filter gets over it.
TEST(DualUwb, AFilterThatIsSurprisedDoesNotLoseItself) {
  DualUwbRunOptions options;
  options.range_sigma = 1e-3;
  const DualUwbScore score = onDoubleLane(dualUwbConfig(options), options);
  EXPECT_LT(score.x_max, 0.03);
  EXPECT_LT(score.y_max, 0.03);
  EXPECT_LT(degrees(score.yaw_max), 4.0);
}

}  // namespace
}  // namespace pos::estimation
