#include "pos/estimation/shearer_configs.hpp"

#include "pos/core/config_checks.hpp"
#include "pos/estimation/configs.hpp"

namespace pos::estimation {

ShearerAlignment validated(ShearerAlignment config) {
  requireFinite(config.height, "height_m");
  requireFinite(config.pitch, "pitch_deg");
  requireFinite(config.roll, "roll_deg");
  requireFinite(config.speed, "speed_m_per_s");
  requirePositive(config.tilt_sigma, "tilt_sigma_deg");
  requirePositive(config.speed_sigma, "speed_sigma_m_per_s");
  return config;
}

FaceConfig validated(FaceConfig config) {
  requirePositive(config.length, "length_m");
  requireNotNegative(config.advance, "advance_m");
  requirePositive(config.arrival_zone, "arrival_zone_m");
  requirePositive(config.excursion_max, "excursion_max_m");
  requirePositive(config.standing_speed, "standing_speed_m_per_s");
  requirePositive(config.creep_sigma, "creep_sigma_m");
  for (const double creep : config.creep) requireFinite(creep, "creep_m");
  return config;
}

LegsConfig validated(LegsConfig config) {
  require(!config.sensor.empty(), "sensor", "the label of the scanner that sees the legs");
  requirePositive(config.spacing, "spacing_m");
  requirePositive(config.lateral, "lateral_m");
  requirePositive(config.lateral_gate, "lateral_gate_m");
  requirePositive(config.association_gate, "association_gate_m");
  require(config.association_gate < 0.5 * config.spacing, "association_gate_m", "less than half the spacing");
  requirePositive(config.diameter, "diameter_m");
  requirePositive(config.range_sigma, "range_sigma_m");
  require(config.sigma.minCoeff() > 0.0 && config.sigma.allFinite(), "sigma_m", "three numbers > 0");
  requireConfidence(config.confidence, "confidence");
  require(config.rejections >= 1, "rejections", ">= 1");
  requirePositive(config.degraded_after, "degraded_after_s");
  return config;
}

SelectionConfig validated(SelectionConfig config) {
  require(config.mode >= 0 && config.mode <= 9, "mode", "1 to 9, or 0 for 2 and 7 side by side");
  require(config.features >= 1 && config.features <= 8, "features", "1 to 8");
  requireNotNegative(config.distance, "distance_m");
  requirePositive(config.zone_lag, "zone_lag_m");
  return config;
}

ScannerStates validated(ScannerStates config) {
  requireNotNegative(config.mount_yaw_sigma, "mount_yaw_sigma_deg");
  requireNotNegative(config.mount_pitch_sigma, "mount_pitch_sigma_deg");
  requireNotNegative(config.scale_sigma, "scale_sigma");
  requireNotNegative(config.offset_sigma, "offset_sigma_m");
  requireNotNegative(config.angle_scale_sigma, "angle_scale_sigma");
  requireNotNegative(config.angle_curve_sigma, "angle_curve_sigma");
  return config;
}

EndFixConfig validated(EndFixConfig config) {
  requireNotNegative(config.first_cut_lateral_sigma, "first_cut_lateral_sigma_m");
  requireNotNegative(config.first_cut_along_sigma, "first_cut_along_sigma_m");
  requireNotNegative(config.first_cut_height_sigma, "first_cut_height_sigma_m");
  requireFinite(config.first_cut_lateral, "first_cut_lateral_m");
  requireFinite(config.first_cut_height, "first_cut_height_m");
  requireNotNegative(config.straight_sigma, "straight_sigma_m");
  requirePositive(config.straight_every, "straight_every_m");
  requireNotNegative(config.stroke_sigma, "stroke_sigma_m");
  return config;
}

ShearerOdometer validated(ShearerOdometer config) {
  require(config.body_mount.norm() < 1.0, "body_mount_deg", "a rotation of less than 1 rad");
  requirePositive(config.pitch_sigma, "pitch_sigma_deg");
  requirePositive(config.yaw_sigma, "yaw_sigma_deg");
  requirePositive(config.drift_sigma, "drift_sigma_deg_per_s");
  requirePositive(config.scale_sigma, "scale_sigma");
  requirePositive(config.stroke_sigma, "stroke_sigma_m");
  requirePositive(config.height_sigma, "height_sigma_m");
  return config;
}

ShearerConfig validated(ShearerConfig config) {
  requireValid(config.start, "start");
  require(config.start.mode == StartMode::Known || config.start.mode == StartMode::AtTruth, "start.mode",
          "known", "a shearer has to be told where it starts");
  requireValid(config.alignment, "alignment");
  requireValid(config.imu, "imu");
  requirePositive(config.propagation_interval, "propagation_interval_s");
  requireValid(config.face, "face");
  requireValid(config.legs, "legs");
  requireValid(config.selection, "selection");
  require(config.picm.body_mount.norm() < 1.0, "picm.body_mount_deg", "a rotation of less than 1 rad");
  requireValid(config.scanner, "scanner");
  requireValid(config.end_fix, "end_fix");
  requireValid(config.odometer, "odometer");
  return config;
}

}  // namespace pos::estimation
