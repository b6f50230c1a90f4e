#include "dxf_records.hpp"

#include <cmath>

#include "pos/core/error.hpp"
#include "pos/io/text.hpp"

namespace pos::io::dxf {
namespace {

constexpr double kLargest = 1e10;  // drawing units; also 1e7 m in mm

/// The next line without its end, and cut from the rest.
std::string_view nextLine(std::string_view& rest) {
  const std::size_t end = std::min(rest.find('\n'), rest.size());
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

[[noreturn]] void refuse(const std::string& file, int line, const std::string& what, const std::string& got,
                         const std::string& suggestion = {}) {
  throw DataError(Complaint{.what = what,
                            .place = {.file = file, .line = line},
                            .got = got,
                            .expected = "ASCII DXF: a group code and its value on alternate lines",
                            .suggestion = suggestion});
}

std::string shown(std::string_view text) {
  return "'" + plainText(text.substr(0, 40)) + "'";
}

void append(std::string& out, unsigned code) {
  if (code < 0x80U) {
    out += static_cast<char>(code);
  } else if (code < 0x800U) {
    out += static_cast<char>(0xC0U | (code >> 6U));
    out += static_cast<char>(0x80U | (code & 0x3FU));
  } else {
    out += static_cast<char>(0xE0U | (code >> 12U));
    out += static_cast<char>(0x80U | ((code >> 6U) & 0x3FU));
    out += static_cast<char>(0x80U | (code & 0x3FU));
  }
}

/// Length of the UTF-8 character at `i`; 0 where there is none.
std::size_t utf8Length(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const std::size_t length = byte(i) < 0x80   ? 1
                             : byte(i) < 0xC2 ? 0
                             : byte(i) < 0xE0 ? 2
                             : byte(i) < 0xF0 ? 3
                                              : 4;
  if (length == 0 || byte(i) > 0xF4 || i + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(i + k) & 0xC0U) != 0x80U) return 0;
  }
  const bool overlong = (byte(i) == 0xE0 && byte(i + 1) < 0xA0) || (byte(i) == 0xF0 && byte(i + 1) < 0x90);
  const bool beyond = (byte(i) == 0xED && byte(i + 1) >= 0xA0) || (byte(i) == 0xF4 && byte(i + 1) >= 0x90);
  return overlong || beyond ? 0 : length;
}

/// The code of "\U+00E4" at `i`, or nothing. Halves of surrogate pairs are none.
std::optional<unsigned> escapedCode(std::string_view text, std::size_t i) {
  if (text.substr(i, 3) != "\\U+" || text.size() < i + 7) return std::nullopt;
  unsigned code = 0;
  for (const char c : text.substr(i + 3, 4)) {
    const int digit = c >= '0' && c <= '9'   ? c - '0'
                      : c >= 'A' && c <= 'F' ? c - 'A' + 10
                      : c >= 'a' && c <= 'f' ? c - 'a' + 10
                                             : -1;
    if (digit < 0) return std::nullopt;
    code = code * 16U + static_cast<unsigned>(digit);
  }
  const bool control = code < 0x20U || (code >= 0x7FU && code < 0xA0U);
  if (control || (code >= 0xD800U && code < 0xE000U) || code >= 0xFFFEU) return std::nullopt;
  return code;
}

}  // namespace

std::string_view Record::text(int code) const {
  for (const Group& group : groups) {
    if (group.code == code) return group.value;
  }
  return {};
}

bool Record::has(int code) const {
  for (const Group& group : groups) {
    if (group.code == code) return true;
  }
  return false;
}

