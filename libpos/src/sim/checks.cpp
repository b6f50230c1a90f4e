#include "pos/sim/checks.hpp"

#include <cmath>

#include "pos/core/error.hpp"

namespace pos::sim {
namespace {

[[noreturn]] void refuse(const std::string& key, const std::string& got, const std::string& expected) {
  throw ConfigError(Complaint{
      .what = "a simulated sensor cannot work like this", .key = key, .got = got, .expected = expected});
}

}  // namespace

void requireFinite(double value, const std::string& key, const std::string& unit) {
  if (!std::isfinite(value)) refuse(key, std::to_string(value), "a number, " + unit);
}

void requirePositive(double value, const std::string& key, const std::string& unit) {
  if (!(value > 0.0) || !std::isfinite(value)) refuse(key, std::to_string(value), "> 0 " + unit);
}

void requireNotNegative(double value, const std::string& key, const std::string& unit) {
  if (!(value >= 0.0) || !std::isfinite(value)) refuse(key, std::to_string(value), ">= 0 " + unit);
}

void requireProbability(double value, const std::string& key) {
  if (!(value >= 0.0 && value <= 1.0)) refuse(key, std::to_string(value), "a probability, 0 to 1");
}

void requireSpan(const TimeSpan& span, const std::string& key) {
  if (!(span.from < span.to)) {
    refuse(key, std::to_string(span.from) + " to " + std::to_string(span.to),
           "a span that ends after it begins, s");
  }
}

void require(bool holds, const std::string& key, const std::string& expected) {
  if (!holds) refuse(key, "", expected);
}

}  // namespace pos::sim
