#include "pos/estimation/sins_configs.hpp"

#include "pos/core/config_checks.hpp"
#include "pos/estimation/configs.hpp"

namespace pos::estimation {

ins::EskfProcess processOf(const ImuNoise& imu, double gravity) {
  return {imu.accelerometer_density, imu.gyro_density, imu.accelerometer_bias_walk, imu.gyro_bias_walk,
          gravity};
}

ImuNoise validated(ImuNoise config) {
  requirePositive(config.gyro_density, "gyro_noise_deg_per_sqrt_s");
  requirePositive(config.accelerometer_density, "accelerometer_noise_m_per_s_per_sqrt_s");
  requireNotNegative(config.gyro_bias_sigma, "gyro_bias_sigma_deg_per_s");
  requireNotNegative(config.accelerometer_bias_sigma, "accelerometer_bias_sigma_m_per_s2");
  requireNotNegative(config.gyro_bias_walk, "gyro_bias_walk_deg_per_s_per_sqrt_s");
  requireNotNegative(config.accelerometer_bias_walk, "accelerometer_bias_walk_m_per_s2_per_sqrt_s");
  return config;
}

AlignmentConfig validated(AlignmentConfig config) {
  requirePositive(config.time, "time_s");
  requirePositive(config.level_sigma, "level_sigma_deg");
  requirePositive(config.moving_level_sigma, "moving_level_sigma_deg");
  return config;
}

SlipConfig validated(SlipConfig config) {
  const auto requireInside = [](double value, const std::string& key) {
    if (!(value > 0.0 && value < 1.0))
      refuse("a confidence is wanted", key, std::to_string(value), "> 0 and < 1");
  };
  requireInside(config.confidence, "confidence");
  requireInside(config.release_confidence, "release_confidence");
  if (config.window < 1)
    refuse("at least one update is looked at", "window", std::to_string(config.window), ">= 1");
  if (config.exceedances < 1 || config.exceedances > config.window) {
    refuse("more exceedances than updates looked at", "exceedances", std::to_string(config.exceedances),
           "1 to window");
  }
  if (config.release_updates < 1) {
    refuse("at least one update has to agree", "release_updates", std::to_string(config.release_updates),
           ">= 1");
  }
  requirePositive(config.release_yaw_rate, "release_yaw_rate_deg_per_s");
  requirePositive(config.velocity_sigma, "velocity_sigma_m_per_s");
  requirePositive(config.degraded_after, "degraded_after_s");
  requirePositive(config.max_sigma, "max_sigma_m");
  requirePositive(config.lateral_sigma, "lateral_sigma_m_per_s");
  return config;
}

HeadingFilterConfig validated(HeadingFilterConfig config) {
  requireNotNegative(config.level_walk, "level_walk_deg_per_sqrt_s");
  requirePositive(config.level_sigma, "level_sigma_deg");
  requirePositive(config.yaw_sigma, "yaw_sigma_deg");
  requireNotNegative(config.correlation_time, "correlation_time_s");
  if (config.yaw_bias.value != 0.0) {
    refuse("the heading's bias starts at zero: both headings start alike", "yaw_bias.value_deg",
           std::to_string(config.yaw_bias.value), "0");
  }
  return config;
}

SinsDrConfig validated(SinsDrConfig config) {
  requireValid(config.start, "start");
  requireValid(config.imu, "imu");
  requireValid(config.alignment, "alignment");
  requireValid(config.standstill, "standstill");
  requireValid(config.odometer, "odometer");
  requireValid(config.slip, "slip");
  if (config.start.mode != StartMode::Known && config.start.mode != StartMode::AtTruth) {
    refuse("inertial unit and wheels cannot find position and heading by themselves", "start.mode", "",
           "known, or at_truth with a truth that has a heading");
  }
  requireFinite(config.height, "height_m");
  requireNotNegative(config.odometer_scale_sigma, "odometer_scale_sigma");
  requireNotNegative(config.odometer_scale_walk, "odometer_scale_walk_per_sqrt_s");
  requireNotNegative(config.odometer_velocity_sigma, "odometer_velocity_sigma_m_per_s");
  requireNotNegative(config.boresight_sigma, "boresight_sigma_deg");
  requirePositive(config.wheels_lost_after, "wheels_lost_after_s");
  requirePositive(config.update_interval, "update_interval_s");
  requirePositive(config.propagation_interval, "propagation_interval_s");
  requirePositive(config.difference_sigma_min, "difference_sigma_min_m");
  requirePositive(config.difference_sigma, "difference_sigma_m");
  if (!(config.difference_sigma_max >= config.difference_sigma_min)) {
    refuse("the bounds of the learnt sigma are the wrong way round", "difference_sigma_max_m",
           std::to_string(config.difference_sigma_max), "at least difference_sigma_min_m");
  }
  if (!(config.forgetting > 0.0 && config.forgetting < 1.0)) {
    refuse("the forgetting factor is a share", "forgetting", std::to_string(config.forgetting),
           "> 0 and < 1, usually 0.95 to 0.995");
  }
  requirePositive(config.zero_velocity_sigma, "zero_velocity_sigma_m_per_s");
  if (!(config.fix_confidence > 0.0 && config.fix_confidence < 1.0)) {
    refuse("a confidence is wanted", "fix_confidence", std::to_string(config.fix_confidence), "> 0 and < 1");
  }
  return config;
}

}  // namespace pos::estimation
