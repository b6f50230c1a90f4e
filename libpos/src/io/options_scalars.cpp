#include <algorithm>
#include <charconv>
#include <cmath>

#include "pos/io/files.hpp"
#include "pos/io/options.hpp"
#include "pos/io/units.hpp"

namespace pos::io {
namespace {

std::string plain(double value) {
  return numberText(value, "");
}

[[noreturn]] void refuse(const Field& field, const std::string& what, const std::string& suggestion = "") {
  throw ConfigError(Complaint{.what = what,
                              .place = field.node.place,
                              .key = field.path,
                              .got = describe(field.node),
                              .expected = expectedText(field.option),
                              .suggestion = suggestion});
}

/// The text of a value that has to be an unquoted scalar.
const std::string& plainText(const Field& field, const std::string& wanted) {
  if (field.node.kind != YamlNode::Kind::Scalar) refuse(field, "this is not " + wanted);
  if (field.node.quoted) refuse(field, "this is text in quotes, not " + wanted, "remove the quotes");
  return field.node.text;
}

/// What a text that is no number may have meant.
std::string numberAdvice(const std::string& text) {
  const std::string comma = std::string(text).replace(std::min(text.find(','), text.size()), 1, ".");
  if (text.find(',') != std::string::npos && isNumber(comma)) return "write " + comma;
  std::size_t length = text.size();
  while (length > 0 && !isNumber(text.substr(0, length))) --length;
  const std::string number = text.substr(0, length);
  const std::string rest = text.substr(length);
  if (number.empty()) return "";
  if (rest.find_first_not_of(" abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ/%") ==
          std::string::npos &&
      number != "0") {
    return "the unit stands in the key; write " + number;
  }
  const std::size_t digit = text.find_first_not_of("+-0");
  const std::string trimmed = digit == std::string::npos ? "0" : text.substr(digit);
  if (number == "0" && isNumber(trimmed)) return "a leading zero may mean octal; write " + trimmed;
  return "";
}

void checkRange(const Field& field, double value) {
  const Range& range = field.option.range;
  const bool low = range.min_excluded ? value <= range.min : value < range.min;
  const bool high = range.max_excluded ? value >= range.max : value > range.max;
  if (low || high) refuse(field, low ? "the value is too small" : "the value is too large");
}

/// Text that is a whole number; its size is not checked.
const std::string& wholeText(const Field& field) {
  const std::string& text = plainText(field, "a whole number");
  if (isWholeNumber(text)) return text;
  if (isNumber(text)) refuse(field, "this is not a whole number", "write it without a point or exponent");
  refuse(field, "this is not a number", numberAdvice(text));
}

template <class I>
I wholeNumber(const Field& field, I min, I max) {
  const std::string& text = wholeText(field);
  I value{};
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto result = std::from_chars(begin, text.data() + text.size(), value);
  if (result.ec != std::errc{} || value < min || value > max) {
    refuse(field, text.starts_with('-') ? "the value is too small" : "the value is too large");
  }
  checkRange(field, static_cast<double>(value));
  return value;
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

namespace detail {

YamlNode writtenNumber(double value, const std::string& key) {
  return plainNode(numberText(value, key));
}

std::optional<YamlNode> writtenText(const std::string& value) {
  return value.empty() ? std::nullopt : std::optional(textNode(value));
}

}  // namespace detail

std::string rangeText(const Range& range) {
  const bool below = std::isfinite(range.max);
  const bool above = std::isfinite(range.min);
  if (above && below && range.min == range.max) return plain(range.min);
  if (above && below && !range.min_excluded && !range.max_excluded) {
    return plain(range.min) + " to " + plain(range.max);
  }
  std::string text = above ? (range.min_excluded ? "> " : ">= ") + plain(range.min) : "";
  if (above && below) text += " and ";
  return below ? text + (range.max_excluded ? "< " : "<= ") + plain(range.max) : text;
}

std::string expectedText(const Option& option) {
  const std::string unit(unitOf(option.key).symbol);
  const std::string range = rangeText(option.range);
  const std::string tail = (unit.empty() ? "" : " in " + unit) + (range.empty() ? "" : ", " + range);
  switch (option.kind) {
    case Option::Kind::Number:
      return "a number" + tail;
    case Option::Kind::Numbers:
      return "a list of " + (option.count > 0 ? std::to_string(option.count) + " " : "") + "numbers" + tail;
    case Option::Kind::Integer:
      return "a whole number" + tail;
    case Option::Kind::Text:
      return "text, not empty";
    case Option::Kind::Path:
      return "a path";
    case Option::Kind::Flag:
      return "true or false";
    case Option::Kind::Choice:
      return "one of: " + listed(option.choices);
    case Option::Kind::Table:
      return "a table (key: value lines)";
    case Option::Kind::List:
      return "a list of tables";
  }
  return "";
}

std::string describe(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::Null:
      return "nothing";
    case YamlNode::Kind::Scalar:
      return node.quoted ? "\"" + node.text + "\"" : node.text;
    case YamlNode::Kind::List:
      return "a list of " + std::to_string(node.items.size());
    case YamlNode::Kind::Table:
      return "a table of " + std::to_string(node.items.size()) + (node.items.size() == 1 ? " key" : " keys");
  }
  return "";
}

double readNumber(const Field& field) {
  const std::string& text = plainText(field, "a number");
  if (!isNumber(text)) {
    std::string word = text;
    std::erase_if(word, [](char c) { return c == '.' || c == '-' || c == '+'; });
    std::transform(word.begin(), word.end(), word.begin(),
                   [](char c) { return static_cast<char>(c | 0x20); });
    if (word == "nan" || word == "inf") refuse(field, "the number has to be finite");
    refuse(field, "this is not a number", numberAdvice(text));
  }
  const double value = siValue(text, field.option.key);
  if (!std::isfinite(value)) refuse(field, "the number is too large for the machine");
  checkRange(field, siValue(text, ""));
  return value;
}

std::vector<double> readNumbers(const Field& field) {
  if (field.node.kind != YamlNode::Kind::List)
    refuse(field, "this is not a list of numbers", "write [1, 2, 3]");
  if (field.option.count > 0 && field.node.items.size() != field.option.count) {
    refuse(field, "the list has the wrong length");
  }
  std::vector<double> values;
  for (const YamlNode& item : field.node.items) {
    const std::string path = field.path + "[" + std::to_string(values.size()) + "]";
    values.push_back(readNumber({item, field.option, path}));
  }
  return values;
}

std::int64_t readInteger(const Field& field, std::int64_t min, std::int64_t max) {
  return wholeNumber<std::int64_t>(field, min, max);
}

std::uint64_t readUnsigned(const Field& field, std::uint64_t max) {
  return wholeNumber<std::uint64_t>(field, 0, max);
}

std::string readText(const Field& field) {
  if (field.node.kind != YamlNode::Kind::Scalar) refuse(field, "this is not text");
  if (field.node.text.empty()) refuse(field, "the text is empty");
  return field.node.text;
}

bool readFlag(const Field& field) {
  const std::string& text = plainText(field, "true or false");
  if (text == "true" || text == "false") return text == "true";
  for (const char* yes : {"True", "TRUE", "yes", "Yes", "on", "On", "1"}) {
    if (text == yes) refuse(field, "this is not true or false", "write true");
  }
  for (const char* no : {"False", "FALSE", "no", "No", "off", "Off", "0"}) {
    if (text == no) refuse(field, "this is not true or false", "write false");
  }
  refuse(field, "this is not true or false");
}

std::size_t readChoice(const Field& field) {
  if (field.node.kind != YamlNode::Kind::Scalar) refuse(field, "this is not a word");
  const auto& choices = field.option.choices;
  const auto found = std::find(choices.begin(), choices.end(), field.node.text);
  if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  const auto near = nearestName(field.node.text, choices);
  refuse(field, "this is not one of the choices", near ? "did you mean " + *near + "?" : "");
}

const std::vector<YamlNode>& readList(const Field& field) {
  if (field.node.kind == YamlNode::Kind::List) return field.node.items;
  refuse(field, "this is not a list", "write `- ` before each item, or [] for none");
}

}  // namespace pos::io
