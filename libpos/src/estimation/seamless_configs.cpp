#include "pos/estimation/seamless_configs.hpp"

#include <algorithm>

#include "pos/core/config_checks.hpp"

namespace pos::estimation {

GnssUse validated(GnssUse config) {
  requireConfidence(config.confidence, "confidence");
  requirePositive(config.adapt_time, "adapt_time_s");
  requirePositive(config.sigma_max, "sigma_max_m");
  requireNotNegative(config.mask_margin, "mask_margin_m");
  return config;
}

UwbUse validated(UwbUse config) {
  requirePositive(config.sigma, "sigma_m");
  requireValid(config.robust, "robust");
  requireNotNegative(config.adapt_count, "adapt_count");
  requireValid(config.anchor_bias, "anchor_bias");
  return config;
}

InteractionConfig validated(InteractionConfig config) {
  require(config.stay > 0.5 && config.stay < 1.0, "stay", "more than 0.5 and less than 1");
  requirePositive(config.period, "period_s");
  requireShare(config.first_gnss, "first_gnss");
  require(config.floor > 0.0 && config.floor < 0.5, "floor", "more than 0 and less than 0.5");
  require(config.usable_floor >= config.floor && config.usable_floor < 0.5, "usable_floor",
          "no less than floor and less than 0.5");
  requireNotNegative(config.overdue, "overdue_s");
  require(config.rejected_in_a_row >= 1, "rejected_in_a_row", "at least 1");
  requirePositive(config.recover_after, "recover_after_s");
  require(config.rejoin_inflation >= 1.0, "rejoin_inflation", "at least 1");
  return config;
}

SeamlessAids validated(SeamlessAids config) {
  requireNotNegative(config.side_slip_sigma, "side_slip_sigma_m_per_s");
  requireNotNegative(config.floor_sigma, "floor_sigma_m");
  requirePositive(config.interval, "interval_s");
  return config;
}

SeamlessConfig validated(SeamlessConfig config) {
  require(config.start.mode == StartMode::Known || config.start.mode == StartMode::AtTruth, "start.mode",
          "known", "the inertial unit has to be told where it starts and which way it looks");
  requirePositive(config.start.position_sigma, "start.position_sigma_m");
  requirePositive(config.start.yaw_sigma, "start.yaw_sigma_deg");
  requirePositive(config.height_sigma, "height_sigma_m");
  requirePositive(config.velocity_sigma, "velocity_sigma_m_per_s");
  under("mounts", [&] { requireUniqueTags(config.mounts.tags); });
  requireValid(config.imu, "imu");
  requireValid(config.alignment, "alignment");
  requireValid(config.standstill, "standstill");
  requireValid(config.gnss, "gnss");
  requireValid(config.uwb, "uwb");
  requireValid(config.imm, "imm");
  requireValid(config.fuzzy, "fuzzy");
  requireValid(config.aids, "aids");
  return config;
}

}  // namespace pos::estimation
