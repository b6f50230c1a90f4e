#include "pos/report/text.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace pos::report {

namespace {

std::string formatted(const char* format, int decimals, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, decimals, value);
  return text.data();
}

bool continuesCharacter(char c) {
  return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U;
}

}  // namespace

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return std::string(kNoValue);
  std::string text = formatted("%.*f", decimals, value);
  if (text.starts_with('-') && text.find_first_of("123456789") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string rounded(double value) {
  for (const auto& [limit, decimals] :
       std::array<std::pair<double, int>, 3>{{{1.0, 3}, {10.0, 2}, {100.0, 1}}}) {
    const double half_step = 0.5 * std::pow(10.0, -decimals);
    if (std::abs(value) < limit - half_step) return fixed(value, decimals);
  }
  return fixed(value, 0);
}

std::string percent(double fraction) {
  if (fraction < 1.0 && fraction > 0.9994) return "> 99.9 %";
  return fixed(100.0 * fraction, 1) + " %";
}

std::string tickText(double value) {
  if (!std::isfinite(value)) return std::string(kNoValue);
  return formatted("%.*g", 8, std::abs(value) < 1e-12 ? 0.0 : value);
}

std::string grouped(unsigned long long count) {
  std::string digits = std::to_string(count);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, " ");
  return digits;
}

std::string momentText(Stamp stamp) {
  constexpr double kFirstCalendarSecond = 6.3e8;  // 1989-12-18: no recording is older
  if (secondsSinceOrigin(stamp) < kFirstCalendarSecond) return fixed(secondsSinceOrigin(stamp), 1) + " s";
  using namespace std::chrono;
  const sys_seconds moment{floor<std::chrono::seconds>(stamp.time_since_epoch())};
  const auto day = floor<days>(moment);
  const year_month_day date{day};
  const hh_mm_ss time{moment - day};
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02u %02d:%02d:%02d UTC", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                static_cast<int>(time.hours().count()), static_cast<int>(time.minutes().count()),
                static_cast<int>(time.seconds().count()));
  return text.data();
}

std::string durationText(Duration duration) {
  const double s = seconds(duration);
  if (std::abs(s) < 60.0) return fixed(s, 1) + " s";
  const long long whole = std::llround(s);
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole / 60 % 60) + " min";
}

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&') {
      safe += "&amp;";
    } else if (c == '<') {
      safe += "&lt;";
    } else if (c == '>') {
      safe += "&gt;";
    } else if (c == '"') {
      safe += "&quot;";
    } else if (static_cast<unsigned char>(c) >= 0x20U || c == '\n' || c == '\t') {
      safe += c;
    }
  }
  return safe;
}

std::size_t characterCount(std::string_view text) {
  std::size_t count = 0;
  for (const char c : text) count += continuesCharacter(c) ? 0 : 1;
  return count;
}

std::string shortened(std::string_view text, std::size_t characters) {
  if (characterCount(text) <= characters) return std::string(text);
  std::size_t seen = 0;
  std::size_t end = 0;
  for (; end < text.size(); ++end) {
    if (!continuesCharacter(text[end]) && ++seen == characters) break;
  }
  return std::string(text.substr(0, end)) + "\u2026";
}

}  // namespace pos::report
