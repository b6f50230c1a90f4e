#include "scanner.hpp"

#include <cmath>

#include "pos/core/config_checks.hpp"

namespace pos::sim {

Scanner::Scanner(const ScannerConfig& config, const Timing& timing, const RunSetup& run)
    : config_(config),
      noise_(randomStream(run, timing, Ticker::kFirstPurpose)),
      drops_(randomStream(run, timing, Ticker::kFirstPurpose + 1)) {
  for (int beam = 0; beam < config_.beams; ++beam) {
    const double angle = trueAngle(reportedAngle(beam), config_.errors);
    looks_.emplace_back(std::cos(angle), std::sin(angle));
  }
}

Eigen::Vector2d Scanner::look(int beam) {
  const Eigen::Vector2d& straight = looks_[static_cast<std::size_t>(beam)];
  if (config_.sigma_angle == 0.0) return straight;
  return rotation2(noise_.normal(0.0, config_.sigma_angle)) * straight;
}

double Scanner::reportedAngleOf(double truth) {
  const double angle = measuredAngle(truth, config_.errors);
  return config_.sigma_angle > 0.0 ? angle + noise_.normal(0.0, config_.sigma_angle) : angle;
}

double Scanner::dropProbability(double t) const {
  for (const Dust& dust : config_.dust) {
    if (dust.when.contains(t)) return dust.drop_probability;
  }
  return config_.drop_probability;
}

std::optional<double> Scanner::reportedRange(double t, double truth) {
  if (!(truth >= config_.range_min && truth <= config_.range_max)) return {};
  double range = measuredRange(truth, config_.errors);
  if (config_.sigma_range > 0.0) range += noise_.normal(0.0, config_.sigma_range);
  const double drop = dropProbability(t);
  if (drop > 0.0 && drops_.bernoulli(drop)) return {};
  if (range <= 0.0) return {};
  return range;
}

Scan2D Scanner::sweep(double t, const std::vector<double>& truths) {
  Scan2D scan{.T_body_sensor = config_.T_body_sensor,
              .angle_first = config_.angle_first,
              .angle_step = config_.angle_step,
              .range_max = config_.range_max,
              .ranges = std::vector<float>(truths.size(), 0.0F),
              .valid = std::vector<std::uint8_t>(truths.size(), 0)};
  for (std::size_t i = 0; i < truths.size(); ++i) {
    if (const std::optional<double> range = reportedRange(t, truths[i])) {
      scan.ranges[i] = static_cast<float>(*range);
      scan.valid[i] = 1;
    }
  }
  return scan;
}

ScannerConfig validated(ScannerConfig config, const std::string& key) {
  requireFinite(config.angle_first, key + ".angle_first", "rad");
  require(config.angle_step != 0.0 && std::isfinite(config.angle_step), key + ".angle_step", "not 0, rad");
  require(config.beams >= 1, key + ".beams", ">= 1");
  requireNotNegative(config.range_min, key + ".range_min", "m");
  requirePositive(config.range_max, key + ".range_max", "m");
  require(config.range_max > config.range_min, key + ".range_max", "above range_min");
  requireNotNegative(config.sigma_range, key + ".sigma_range", "m");
  requireNotNegative(config.sigma_angle, key + ".sigma_angle", "rad");
  requireShare(config.drop_probability, key + ".drop_probability");
  for (const Dust& dust : config.dust) {
    requireSpan(dust.when, key + ".dust.when");
    requireShare(dust.drop_probability, key + ".dust.drop_probability");
  }
  (void)validated(config.errors, key + ".errors");
  const bool straight = config.errors.a1 == 0.0 && config.errors.a2 == 1.0 && config.errors.a3 == 0.0;
  const double last = config.angle_first + (config.beams - 1) * config.angle_step;
  const double low = std::min(config.angle_first, last);
  const double high = std::max(config.angle_first, last);
  require(straight || (low >= -0.01 && high <= kPi + 0.01), key + ".errors",
          "beams between 0 and 180 degrees, where the angle polynomial holds");
  require(high - low < 2.0 * kPi, key + ".beams", "a sweep of less than a full turn");
  return config;
}

}  // namespace pos::sim
