#include <algorithm>

#include "pos/io/map_yaml.hpp"

namespace pos::io {
namespace {

bool isScalar(const YamlNode& node) {
  return node.kind == YamlNode::Kind::Scalar || node.kind == YamlNode::Kind::Null;
}

bool same(const YamlNode& a, const YamlNode& b) {
  return inlineText(a) == inlineText(b);
}

YamlNode withoutDefaults(const YamlNode& node, const TableCore& table, const void* defaults) {
  const YamlNode standard = writeTable(table, defaults, Comments::None);
  YamlNode kept = tableNode();
  for (const OptionRow& row : table.rows) {
    const YamlNode* value = node.find(row.option.key);
    if (value == nullptr) continue;
    YamlNode inner = *value;
    if (row.table) {
      const auto sample = row.sample(defaults);
      if (row.option.kind == Option::Kind::Table) inner = withoutDefaults(*value, *row.table, sample.get());
      if (row.option.kind == Option::Kind::List) {
        for (YamlNode& item : inner.items) item = withoutDefaults(item, *row.table, sample.get());
      }
    }
    const YamlNode* usual = standard.find(row.option.key);
    const bool needless = !row.option.required && usual != nullptr && same(*value, *usual);
    if (!needless) kept.add(row.option.key, std::move(inner));
  }
  return kept;
}

std::string tableText(const YamlNode& table, const std::string& indent);

/// A list of tables: those that hold scalars only take one line each.
std::string listText(const YamlNode& list, const std::string& indent) {
  std::string text;
  for (const YamlNode& item : list.items) {
    if (isScalar(item) || std::all_of(item.items.begin(), item.items.end(), isScalar)) {
      text += indent + "- " + inlineText(item) + "\n";
      continue;
    }
    std::string inner = tableText(item, indent + "  ");
    inner[indent.size()] = '-';
    text += inner;
  }
  return text;
}

std::string tableText(const YamlNode& table, const std::string& indent) {
  std::string text;
  for (std::size_t i = 0; i < table.items.size(); ++i) {
    const YamlNode& item = table.items[i];
    const std::string start = indent + table.keys[i].name + ":";
    const bool flat = std::all_of(item.items.begin(), item.items.end(), isScalar);
    if (isScalar(item) || item.items.empty() || (flat && item.kind == YamlNode::Kind::Table)) {
      text += start + " " + inlineText(item) + "\n";
    } else if (item.kind == YamlNode::Kind::Table) {
      text += start + "\n" + tableText(item, indent + "  ");
    } else {
      text += start + "\n" + listText(item, indent + "  ");
    }
  }
  return text;
}

}  // namespace

std::string mapText(const MapFile& file) {
  const auto table = mapOptions();
  const MapFile defaults{};
  const YamlNode node = writeTable(*table.core(), &file, Comments::None);
  return tableText(withoutDefaults(node, *table.core(), &defaults), "");
}

}  // namespace pos::io
