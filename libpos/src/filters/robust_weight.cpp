#include "pos/filters/robust_weight.hpp"

#include <cmath>

#include "pos/core/config_checks.hpp"
#include "pos/core/square.hpp"

namespace pos::filters {

RobustConfig validated(RobustConfig config) {
  requirePositive(config.k0, "k0");
  requirePositive(config.k0_upward, "k0_upward");
  require(config.k1 > config.k0 && config.k1 > config.k0_upward, "k1", "more than k0 and k0_upward",
          "readings cannot be rejected before they are doubted");
  return config;
}

std::optional<double> varianceFactor(const RobustConfig& config, double s) {
  if (config.form == RobustConfig::Form::None) return 1.0;
  const double k0 = s > 0.0 ? config.k0_upward : config.k0;
  const double size = std::abs(s);
  if (size <= k0) return 1.0;
  if (size >= config.k1) return std::nullopt;
  const double huber = size / k0;
  if (config.form == RobustConfig::Form::Huber) return huber;
  return huber * square((config.k1 - k0) / (config.k1 - size));
}

}  // namespace pos::filters
