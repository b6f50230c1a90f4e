#pragma once
/// A YAML file as a plain tree that remembers where every key and value stood. Stricter than YAML itself:
/// anchors, aliases, tags, several documents in one file, keys given twice and control characters are
/// refused.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "pos/core/error.hpp"

namespace pos::io {

/// The name of a value in a table and where it stands.
struct YamlKey {
  std::string name = {};
  FilePlace place = {};
};

/// One value: nothing, a scalar (still text), a list or a table.
struct YamlNode {
  enum class Kind { Null, Scalar, List, Table };
  Kind kind = Kind::Null;
  std::string text = {};  ///< Scalar: as written, without quotes
  bool quoted = false;    ///< Scalar: stood in quotes, so it is text whatever it looks like
  FilePlace place = {};
  std::vector<YamlKey> keys = {};    ///< Table: keys[i] names items[i]
  std::vector<YamlNode> items = {};  ///< List or Table
  std::string comment = {};          ///< written above the value, never read

  /// The value of a table's key, or null.
  const YamlNode* find(std::string_view name) const;
  YamlNode* find(std::string_view name);
  /// Where the key of a table stands, or the table's own place.
  const FilePlace& placeOfKey(std::string_view name) const;
  /// Adds a key and its value to a table.
  void add(std::string name, YamlNode value);
};

YamlNode textNode(std::string text);
YamlNode plainNode(std::string text);
YamlNode tableNode();
YamlNode listNode();

struct YamlDocument {
  std::filesystem::path file;  ///< as given by the caller
  YamlNode root;
};

/// The tree of `text`; `file` is the name used in messages. Throws ConfigError with line and column.
YamlDocument parseYaml(const std::string& text, const std::filesystem::path& file);

/// Reads and parses a file. Throws ConfigError; for a missing file it names the folder searched and near
/// names in it.
YamlDocument loadYaml(const std::filesystem::path& file);

/// The tree as YAML text in block style, two spaces a level, ending in a newline. Reading it back gives an
/// equal tree.
std::string yamlText(const YamlNode& node);

/// The tree as JSON text, two spaces a level. Plain scalars are written bare (numbers, true, false).
std::string jsonText(const YamlNode& node);

/// The tree on one line, for tables in documents and for messages.
std::string inlineText(const YamlNode& node);

}  // namespace pos::io
