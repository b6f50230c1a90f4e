#include "pos/core/config_checks.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace pos {
namespace {

/// The shortest text that reads back as the same number.
std::string shortest(double value) {
  std::array<char, 32> letters;
  return {letters.data(), std::to_chars(letters.data(), letters.data() + letters.size(), value).ptr};
}

std::string with(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + " " + unit;
}

std::string of(const std::string& owner, const std::string& what) {
  return owner.empty() ? what : owner + ": " + what;
}

}  // namespace

std::string prefixed(const std::string& table, const std::string& key) {
  return table.empty() || key.empty() ? table + key : table + "." + key;
}

std::string indexed(const std::string& list, std::size_t index) {
  return list + "[" + std::to_string(index) + "]";
}

void refuse(const std::string& what, const std::string& key, const std::string& got,
            const std::string& expected, const std::string& suggestion) {
  throw ConfigError(
      Complaint{.what = what, .key = key, .got = got, .expected = expected, .suggestion = suggestion});
}

void requireFinite(double value, const std::string& key, const std::string& unit, const std::string& owner) {
  if (std::isfinite(value)) return;
  refuse(of(owner, "the value is no number"), key, shortest(value), with("a finite number", unit));
}

void requirePositive(double value, const std::string& key, const std::string& unit,
                     const std::string& owner) {
  if (value > 0.0 && std::isfinite(value)) return;
  refuse(of(owner, "the value has to be positive"), key, shortest(value), with("> 0", unit));
}

void requireNotNegative(double value, const std::string& key, const std::string& unit,
                        const std::string& owner) {
  if (value >= 0.0 && std::isfinite(value)) return;
  refuse(of(owner, "the value must not be negative"), key, shortest(value), with(">= 0", unit));
}

void requireShare(double value, const std::string& key) {
  if (value >= 0.0 && value <= 1.0) return;
  refuse("the value has to be a share", key, shortest(value), "0 to 1");
}

void requireConfidence(double value, const std::string& key) {
  if (value > 0.0 && value < 1.0) return;
  refuse("the value has to be a confidence", key, shortest(value), "> 0 and < 1");
}

void require(bool holds, const std::string& key, const std::string& expected, const std::string& what) {
  if (!holds) refuse(what, key, "", expected);
}

}  // namespace pos
