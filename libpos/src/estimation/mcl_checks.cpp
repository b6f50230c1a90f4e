#include "pos/estimation/mcl_checks.hpp"

#include "pos/core/config_checks.hpp"

namespace pos::estimation {
namespace {

/// As pos::require, said of the whole filter.
void require(bool holds, const char* key, const char* expected) {
  pos::require(holds, key, expected, "the particle filter cannot be set up");
}

}  // namespace

MclConfig checked(const MclConfig& config, const map::TunnelMap* map) {
  require(map != nullptr, "map", "a map");
  require(config.use_ranges || config.use_scans, "use_ranges", "use_ranges or use_scans (or both)");
  require(!config.use_ranges || !map->anchors.empty(), "use_ranges", "a map with anchors");
  require(!config.use_scans || map->grid.has_value(), "use_scans", "a map with an occupancy grid");
  require(config.range.sigma > 0.0 && config.range.range_max > 0.0, "range", "sigma and range_max above 0 m");
  require(config.range.outlier_probability > 0.0 && config.range.outlier_probability < 1.0,
          "range.outlier_probability", "between 0 and 1, both excluded");
  require(config.range.bias_sigma >= 0.0 && config.range.bias_time > 0.0, "range.bias_sigma",
          "bias_sigma at least 0 m, bias_time above 0 s");
  require(config.scan.beams > 0, "scan.beams", "at least 1");
  require(config.scan.sigma > 0.0 && config.scan.distance_max > 0.0, "scan",
          "sigma and distance_max above 0 m");
  require(config.scan.outlier_probability > 0.0 && config.scan.outlier_probability < 1.0,
          "scan.outlier_probability", "between 0 and 1, both excluded");
  require(config.scan.tempering > 0.0 && config.scan.correlation_length >= 0.0, "scan.tempering",
          "tempering above 0, correlation_length at least 0 m");
  require(config.particles.min >= 2 && config.particles.max >= config.particles.min, "particles",
          "2 <= min <= max");
  require(config.particles.kld_epsilon > 0.0 && config.particles.bin_position > 0.0 &&
              config.particles.bin_yaw > 0.0,
          "particles", "kld_epsilon, bin_position (m) and bin_yaw (rad) above 0");
  require(config.resample_below >= 0.0 && config.resample_below <= 1.0, "resample_below", "0 .. 1");
  return config;
}

}  // namespace pos::estimation
