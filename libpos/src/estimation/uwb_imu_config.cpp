#include "pos/estimation/uwb_imu_config.hpp"

#include "pos/core/config_checks.hpp"
#include "pos/estimation/configs.hpp"

namespace pos::estimation {

InertialStart validated(InertialStart config) {
  requireFinite(config.speed, "speed_m_per_s");
  requirePositive(config.velocity_sigma, "velocity_sigma_m_per_s");
  requirePositive(config.tilt_sigma, "tilt_sigma_deg");
  requirePositive(config.height_sigma, "height_sigma_m");
  return config;
}

AnchorBiasConfig validated(AnchorBiasConfig config) {
  requireNotNegative(config.sigma, "sigma_m");
  requirePositive(config.time, "time_s");
  requirePositive(config.after, "after_s");
  requirePositive(config.drop_after, "drop_after_s");
  return config;
}

MotionAids validated(MotionAids config) {
  requireNotNegative(config.height_sigma, "height_sigma_m");
  requireNotNegative(config.zero_velocity_sigma, "zero_velocity_sigma_m_per_s");
  requireNotNegative(config.lateral_sigma, "lateral_sigma_m_per_s");
  requireNotNegative(config.wheel_speed_sigma, "wheel_speed_sigma_m_per_s");
  requirePositive(config.interval, "interval_s");
  return config;
}

RecoveryConfig validated(RecoveryConfig config) {
  requirePositive(config.after, "after_s");
  requireShare(config.agreement_fraction, "agreement_fraction");
  return config;
}

UwbImuConfig validated(UwbImuConfig config) {
  using Variant = UwbImuConfig::Variant;
  requireValid(config.start, "start");
  requireValid(config.first, "first");
  requireValid(config.imu, "imu");
  requireValid(config.alignment, "alignment");
  requireValid(config.standstill, "standstill");
  requireValid(config.odometer, "odometer");
  requireValid(config.robust, "robust");
  requireValid(config.anchor_bias, "anchor_bias");
  requireValid(config.recovery, "recovery");
  requireValid(config.aids, "aids");
  requireUniqueTags(config.tags);
  const bool placed = config.start.mode == StartMode::Known || config.start.mode == StartMode::AtTruth;
  if (!placed && config.variant != Variant::UwbOnly) {
    refuse("an inertial unit and one tag cannot find their heading by themselves", "start.mode", "",
           "known, or at_truth with a truth that has a heading");
  }
  if (config.anchor_bias.sigma > 0.0 && config.variant != Variant::Eskf) {
    refuse("only the error-state filter has offsets of anchors as states", "anchor_bias.sigma_m",
           std::to_string(config.anchor_bias.sigma), "0, or variant eskf");
  }
  requireFinite(config.height, "height_m");
  requirePositive(config.range_sigma, "range_sigma_m");
  requirePositive(config.range_max, "range_max_m");
  requireNotNegative(config.power_gap_db, "power_gap_db");
  require(config.power_factor >= 1.0, "power_factor", "1 or more");
  requireNotNegative(config.epoch_span, "epoch_span_s");
  requirePositive(config.max_speed, "max_speed_m_per_s");
  require(config.sigma_point_spread > 1e-5 && config.sigma_point_spread <= 1.0, "sigma_point_spread",
          "more than 1e-5, at most 1");
  requireNotNegative(config.lag, "lag_s");
  return config;
}

}  // namespace pos::estimation
