#include "pos/io/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "pos/core/edit_distance.hpp"

namespace pos::io::text {
namespace {

constexpr std::string_view kBlank = " \t";
constexpr std::int64_t kLargest = 4'600'000'000'000'000'000;  // ns; two of them still add up in 64 bits

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// from_chars takes no '+'; tables do.
std::string_view withoutPlus(std::string_view text) {
  return text.size() > 1 && text[0] == '+' && (isDigit(text[1]) || text[1] == '.') ? text.substr(1) : text;
}

int decimalsOf(TimeUnit unit) {
  switch (unit) {
    case TimeUnit::Seconds:
      return 9;
    case TimeUnit::Milliseconds:
      return 6;
    case TimeUnit::Microseconds:
      return 3;
    case TimeUnit::Nanoseconds:
      return 0;
  }
  return 0;
}

std::optional<Duration> roundedDuration(double value, int decimals) {
  const double ns = value * std::pow(10.0, decimals);
  if (!(std::abs(ns) < static_cast<double>(kLargest))) return {};
  return Duration{std::llround(ns)};
}

std::string plain(const char* begin, const char* end) {
  std::string text(begin, end);
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  if (is_zero && text.starts_with('-')) text.erase(0, 1);
  return text;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> found;
  for (std::size_t at = text.find_first_not_of(kBlank); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlank, at), text.size());
    found.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(kBlank, end);
  }
  return found;
}

std::optional<double> number(std::string_view text) {
  const std::string_view digits = withoutPlus(text);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value)) return {};
  return value;
}

std::optional<std::int64_t> integer(std::string_view text) {
  const std::string_view digits = withoutPlus(text);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc{} && end == digits.data() + digits.size()) return value;
  const std::optional<double> real = number(text);
  if (!real || *real != std::trunc(*real) || std::abs(*real) > 0x1p53) return {};
  return static_cast<std::int64_t>(*real);
}

std::optional<Duration> duration(std::string_view text, TimeUnit unit) {
  const int decimals = decimalsOf(unit);
  const std::optional<double> value = number(text);
  if (!value || !(std::abs(*value) * std::pow(10.0, decimals) < static_cast<double>(kLargest))) return {};
  if (text.find_first_of("eE") != std::string_view::npos) return roundedDuration(*value, decimals);
  // `text` is now known to be digits with at most one sign and one point
  std::int64_t ns = 0;
  int left = -1;  // decimals still to be filled; -1 before the point
  for (const char c : text) {
    if (c == '.') left = decimals;
    if (!isDigit(c)) continue;
    if (left == 0) {
      ns += c >= '5' ? 1 : 0;
      break;
    }
    ns = ns * 10 + (c - '0');
    if (left > 0) --left;
  }
  const bool has_point = text.find('.') != std::string_view::npos;
  for (int i = has_point ? std::max(left, 0) : decimals; i > 0; --i) ns *= 10;
  return Duration{text.starts_with('-') ? -ns : ns};
}

std::string stampSeconds(Stamp stamp) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t ns = stamp.time_since_epoch().count();
  const std::string fraction = std::to_string(std::abs(ns % kSecond));
  return (ns < 0 ? "-" : "") + std::to_string(std::abs(ns / kSecond)) + "." +
         std::string(9 - fraction.size(), '0') + fraction;
}

std::string fixed(double value, int decimals) {
  std::array<char, 400> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                          std::chars_format::fixed, std::clamp(decimals, 0, 20));
  return plain(buffer.data(), end);
}

std::string shortest(double value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return plain(buffer.data(), end);
}

std::string csvCell(std::string_view text) {
  std::string cell;
  for (const char c : text) {
    if (c == '"') cell += '"';
    cell += c == '\n' || c == '\r' ? ' ' : c;
  }
  const bool blank_ends = trimmed(cell).size() != cell.size();
  const bool needs_quotes = blank_ends || cell.starts_with('#') || cell.find_first_of(",\"") != cell.npos;
  return needs_quotes ? '"' + cell + '"' : cell;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates) {
  std::size_t least = std::max<std::size_t>(2, word.size() / 2) + 1;
  const std::string* best = nullptr;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = editDistance(word, candidate);
    if (distance < least) {
      least = distance;
      best = &candidate;
    }
  }
  return best == nullptr ? std::string{} : "did you mean '" + *best + "'?";
}

}  // namespace pos::io::text
