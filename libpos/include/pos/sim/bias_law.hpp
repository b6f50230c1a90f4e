#pragma once
/// Laws from which the size of a range error is drawn.

#include <limits>
#include <string>

#include "pos/core/random.hpp"

namespace pos::sim {

/// Uniform: between `low` and `high`. Exponential: `low` + an exponential of mean `mean`, cut off at `high`
/// (drawn from the truncated law, so nothing piles up at the limit). Metres.
struct BiasLaw {
  enum class Kind { Uniform, Exponential } kind = Kind::Uniform;
  double low = 0.0;
  double high = 0.0;  ///< Exponential: infinity = no cut-off
  double mean = 0.0;  ///< Exponential only, above `low` and before the cut-off

  static BiasLaw uniform(double low, double high) { return {Kind::Uniform, low, high, 0.0}; }
  static BiasLaw exponential(double mean, double low = 0.0,
                             double high = std::numeric_limits<double>::infinity()) {
    return {Kind::Exponential, low, high, mean};
  }
};

/// One value, m. Takes exactly one uniform number from `random`.
double drawn(const BiasLaw& law, RandomStream& random);

/// Throws ConfigError naming `key` when high < low, or the mean of an exponential is not positive.
BiasLaw validated(BiasLaw law, const std::string& key);

}  // namespace pos::sim
