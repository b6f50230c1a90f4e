#include "pos/io/units.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace pos::io {
namespace {

constexpr long double kDegree = std::numbers::pi_v<long double> / 180.0L;
/// sqrt(kDegree): a walk per square root of an angle, deg / sqrt(deg) = kDegree / sqrt(kDegree) in SI.
constexpr long double kRootDegree = 0.13211090992020036711L;

constexpr std::array<Unit, 44> kUnits = {{
    {"_m", "m", 1.0L},
    {"_s", "s", 1.0L},
    {"_deg", "deg", kDegree},
    {"_hz", "Hz", 1.0L},
    {"_m_per_s", "m/s", 1.0L},
    {"_deg_per_s", "deg/s", kDegree},
    {"_per_sqrt_s", "1/sqrt(s)", 1.0L},
    {"_m_per_sqrt_s", "m/sqrt(s)", 1.0L},
    {"_s_per_sqrt_s", "s/sqrt(s)", 1.0L},
    {"_deg_per_sqrt_s", "deg/sqrt(s)", kDegree},
    {"_m_per_s_per_sqrt_s", "m/s/sqrt(s)", 1.0L},
    {"_deg_per_s_per_sqrt_s", "deg/s/sqrt(s)", kDegree},
    {"_m_per_sqrt_m", "m/sqrt(m)", 1.0L},
    {"_deg_per_sqrt_m", "deg/sqrt(m)", kDegree},
    {"_deg_per_sqrt_deg", "deg/sqrt(deg)", kRootDegree},
    {"_m_per_s2", "m/s^2", 1.0L},
    {"_m_per_s2_per_sqrt_s", "m/s^2/sqrt(s)", 1.0L},
    {"_deg_per_m", "deg/m", kDegree},
    {"_deg_per_h", "deg/h", kDegree / 3600.0L},
    {"_deg_per_sqrt_h", "deg/sqrt(h)", kDegree / 60.0L},
    {"_deg_per_h_per_sqrt_h", "deg/h/sqrt(h)", kDegree / 216000.0L},
    {"_ug", "ug (1e-6 * 9.80665 m/s^2)", 9.80665e-6L},
    {"_ug_per_sqrt_hz", "ug/sqrt(Hz)", 9.80665e-6L},
    {"_ppm", "ppm", 1e-6L},
    {"_db", "dB", 1.0L},
    {"_dbm", "dBm", 1.0L},
    {"_mm", "mm", 1.0L, false},
    {"_cm", "cm", 1.0L, false},
    {"_dm", "dm", 1.0L, false},
    {"_km", "km", 1.0L, false},
    {"_ft", "ft", 1.0L, false},
    {"_ns", "ns", 1.0L, false},
    {"_us", "us", 1.0L, false},
    {"_ms", "ms", 1.0L, false},
    {"_min", "min", 1.0L, false},
    {"_h", "h", 1.0L, false},
    {"_khz", "kHz", 1.0L, false},
    {"_rad", "rad", 1.0L, false},
    {"_mrad", "mrad", 1.0L, false},
    {"_km_per_h", "km/h", 1.0L, false},
    {"_rad_per_s", "rad/s", 1.0L, false},
    {"_rad_per_sqrt_s", "rad/sqrt(s)", 1.0L, false},
    {"_rad_per_sqrt_m", "rad/sqrt(m)", 1.0L, false},
    {"_percent", "percent", 1.0L, false},
}};

Unit longestUnit(std::string_view key, bool for_options) {
  Unit longest;
  for (const Unit& unit : kUnits) {
    const bool fits = key.size() > unit.suffix.size() && key.ends_with(unit.suffix);
    if (fits && unit.suffix.size() > longest.suffix.size() && (unit.used_by_options || !for_options)) {
      longest = unit;
    }
  }
  return longest;
}

std::size_t digitsFrom(std::string_view text, std::size_t i) {
  while (i < text.size() && text[i] >= '0' && text[i] <= '9') ++i;
  return i;
}

std::size_t afterSign(std::string_view text) {
  return !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
}

bool hasLeadingZero(std::string_view text, std::size_t begin, std::size_t end) {
  return end - begin > 1 && text[begin] == '0';
}

std::string written(long double value, std::chars_format format, int precision) {
  std::array<char, 80> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format, precision);
  return {buffer.data(), end.ptr};
}

/// The same digits without an exponent, where that is easier to read.
std::string withoutExponent(long double value, int digits) {
  const int exponent = value == 0.0L ? 0 : static_cast<int>(std::floor(std::log10(std::fabs(value))));
  if (exponent < -5 || exponent > 8) return written(value, std::chars_format::general, digits);
  return written(value, std::chars_format::fixed, std::max(0, digits - 1 - exponent));
}

}  // namespace

Unit unitOf(std::string_view key) {
  return longestUnit(key, true);
}

std::string_view stemOf(std::string_view key) {
  return key.substr(0, key.size() - longestUnit(key, false).suffix.size());
}

std::string numberText(double value, std::string_view key) {
  const long double shown = static_cast<long double>(value) / unitOf(key).to_si;
  for (int digits = 1; digits <= 21; ++digits) {
    const std::string text = withoutExponent(shown, digits);
    if (siValue(text, key) == value) return text;
  }
  return written(shown, std::chars_format::general, 25);
}

double siValue(std::string_view text, std::string_view key) {
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.data() + text.size();
  const Unit unit = unitOf(key);
  if (unit.to_si == 1.0L) {
    double value = 0.0;
    const auto result = std::from_chars(begin, end, value);
    return result.ec == std::errc::result_out_of_range ? std::strtod(std::string(text).c_str(), nullptr)
                                                       : value;
  }
  long double value = 0.0L;
  const auto result = std::from_chars(begin, end, value);
  if (result.ec == std::errc::result_out_of_range) value = std::strtold(std::string(text).c_str(), nullptr);
  return static_cast<double>(value * unit.to_si);
}

bool isNumber(std::string_view text) {
  const std::size_t begin = afterSign(text);
  std::size_t i = digitsFrom(text, begin);
  std::size_t digits = i - begin;
  if (hasLeadingZero(text, begin, i)) return false;
  if (i < text.size() && text[i] == '.') {
    const std::size_t fraction = digitsFrom(text, i + 1);
    digits += fraction - (i + 1);
    i = fraction;
  }
  if (digits == 0) return false;
  if (i == text.size()) return true;
  if (text[i] != 'e' && text[i] != 'E') return false;
  const std::size_t exponent = i + 1 + afterSign(text.substr(i + 1));
  return exponent < text.size() && digitsFrom(text, exponent) == text.size();
}

bool isWholeNumber(std::string_view text) {
  const std::size_t begin = afterSign(text);
  return begin < text.size() && digitsFrom(text, begin) == text.size() &&
         !hasLeadingZero(text, begin, text.size());
}

}  // namespace pos::io
