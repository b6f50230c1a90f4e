#include "pos/sim/bias_law.hpp"

#include <cmath>

#include "pos/core/config_checks.hpp"

namespace pos::sim {

double drawn(const BiasLaw& law, RandomStream& random) {
  const double u = random.uniform();
  if (law.kind == BiasLaw::Kind::Uniform) return law.low + (law.high - law.low) * u;
  // Inverse distribution of the exponential cut off at `high`: F(x) = (1 - e^-x/m) / (1 - e^-X/m).
  const double kept = -std::expm1(-(law.high - law.low) / law.mean);
  return law.low - law.mean * std::log1p(-u * kept);
}

BiasLaw validated(BiasLaw law, const std::string& key) {
  requireFinite(law.low, key + ".low", "m");
  require(law.high >= law.low, key + ".high", "not below " + key + ".low");
  if (law.kind == BiasLaw::Kind::Exponential) {
    requirePositive(law.mean, key + ".mean", "m");
    require(law.high > law.low, key + ".high", "above " + key + ".low");
  } else {
    requireFinite(law.high, key + ".high", "m");
  }
  return law;
}

}  // namespace pos::sim
