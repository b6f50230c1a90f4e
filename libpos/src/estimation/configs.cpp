#include "pos/estimation/configs.hpp"

#include <cmath>
#include <set>

#include "pos/core/config_checks.hpp"

namespace pos::estimation {

void requireUniqueTags(const std::vector<TagMount>& tags) {
  std::set<TagId> seen;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const std::string key = indexed("tags", i);
    if (!tags[i].p_body.allFinite()) refuse("a tag's place is no number", key, "", "x_m, y_m, z_m in metres");
    if (!seen.insert(tags[i].id).second) {
      refuse("two tags have the same id", key + ".id", std::to_string(tags[i].id), "every id once");
    }
  }
}

namespace {

/// A table of biases holds all that a link reads too long: beside it nothing else may say so.
void requireBiasesOnce(const DualUwbConfig& config) {
  if (config.range_bias_table.empty()) return;
  if (config.range_offset == 0.0 && config.range_biases.empty() && config.tag_shifts.empty()) return;
  refuse("the biases of the ranges are given twice", "range_bias_table", config.range_bias_table,
         "either the table, or range_offset_m, range_biases and tag_shifts");
}

void requireCalibration(const CalibrationState& state, const std::string& table, const std::string& unit) {
  const std::string of_unit = unit.empty() ? "" : "_" + unit;
  requireFinite(state.value, prefixed(table, "value" + of_unit));
  requireNotNegative(state.sigma, prefixed(table, "sigma" + of_unit));
  const std::string walk = prefixed(table, "walk" + of_unit + "_per_sqrt_s");
  requireNotNegative(state.walk_per_sqrt_s, walk);
  if (state.sigma == 0.0 && state.walk_per_sqrt_s > 0.0) {
    refuse("a value that is held (sigma 0) cannot wander", walk, std::to_string(state.walk_per_sqrt_s),
           "0, or a sigma above 0");
  }
}

/// Biases and shifts that are numbers, each given once.
void requireRangeBiases(const DualUwbConfig& config) {
  std::set<std::pair<TagId, AnchorId>> links;
  for (std::size_t i = 0; i < config.range_biases.size(); ++i) {
    const LinkBias& link = config.range_biases[i];
    const std::string key = "range_biases[" + std::to_string(i) + "]";
    requireFinite(link.bias, key + ".bias_m");
    if (!links.emplace(link.tag, link.anchor).second) {
      refuse("a link's bias is given twice", key,
             "tag " + std::to_string(link.tag) + ", anchor " + std::to_string(link.anchor),
             "every link once");
    }
  }
  std::set<TagId> shifted;
  for (std::size_t i = 0; i < config.tag_shifts.size(); ++i) {
    const TagShift& shift = config.tag_shifts[i];
    const std::string key = "tag_shifts[" + std::to_string(i) + "]";
    requireFinite(shift.x, key + ".x_m");
    requireFinite(shift.y, key + ".y_m");
    if (!shifted.insert(shift.id).second)
      refuse("a tag's shift is given twice", key + ".id", std::to_string(shift.id), "every tag once");
  }
}

/// Sensors and constraints that the chosen variant would pass over in silence.
void requireUse(const DualUwbConfig& config, bool filter) {
  if (config.wheel_speed_sigma > 0.0 && !filter) {
    refuse("only the filters use wheel speeds", "wheel_speed_sigma_m_per_s",
           std::to_string(config.wheel_speed_sigma), "0, or variant filter or filter_gyro");
  }
  if (config.lateral_sigma > 0.0 && (!filter || config.motion != DualUwbConfig::Motion::Free)) {
    refuse("only free motion of a filter is held to the wheels' course", "lateral_sigma_m_per_s",
           std::to_string(config.lateral_sigma), "0, or motion free of variant filter or filter_gyro");
  }
}

void requireLinkBias(const LinkBiasState& bias) {
  requireCalibration({bias.value, bias.sigma, bias.walk_per_sqrt_s}, "link_bias", "m");
  requireNotNegative(bias.time, "link_bias.time_s");
  if (bias.time > 0.0 && !(bias.sigma > 0.0 && bias.walk_per_sqrt_s == 0.0)) {
    refuse("a bias that forgets itself needs a sigma, and does not wander as well", "link_bias.time_s",
           std::to_string(bias.time), "0, or sigma_m above 0 and no walk_m_per_sqrt_s");
  }
}

void requireOneSensor(bool use_ranges, bool use_scans) {
  if (!use_ranges && !use_scans) {
    refuse("neither ranges nor scans are used", "use_ranges", "false", "use_ranges or use_scans true");
  }
}

}  // namespace

StartConfig validated(StartConfig config) {
  requireFinite(config.pose.x, "x_m");
  requireFinite(config.pose.y, "y_m");
  requireFinite(config.pose.yaw, "yaw_deg");
  if (config.mode != StartMode::Unknown) requirePositive(config.position_sigma, "position_sigma_m");
  if (config.mode == StartMode::Known) requirePositive(config.yaw_sigma, "yaw_sigma_deg");
  return config;
}

