#include <algorithm>
#include <charconv>

#include "pos/io/files.hpp"
#include "pos/io/option_core.hpp"
#include "pos/io/units.hpp"

namespace pos::io {
namespace {

/// The rows that apply: the table's own and those of the chosen alternative.
std::vector<const Option*> applicable(const TableCore& table, const Alternative* chosen) {
  std::vector<const Option*> options;
  for (const OptionRow& row : table.rows) options.push_back(&row.option);
  if (chosen != nullptr) {
    for (const OptionRow& row : chosen->table->rows) options.push_back(&row.option);
  }
  return options;
}

std::vector<std::string> keysOf(const std::vector<const Option*>& options) {
  std::vector<std::string> keys;
  for (const Option* option : options) keys.push_back(option->key);
  return keys;
}

bool hasKey(const TableCore& table, const std::string& key) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [&](const OptionRow& row) { return row.option.key == key; });
}

/// The same quantity under another unit, or with its unit left out.
std::optional<std::string> unitAdvice(const std::string& key, const std::vector<std::string>& known) {
  std::string right;
  for (const std::string& name : known) {
    if (stemOf(name) == stemOf(key) && !unitOf(name).suffix.empty())
      right += (right.empty() ? "" : " or ") + name;
  }
  if (right.empty()) return std::nullopt;
  return (key == stemOf(key) ? "the unit belongs in the key: use " : "wrong unit: use ") + right;
}

/// The key exists, but in a table one level down, or under another alternative.
std::optional<std::string> placeAdvice(const std::string& key, const TableCore& table,
                                       const Alternative* chosen) {
  const auto within = [&key](const TableCore& rows) -> std::optional<std::string> {
    for (const OptionRow& row : rows.rows) {
      if (row.table && hasKey(*row.table, key)) {
        return "did you mean " + row.option.key + (row.option.kind == Option::Kind::List ? "[]." : ".") +
               key + "?";
      }
    }
    return std::nullopt;
  };
  for (const Alternative& other : table.alternatives) {
    if (&other != chosen && hasKey(*other.table, key)) {
      return "this key belongs to " + table.selector + ": " + other.name;
    }
  }
  if (const auto own = within(table)) return own;
  return chosen != nullptr ? within(*chosen->table) : std::nullopt;
}

[[noreturn]] void refuseUnknown(const YamlKey& key, const TableCore& table, const Alternative* chosen,
                                const std::string& path) {
  const std::vector<std::string> known = keysOf(applicable(table, chosen));
  Complaint complaint{
      .what = "unknown key '" + key.name + "'", .place = key.place, .key = joinedPath(path, key.name)};
  const auto near = nearestName(key.name, known);
  if (const auto unit = unitAdvice(key.name, known)) {
    complaint.suggestion = *unit;
  } else if (const auto place = placeAdvice(key.name, table, chosen)) {
    complaint.suggestion = *place;
  } else if (near) {
    complaint.suggestion = "did you mean " + *near + "?";
  } else {
    for (const std::string& name : known)
      complaint.expected += (complaint.expected.empty() ? "one of: " : ", ") + name;
  }
  throw ConfigError(complaint);
}

void refuseUnknownKeys(const YamlNode& node, const TableCore& table, const Alternative* chosen,
                       const std::string& path) {
  const std::vector<std::string> known = keysOf(applicable(table, chosen));
  for (const YamlKey& key : node.keys) {
    if (std::find(known.begin(), known.end(), key.name) == known.end())
      refuseUnknown(key, table, chosen, path);
  }
}

[[noreturn]] void refuseMissing(const YamlNode& node, const Option& option, const std::string& path) {
  throw ConfigError(Complaint{.what = "the key '" + option.key + "' is missing",
                              .place = node.place,
                              .key = joinedPath(path, option.key),
                              .expected = expectedText(option),
                              .suggestion = option.text});
}

const YamlNode* valueOf(const YamlNode& node, const Option& option, const std::string& path) {
  const YamlNode* value = node.find(option.key);
  if (value == nullptr && option.required) refuseMissing(node, option, path);
  return value;
}

