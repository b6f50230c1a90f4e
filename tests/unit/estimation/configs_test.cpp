#include "pos/estimation/configs.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "pos/core/error.hpp"

namespace pos::estimation {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Key that `validated` complains of, "valid" when it does not.
template <class Config>
std::string complaintKey(const Config& config) {
  try {
    (void)validated(config);
  } catch (const ConfigError& error) {
    return error.complaint().key;
  }
  return "valid";
}

/// The same for a default config after one change.
template <class Config, class Change>
std::string keyAfter(Change change) {
  Config config;
  change(config);
  return complaintKey(config);
}

TEST(Configs, DefaultsAreValid) {
  EXPECT_EQ(complaintKey(EstimatorConfig{DeadReckoningConfig{}}), "valid");
  EXPECT_EQ(complaintKey(EstimatorConfig{RangeOdometryConfig{}}), "valid");
  EXPECT_EQ(complaintKey(EstimatorConfig{MclConfig{}}), "valid");
  EXPECT_EQ(complaintKey(EstimatorConfig{MrptMclConfig{}}), "valid");
  EXPECT_EQ(complaintKey(EstimatorConfig{DualUwbConfig{}}), "valid");
}

TEST(Configs, ValidConfigComesBackUnchanged) {
  RangeOdometryConfig config;
  config.range_sigma = 0.3;
  EXPECT_EQ(validated(config), config);
}

TEST(Configs, FewestParticlesMayEqualButNotExceedTheMost) {
  EXPECT_EQ(keyAfter<MclConfig>([](auto& c) { c.particles.min = c.particles.max; }), "valid");
  EXPECT_EQ(keyAfter<MclConfig>([](auto& c) { c.particles.min = c.particles.max + 1; }), "particles.min");
}

TEST(Configs, TagsAreUnique) {
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) { c.tags = {{.id = 1}, {.id = 2}}; }), "valid");
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) {
              c.tags = {{.id = 1}, {.id = 2}, {.id = 1}};
            }),
            "tags[2].id");
  EXPECT_EQ(keyAfter<MrptMclConfig>([](auto& c) { c.tags = {{.id = 1}, {.id = 1}}; }), "tags[1].id");
}

TEST(Configs, ParticleFiltersNeedASensor) {
  EXPECT_EQ(keyAfter<MclConfig>([](auto& c) { c.use_ranges = false; }), "use_ranges");
  EXPECT_EQ(keyAfter<MrptMclConfig>([](auto& c) { c.use_ranges = false; }), "use_ranges");
  EXPECT_EQ(keyAfter<MclConfig>([](auto& c) { c.use_ranges = false, c.use_scans = true; }), "valid");
}

TEST(Configs, HeldCalibrationCannotWander) {
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) { c.gyro_bias.walk_per_sqrt_s = 0.1; }),
            "gyro_bias.walk_deg_per_s_per_sqrt_s");
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) { c.range_scale.walk_per_sqrt_s = 0.1; }),
            "range_scale.walk_per_sqrt_s");
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) { c.latency = {0.0, 0.1, 0.1}; }), "valid");
}

TEST(Configs, SlowInjectionIsSlowerThanFast) {
  EXPECT_EQ(keyAfter<MclConfig>([](auto& c) { c.injection_slow = c.injection_fast; }), "injection_slow");
  EXPECT_EQ(keyAfter<MclConfig>([](auto& c) { c.injection_slow = c.injection_fast = 0.0; }), "valid");
}

TEST(Configs, DeadReckoningNeedsAKnownStart) {
  EXPECT_EQ(keyAfter<DeadReckoningConfig>([](auto& c) { c.start.mode = StartMode::UnknownHeading; }),
            "start.mode");
}

TEST(Configs, DeadReckoningMayStartWhereTheReferenceDoes) {
  DeadReckoningConfig config;
  config.start.mode = StartMode::AtTruth;
  EXPECT_EQ(validated(config), config);
}

TEST(Configs, SigmasOfAnUnknownStartDoNotMatter) {
  EXPECT_EQ(keyAfter<StartConfig>([](auto& c) { c.yaw_sigma = 0.0; }), "yaw_sigma_deg");
  EXPECT_EQ(keyAfter<StartConfig>([](auto& c) { c.yaw_sigma = 0.0, c.mode = StartMode::UnknownHeading; }),
            "valid");
  EXPECT_EQ(
      keyAfter<StartConfig>([](auto& c) { c.position_sigma = 0.0, c.mode = StartMode::UnknownHeading; }),
      "position_sigma_m");
}

TEST(Configs, NotANumberIsRefusedWhereverItStands) {
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) { c.start.pose.x = kNan; }), "start.x_m");
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) { c.odometry_noise.lateral_per_sqrt_m = kNan; }),
            "odometry_noise.lateral_m_per_sqrt_m");
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) { c.gate.confidence = kNan; }), "gate.confidence");
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) { c.gate.inflation = kNan; }), "gate.inflation");
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) { c.range_offset.value = kNan; }),
            "range_offset.value_m");
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) { c.tags = {{.p_body = {0, kNan, 0}}}; }), "tags[0]");
  EXPECT_EQ(keyAfter<MclConfig>([](auto& c) { c.range.sigma = kNan; }), "range.sigma_m");
  EXPECT_EQ(keyAfter<MclConfig>([](auto& c) { c.scan.outlier_probability = kNan; }),
            "scan.outlier_probability");
  EXPECT_EQ(keyAfter<MrptMclConfig>([](auto& c) { c.body_height = kNan; }), "body_height_m");
}

TEST(Configs, NegativeValuesAreRefused) {
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) { c.range_sigma = -0.1; }), "range_sigma_m");
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) { c.heading_hypotheses = 0; }), "heading_hypotheses");
  EXPECT_EQ(keyAfter<RangeOdometryConfig>([](auto& c) { c.range_scale.value = 0.0; }), "range_scale.value");
  EXPECT_EQ(keyAfter<OdometryNoise>([](auto& c) { c.yaw_per_sqrt_s = -1e-9; }), "yaw_deg_per_sqrt_s");
  EXPECT_EQ(keyAfter<MclConfig>([](auto& c) { c.particles.bin_yaw = 0.0; }), "particles.bin_yaw_deg");
}

}  // namespace
}  // namespace pos::estimation
