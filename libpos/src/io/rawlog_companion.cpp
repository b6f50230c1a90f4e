#include "rawlog_companion.hpp"

#include <array>
#include <charconv>

namespace pos::io {
namespace {

constexpr std::string_view kHead = "pos 1 ";

template <typename T>
std::string written(T value) {
  std::array<char, 40> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

template <typename T>
std::optional<T> parsed(std::string_view text) {
  T value{};
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

bool plain(char c) {
  return c > ' ' && c <= '~' && c != '%' && c != '=' && c != ',';
}

/// Percent signs as in web addresses, so that a place's name may hold spaces and any letter.
std::string escaped(std::string_view word) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string result;
  for (const char c : word) {
    const auto byte = static_cast<unsigned char>(c);
    if (plain(c)) {
      result += c;
    } else {
      result += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
    }
  }
  return result;
}

std::optional<std::string> unescaped(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result += text[i];
      continue;
    }
    unsigned value = 0;
    if (i + 2 >= text.size()) return std::nullopt;
    const char* first = text.data() + i + 1;
    if (std::from_chars(first, first + 2, value, 16).ptr != first + 2) return std::nullopt;
    result += static_cast<char>(value);
    i += 2;
  }
  return result;
}

/// The part before the next `mark`; `rest` loses it and the mark.
std::string_view cutAt(std::string_view& rest, char mark) {
  const auto end = rest.find(mark);
  const std::string_view part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  return part;
}

}  // namespace

void Companion::put(const std::string& key, const std::vector<double>& values) {
  std::string list;
  for (const double value : values) list += (list.empty() ? "" : ",") + written(value);
  fields_[key] = list;
}

void Companion::putInteger(const std::string& key, std::int64_t value) {
  fields_[key] = written(value);
}

void Companion::putWord(const std::string& key, std::string_view word) {
  fields_[key] = escaped(word);
}

std::string Companion::text() const {
  std::string result = std::string(kHead) + kind_;
  for (const auto& [key, value] : fields_) {
    result += ' ';
    result += key;
    result += '=';
    result += value;
  }
  return result;
}

std::optional<Companion> Companion::fromText(std::string_view text) {
  if (!text.starts_with(kHead)) return std::nullopt;
  text.remove_prefix(kHead.size());
  Companion result{std::string(cutAt(text, ' '))};
  while (!text.empty()) {
    std::string_view field = cutAt(text, ' ');
    const std::string_view key = cutAt(field, '=');
    result.fields_[std::string(key)] = std::string(field);
  }
  return result;
}

std::optional<std::vector<double>> Companion::numbers(std::string_view key, std::size_t count) const {
  const auto found = fields_.find(key);
  if (found == fields_.end()) return std::nullopt;
  std::string_view rest = found->second;
  std::vector<double> result;
  while (!rest.empty()) {
    const auto value = parsed<double>(cutAt(rest, ','));
    if (!value) return std::nullopt;
    result.push_back(*value);
  }
  if (result.size() != count) return std::nullopt;
  return result;
}

std::optional<double> Companion::number(std::string_view key) const {
  const auto values = numbers(key, 1);
  return values ? std::optional(values->front()) : std::nullopt;
}

std::optional<std::int64_t> Companion::integer(std::string_view key) const {
  const auto found = fields_.find(key);
  if (found == fields_.end()) return std::nullopt;
  return parsed<std::int64_t>(found->second);
}

std::optional<std::string> Companion::word(std::string_view key) const {
  const auto found = fields_.find(key);
  if (found == fields_.end()) return std::nullopt;
  return unescaped(found->second);
}

}  // namespace pos::io