const Alternative* chooseAlternative(const YamlNode& node, const TableCore& table, const std::string& path) {
  for (const OptionRow& row : table.rows) {
    if (row.option.key != table.selector) continue;
    const YamlNode* value = valueOf(node, row.option, path);
    return &table.alternatives[readChoice({*value, row.option, joinedPath(path, row.option.key)})];
  }
  return nullptr;
}

void readRows(const YamlNode& node, const TableCore& table, void* object, const std::string& path) {
  for (const OptionRow& row : table.rows) {
    const YamlNode* value = valueOf(node, row.option, path);
    if (value != nullptr && row.read)
      row.read(object, {*value, row.option, joinedPath(path, row.option.key)});
  }
}

/// Where the value that a rule complains of stands, as deep as the file goes.
FilePlace placeOf(const YamlNode& table, const std::string& key) {
  const YamlNode* node = &table;
  FilePlace place = table.place;
  for (const PathStep& step : pathSteps(key).value_or(std::vector<PathStep>{})) {
    const YamlNode* next = nullptr;
    if (step.index) {
      next = *step.index < node->items.size() ? &node->items[*step.index] : nullptr;
    } else {
      next = node->find(step.name);
    }
    if (next == nullptr) break;
    place = step.index ? next->place : node->placeOfKey(step.name);
    node = next;
  }
  return place;
}

void runChecks(const YamlNode& node, const TableCore& table, const void* object, const std::string& path) {
  for (const auto& check : table.checks) {
    try {
      check(object);
    } catch (const ConfigError& error) {
      Complaint complaint = error.complaint();
      if (complaint.place.file.empty()) complaint.place = placeOf(node, complaint.key);
      complaint.key = joinedPath(path, complaint.key);
      throw ConfigError(complaint);
    }
  }
}

/// Steps of one part between dots: "a", "a[1]", "a[1][2]".
std::optional<std::vector<PathStep>> partSteps(const std::string& part) {
  const std::size_t bracket = std::min(part.find('['), part.size());
  if (bracket == 0) return std::nullopt;
  std::vector<PathStep> steps = {{.name = part.substr(0, bracket)}};
  for (std::size_t begin = bracket; begin < part.size();) {
    std::size_t index = 0;
    const char* first = part.data() + begin + 1;
    const auto result = std::from_chars(first, part.data() + part.size(), index);
    if (part[begin] != '[' || result.ec != std::errc{} || *result.ptr != ']') return std::nullopt;
    steps.push_back({.index = index});
    begin = static_cast<std::size_t>(result.ptr - part.data()) + 1;
  }
  return steps;
}

}  // namespace

std::optional<std::vector<PathStep>> pathSteps(const std::string& path) {
  std::vector<PathStep> steps;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const auto part = partSteps(path.substr(begin, end - begin));
    if (!part) return std::nullopt;
    steps.insert(steps.end(), part->begin(), part->end());
    begin = end + 1;
  }
  return steps;
}

std::string joinedPath(const std::string& parent, const std::string& key) {
  if (parent.empty() || key.empty()) return parent + key;
  return parent + (key.starts_with('[') ? "" : ".") + key;
}

void readTable(const YamlNode& node, const TableCore& table, void* object, const std::string& path) {
  if (node.kind != YamlNode::Kind::Table) {
    throw ConfigError(Complaint{.what = "this is not a table",
                                .place = node.place,
                                .key = path,
                                .got = describe(node),
                                .expected = "a table (key: value lines)",
                                .suggestion = table.text});
  }
  const Alternative* chosen = chooseAlternative(node, table, path);
  refuseUnknownKeys(node, table, chosen, path);
  readRows(node, table, object, path);
  if (chosen != nullptr) {
    void* inner = chosen->emplace(object);
    readRows(node, *chosen->table, inner, path);
    runChecks(node, *chosen->table, inner, path);
  }
  runChecks(node, table, object, path);
}

}  // namespace pos::io
