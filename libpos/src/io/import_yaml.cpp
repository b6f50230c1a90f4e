#include "import_yaml.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "pos/io/text.hpp"

namespace pos::io::mapping_yaml {
namespace {

std::string shown(const YAML::Node& node) {
  if (node.IsScalar()) return "'" + node.Scalar() + "'";
  if (node.IsMap()) return "a map";
  return node.IsSequence() ? "a list" : "nothing";
}

}  // namespace

FilePlace placeOf(const YAML::Mark& mark, const std::string& file) {
  return {.file = file, .line = mark.line + 1, .column = mark.column + 1};
}

void refuse(const Entry& at, const std::string& what, const std::string& expected,
            const std::string& suggestion) {
  throw ConfigError(Complaint{.what = what,
                              .place = placeOf(at.node.Mark(), at.file),
                              .key = at.path,
                              .got = shown(at.node),
                              .expected = expected,
                              .suggestion = suggestion});
}

Entry childOf(const Entry& at, const std::string& key, const YAML::Node& node) {
  return {node, at.path.empty() ? key : at.path + "." + key, at.file};
}

void requireKeys(const Entry& at, const Keys& allowed) {
  if (!at.node.IsMap()) refuse(at, "expected a map", "keys " + text::joined(allowed));
  std::set<std::string> seen;
  for (const auto& pair : at.node) {
    const std::string key = pair.first.IsScalar() ? pair.first.Scalar() : "";
    const Entry here = childOf(at, key, pair.first);
    if (std::find(allowed.begin(), allowed.end(), key) == allowed.end()) {
      refuse(here, "unknown key", "one of " + text::joined(allowed), text::didYouMean(key, allowed));
    }
    if (!seen.insert(key).second) refuse(here, "the key is there twice", "every key once");
  }
}

std::optional<Entry> find(const Entry& at, const std::string& key) {
  for (const auto& pair : at.node) {
    if (pair.first.IsScalar() && pair.first.Scalar() == key) return childOf(at, key, pair.second);
  }
  return {};
}

Entry need(const Entry& at, const std::string& key, const std::string& expected) {
  if (const auto found = find(at, key)) return *found;
  throw ConfigError(Complaint{.what = "the key '" + key + "' is missing",
                              .place = placeOf(at.node.Mark(), at.file),
                              .key = at.path.empty() ? key : at.path + "." + key,
                              .expected = expected});
}

std::string textOf(const Entry& at, const std::string& expected) {
  if (!at.node.IsScalar() || at.node.Scalar().empty()) refuse(at, "expected a text", expected);
  return at.node.Scalar();
}

double numberOf(const Entry& at, const std::string& expected) {
  const auto value = at.node.IsScalar() ? text::number(at.node.Scalar()) : std::nullopt;
  if (!value) refuse(at, "expected a number", expected);
  return *value;
}

std::int32_t idOf(const Entry& at) {
  using Limits = std::numeric_limits<std::int32_t>;
  const auto value = at.node.IsScalar() ? text::integer(at.node.Scalar()) : std::nullopt;
  if (!value || *value < Limits::min() || *value > Limits::max()) {
    refuse(at, "expected a whole number", "the radio's own number, as 32-bit integer");
  }
  return static_cast<std::int32_t>(*value);
}

Duration secondsOf(const Entry& at, Duration limit, const std::string& expected) {
  const auto value = at.node.IsScalar() ? text::duration(at.node.Scalar()) : std::nullopt;
  if (!value || *value > limit || *value < -limit) refuse(at, "expected a time in seconds", expected);
  return *value;
}

std::vector<Entry> listOf(const Entry& at) {
  if (!at.node.IsSequence()) refuse(at, "expected a list", "entries that start with '- '");
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < at.node.size(); ++i) {
    entries.push_back({at.node[i], at.path + "[" + std::to_string(i) + "]", at.file});
  }
  return entries;
}

}  // namespace pos::io::mapping_yaml