OdometryNoise validated(OdometryNoise config) {
  requireNotNegative(config.distance_per_sqrt_m, "distance_m_per_sqrt_m");
  requireNotNegative(config.lateral_per_sqrt_m, "lateral_m_per_sqrt_m");
  requireNotNegative(config.yaw_per_sqrt_m, "yaw_deg_per_sqrt_m");
  requireNotNegative(config.yaw_per_sqrt_rad, "yaw_deg_per_sqrt_deg");
  requireNotNegative(config.yaw_per_sqrt_s, "yaw_deg_per_sqrt_s");
  requireNotNegative(config.position_per_sqrt_s, "position_m_per_sqrt_s");
  return config;
}

GateConfig validated(GateConfig config) {
  requireConfidence(config.confidence, "confidence");
  requirePositive(config.open_after, "open_after_s");
  requireShare(config.agreement_fraction, "agreement_fraction");
  if (!(config.inflation >= 1.0) || !std::isfinite(config.inflation)) {
    refuse("the inflation would shrink the covariance", "inflation", std::to_string(config.inflation),
           ">= 1");
  }
  return config;
}

DeadReckoningConfig validated(DeadReckoningConfig config) {
  requireValid(config.start, "start");
  requireValid(config.noise, "odometry_noise");
  if (config.start.mode != StartMode::Known && config.start.mode != StartMode::AtTruth) {
    refuse("dead reckoning cannot find its start by itself", "start.mode", "",
           "known, or at_truth with a truth that has a heading");
  }
  requireFinite(config.height, "height_m");
  requireValid(config.imu, "imu");
  requireValid(config.alignment, "alignment");
  requireValid(config.standstill, "standstill");
  requireValid(config.odometer, "odometer");
  requireCalibration(config.wheel_scale, "wheel_scale", "");
  requireValid(config.heading, "heading");
  if (config.variant != DeadReckoningConfig::Variant::Odometry && !(config.odometer.track > 0.0)) {
    refuse("two wheels turn the vehicle by their distance from each other", "odometer.track_m",
           std::to_string(config.odometer.track), "> 0");
  }
  return config;
}

RangeOdometryConfig validated(RangeOdometryConfig config) {
  requireValid(config.start, "start");
  requireValid(config.odometry_noise, "odometry_noise");
  requireValid(config.gate, "gate");
  requirePositive(config.acceleration_density, "acceleration_density_m_per_s_per_sqrt_s");
  requirePositive(config.yaw_acceleration_density, "yaw_acceleration_density_deg_per_s_per_sqrt_s");
  requirePositive(config.max_speed, "max_speed_m_per_s");
  requireUniqueTags(config.tags);
  requireFinite(config.body_height, "body_height_m");
  requirePositive(config.range_sigma, "range_sigma_m");
  requireCalibration(config.range_scale, "range_scale", "");
  requireCalibration(config.range_offset, "range_offset", "m");
  requireCalibration(config.anchor_offset, "anchor_offset", "m");
  requireCalibration(config.gyro_bias, "gyro_bias", "deg_per_s");
  requireCalibration(config.wheel_scale, "wheel_scale", "");
  requireCalibration(config.latency, "latency", "s");
  requirePositive(config.range_scale.value, "range_scale.value");
  requirePositive(config.wheel_scale.value, "wheel_scale.value");
  requirePositive(config.heading_hypotheses, "heading_hypotheses");
  return config;
}

RangeLikelihood validated(RangeLikelihood config) {
  requirePositive(config.sigma, "sigma_m");
  requireShare(config.outlier_probability, "outlier_probability");
  requirePositive(config.range_max, "range_max_m");
  requireNotNegative(config.bias_sigma, "bias_sigma_m");
  requirePositive(config.bias_time, "bias_time_s");
  requireNotNegative(config.correlation_length, "correlation_length_m");
  if (config.sigma >= config.range_max) {
    refuse("the sigma of a range exceeds the longest range", "sigma_m", std::to_string(config.sigma),
           "below range_max_m = " + std::to_string(config.range_max));
  }
  return config;
}

ScanLikelihood validated(ScanLikelihood config) {
  requirePositive(config.beams, "beams");
  requirePositive(config.sigma, "sigma_m");
  requireShare(config.outlier_probability, "outlier_probability");
  requirePositive(config.distance_max, "distance_max_m");
  requirePositive(config.tempering, "tempering");
  requireNotNegative(config.correlation_length, "correlation_length_m");
  return config;
}