Groups groupsOf(std::string_view text, const std::string& file) {
  if (text.starts_with("AutoCAD Binary DXF")) {
    refuse(file, 1, "this is a binary DXF", "AutoCAD Binary DXF", "save it again as ASCII DXF");
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  Groups groups;
  int line = 0;
  while (!text.empty()) {
    const std::string_view code_text = text::trimmed(nextLine(text));
    line += 2;
    if (code_text.empty() && text.empty()) break;
    const auto code = text::integer(code_text);
    if (!code || *code < -10 || *code > 2000) {
      refuse(file, line - 1, "this line is no group code", shown(code_text),
             groups.all.empty() ? "check that the file is a DXF drawing" : "the file is damaged here");
    }
    const std::string_view value = nextLine(text);
    if (*code == 999) {
      if (text::trimmed(value) == "pos: unit m") groups.stated_unit = 1.0;
      continue;
    }
    groups.all.push_back(
        {static_cast<int>(*code), *code == 1 || *code == 3 ? value : text::trimmed(value), line - 1});
    if (*code == 0 && text::trimmed(value) == "EOF") {
      groups.complete = true;
      break;
    }
  }
  if (groups.all.empty()) refuse(file, 1, "the drawing is empty", "nothing");
  return groups;
}

std::vector<Record> recordsOf(const std::vector<Group>& groups) {
  std::vector<Record> records;
  for (std::size_t i = 0; i < groups.size();) {
    std::size_t end = i + 1;
    while (end < groups.size() && groups[end].code != 0) ++end;
    if (groups[i].code == 0) {
      records.push_back({groups[i].value, std::span(groups).subspan(i + 1, end - i - 1), groups[i].line});
    }
    i = end;
  }
  return records;
}

double Numbers::checked(std::string_view text, int code) {
  const auto value = text::number(text);
  if (value && std::abs(*value) <= kLargest) return *value;
  if (trouble_.empty()) {
    trouble_ = "damaged: group " + std::to_string(code) + (value ? " is too large" : " is no number");
  }
  return 0.0;
}

double Numbers::operator()(int code, double otherwise) {
  return record_.has(code) ? checked(record_.text(code), code) : otherwise;
}

double Numbers::need(int code) {
  if (!record_.has(code) && trouble_.empty())
    trouble_ = "damaged: group " + std::to_string(code) + " is missing";
  return (*this)(code, 0.0);
}

int Numbers::whole(int code, int otherwise) {
  const double value = (*this)(code, otherwise);
  return std::abs(value) < 1e9 ? static_cast<int>(value) : otherwise;
}

Eigen::Vector3d Numbers::point() {
  const double x = need(10);
  const double y = need(20);
  return {x, y, (*this)(30, 0.0)};
}

std::string plainText(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    if (const auto code = escapedCode(text, i)) {
      append(out, *code);
      i += 7;
    } else if (text[i] == '%' && text.substr(i, 2) == "%%" && i + 2 < text.size()) {
      const char sign = text[i + 2];
      out += sign == 'd' || sign == 'D'   ? "\u00b0"
             : sign == 'p' || sign == 'P' ? "\u00b1"
             : sign == 'c' || sign == 'C' ? "\u2300"
                                          : "";
      i += 3;
    } else if (const std::size_t length = utf8Length(text, i); length > 1) {
      const std::string_view character = text.substr(i, length);
      const bool control =
          length == 2 && character[0] == '\xC2' && static_cast<unsigned char>(character[1]) < 0xA0;
      if (!control) out += character;
      i += length;
    } else {
      const auto byte = static_cast<unsigned char>(text[i]);
      if (byte >= 0x80) out += '?';
      if (byte >= 0x20 && byte < 0x7F) out += text[i];
      ++i;
    }
  }
  return std::string(text::trimmed(out));
}

void SkipList::add(std::string_view layer, std::string_view type, const std::string& reason, int line,
                   std::size_t count) {
  const std::string key = std::string(layer) + '\n' + std::string(type) + '\n' + reason;
  DxfSkipped& entry = found_[key];
  if (entry.count == 0) entry = {plainText(layer), plainText(type), reason, 0, line};
  entry.count += count;
}

std::vector<DxfSkipped> SkipList::list() const {
  std::vector<DxfSkipped> all;
  for (const auto& [key, entry] : found_) all.push_back(entry);
  return all;
}

}  // namespace pos::io::dxf
