#pragma once
/// The part of an option table that does not depend on the struct it fills. Users of option tables need
/// options.hpp only.

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pos/io/yaml_document.hpp"

namespace pos::io {

/// Allowed values, in the unit of the key.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_excluded = false;
  bool max_excluded = false;
};
inline Range anything() {
  return {};
}
inline Range atLeast(double min) {
  return {.min = min};
}
inline Range moreThan(double min) {
  return {.min = min, .min_excluded = true};
}
inline Range between(double min, double max) {
  return {.min = min, .max = max};
}

/// What a user has to know of one key.
struct Option {
  enum class Kind { Number, Numbers, Integer, Text, Choice, Flag, Path, Table, List };
  Kind kind = Kind::Number;
  std::string key;   ///< ends in the unit: "range_std_m"
  std::string text;  ///< one plain sentence
  Range range = {};
  std::vector<std::string> choices = {};
  std::size_t count = 0;  ///< Numbers: how many; 0 is any number of them
  bool required = false;  ///< no default: the key has to be written
  bool optional = false;  ///< may be absent, and then has no value at all
};

/// One value on its way from the tree into a struct.
struct Field {
  const YamlNode& node;
  const Option& option;
  std::string path;  ///< "estimators[1].range_std_m"
};

struct TableCore;
enum class Comments { None, Explained };

/// One row of a table: the option and how it reaches its member.
struct OptionRow {
  Option option;
  std::function<void(void* object, const Field&)> read = {};
  /// Nothing for an absent optional member.
  std::function<std::optional<YamlNode>(const void* object, Comments)> write = {};
  std::shared_ptr<const TableCore> table = {};  ///< Table, List: the rows inside
  /// Table, List: the object that shows the inner defaults.
  std::function<std::shared_ptr<const void>(const void* object)> sample = {};
};

/// One of several sets of rows, chosen by the value of the table's selector key.
struct Alternative {
  std::string name;
  std::string text;
  std::shared_ptr<const TableCore> table;
  std::function<void*(void* object)> emplace;           ///< makes it the one held, with its defaults
  std::function<const void*(const void* object)> held;  ///< null when another one is held
  std::function<std::shared_ptr<const void>()> sample;  ///< its defaults
};

struct TableCore {
  std::string title;
  std::string text;
  std::vector<OptionRow> rows;
  std::string selector = {};  ///< key of the row that chooses among the alternatives
  std::vector<Alternative> alternatives = {};
  std::vector<std::function<void(const void* object)>> checks = {};  ///< rules across keys; throw ConfigError
};

/// One step of a key path: a name, or an index into a list.
struct PathStep {
  std::string name = {};
  std::optional<std::size_t> index = std::nullopt;
};
/// Steps of "estimators[1].range_std_m"; nothing when the text is no key path.
std::optional<std::vector<PathStep>> pathSteps(const std::string& path);
std::string joinedPath(const std::string& parent, const std::string& key);

/// Fills the object from the tree. Throws ConfigError with place, key path, got, expected, suggestion.
void readTable(const YamlNode& node, const TableCore& table, void* object, const std::string& path);
/// The object as a tree, complete with all defaults, each key explained if asked.
YamlNode writeTable(const TableCore& table, const void* object, Comments comments);

// Reading one value; all throw ConfigError.
double readNumber(const Field& field);                ///< SI
std::vector<double> readNumbers(const Field& field);  ///< SI
std::int64_t readInteger(const Field& field, std::int64_t min, std::int64_t max);
std::uint64_t readUnsigned(const Field& field, std::uint64_t max);
std::string readText(const Field& field);
bool readFlag(const Field& field);
std::size_t readChoice(const Field& field);  ///< index into the option's choices
const std::vector<YamlNode>& readList(const Field& field);

/// "a number in m, from 0 to 5": what a value of this option looks like.
std::string expectedText(const Option& option);
/// "0 to 5", "> 0", empty when anything goes.
std::string rangeText(const Range& range);
/// What stands in the file, for `got:`.
std::string describe(const YamlNode& node);

std::string markdownReference(const TableCore& table, const void* defaults);
std::string jsonSchema(const TableCore& table, const void* defaults);

}  // namespace pos::io