ParticleCount validated(ParticleCount config) {
  requirePositive(config.min, "min");
  if (config.min > config.max) {
    refuse("the smallest number of particles exceeds the largest", "min", std::to_string(config.min),
           "at most max = " + std::to_string(config.max));
  }
  requirePositive(config.kld_epsilon, "kld_epsilon");
  requirePositive(config.kld_z, "kld_z");
  requirePositive(config.bin_position, "bin_position_m");
  requirePositive(config.bin_yaw, "bin_yaw_deg");
  return config;
}

MclConfig validated(MclConfig config) {
  requireValid(config.start, "start");
  requireValid(config.odometry_noise, "odometry_noise");
  requireValid(config.range, "range");
  requireValid(config.scan, "scan");
  requireValid(config.particles, "particles");
  requireUniqueTags(config.tags);
  requireFinite(config.body_height, "body_height_m");
  requireOneSensor(config.use_ranges, config.use_scans);
  requireShare(config.resample_below, "resample_below");
  requireShare(config.injection_slow, "injection_slow");
  requireShare(config.injection_fast, "injection_fast");
  if (config.injection_slow > 0.0 && config.injection_slow >= config.injection_fast) {
    refuse("the slow average has to decay slower than the fast one", "injection_slow",
           std::to_string(config.injection_slow), "below injection_fast, or 0 for no injection");
  }
  return config;
}

MrptMclConfig validated(MrptMclConfig config) {
  requireValid(config.start, "start");
  requireValid(config.odometry_noise, "odometry_noise");
  requireUniqueTags(config.tags);
  requireFinite(config.body_height, "body_height_m");
  requireOneSensor(config.use_ranges, config.use_scans);
  requirePositive(config.range_sigma, "range_sigma_m");
  requirePositive(config.particles, "particles");
  requirePositive(config.beams, "beams");
  return config;
}

SightConfig validated(SightConfig config) {
  requireConfidence(config.confidence, "confidence");
  requirePositive(config.blocked_after, "blocked_after");
  requireNotNegative(config.blocked_for, "blocked_for_s");
  requirePositive(config.restart_after, "restart_after_s");
  requireShare(config.agreement_fraction, "agreement_fraction");
  return config;
}

DualUwbConfig validated(DualUwbConfig config) {
  using Variant = DualUwbConfig::Variant;
  const bool filter = config.variant == Variant::Filter || config.variant == Variant::FilterGyro;
  requireValid(config.start, "start");
  requireValid(config.gate, "gate");
  requireUniqueTags(config.tags);
  if (config.tags.size() == 1) refuse("one tag has no heading", "tags", "1 tag", "two or more, or none");
  requireNotNegative(config.still_at_start, "still_at_start_s");
  requireFinite(config.body_height, "body_height_m");
  requirePositive(config.range_sigma, "range_sigma_m");
  requireFinite(config.range_offset, "range_offset_m");
  requireLinkBias(config.link_bias);
  requireCalibration(config.gyro_bias, "gyro_bias", "deg_per_s");
  if (config.link_bias.sigma > 0.0 && (!filter || config.tags.empty())) {
    refuse("a state for each link needs a filter, and tags that are known beforehand", "link_bias.sigma_m",
           std::to_string(config.link_bias.sigma), "0, or variant filter or filter_gyro with a list of tags");
  }
  requireBiasesOnce(config);
  requireRangeBiases(config);
  requireNotNegative(config.epoch_span, "epoch_span_s");
  requirePositive(config.acceleration_density, "acceleration_density_m_per_s_per_sqrt_s");
  requirePositive(config.yaw_acceleration_density, "yaw_acceleration_density_deg_per_s_per_sqrt_s");
  requirePositive(config.max_speed, "max_speed_m_per_s");
  requirePositive(config.max_yaw_rate, "max_yaw_rate_deg_per_s");
  requireFinite(config.motion_centre_x, "motion_centre_x_m");
  requireFinite(config.course_offset, "course_offset_deg");
  requireNotNegative(config.lateral_sigma, "lateral_sigma_m_per_s");
  requireNotNegative(config.wheel_speed_sigma, "wheel_speed_sigma_m_per_s");
  requireUse(config, filter);
  requireNotNegative(config.gyro_noise, "gyro_noise_deg_per_sqrt_s");
  if (!(config.fit_significance > 0.0 && config.fit_significance < 0.5)) {
    refuse("the residual test needs a significance", "fit_significance",
           std::to_string(config.fit_significance), "> 0 and < 0.5");
  }
  if (config.roadway.size() == 1 || config.roadway.size() == 2) {
    refuse("these corners enclose no ground", "roadway", std::to_string(config.roadway.size()) + " corners",
           "at least three, or none");
  }
  for (const Eigen::Vector2d& corner : config.roadway) {
    requireFinite(corner.x(), "roadway.x_m");
    requireFinite(corner.y(), "roadway.y_m");
  }
  return config;
}

EstimatorConfig validated(EstimatorConfig config) {
  std::visit([](const auto& chosen) { (void)validated(chosen); }, config);
  return config;
}

}  // namespace pos::estimation
