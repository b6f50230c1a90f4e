#pragma once
/// Checks shared by the configurations of simulated sensors. Each throws ConfigError naming the key.

#include <string>

#include "pos/sim/timing.hpp"

namespace pos::sim {

void requireFinite(double value, const std::string& key, const std::string& unit);
/// Positive and finite.
void requirePositive(double value, const std::string& key, const std::string& unit);
/// Zero or more, and finite.
void requireNotNegative(double value, const std::string& key, const std::string& unit);
/// Between 0 and 1.
void requireProbability(double value, const std::string& key);
/// Ends after it begins.
void requireSpan(const TimeSpan& span, const std::string& key);
/// Anything else: `holds` or a complaint that says what was expected.
void require(bool holds, const std::string& key, const std::string& expected);

}  // namespace pos::sim
