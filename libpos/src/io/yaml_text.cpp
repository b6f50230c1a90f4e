#include <algorithm>
#include <string>

#include "pos/io/yaml_document.hpp"
#include "quoted.hpp"

namespace pos::io {
namespace {

/// Words that read back as the same text without quotes, also by programs that take No, ON or Null for
/// values.
bool isPlainWord(const std::string& text) {
  const std::string letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
  if (text.empty() || letters.find(text[0]) == std::string::npos) return false;
  if (text.find_first_not_of(letters + "0123456789-./") != std::string::npos) return false;
  std::string lowered = text;
  std::transform(lowered.begin(), lowered.end(), lowered.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  for (const char* word : {"null", "true", "false", "yes", "no", "on", "off", "y", "n"}) {
    if (lowered == word) return false;
  }
  return true;
}

std::string scalarText(const YamlNode& node) {
  if (node.kind == YamlNode::Kind::Null) return "null";
  return node.quoted && !isPlainWord(node.text) ? quoted(node.text) : node.text;
}

std::string keyText(const std::string& key) {
  return isPlainWord(key) ? key : quoted(key);
}

bool isInline(const YamlNode& node) {
  return node.items.empty() || node.kind == YamlNode::Kind::Scalar || node.kind == YamlNode::Kind::Null;
}

std::string commentLines(const std::string& comment, const std::string& indent) {
  std::string out;
  for (std::size_t begin = 0; begin < comment.size();) {
    const std::size_t end = std::min(comment.find('\n', begin), comment.size());
    out += indent + "# " + comment.substr(begin, end - begin) + "\n";
    begin = end + 1;
  }
  return out;
}

std::string block(const YamlNode& node, const std::string& indent);

std::string tableBlock(const YamlNode& node, const std::string& indent) {
  std::string out;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const YamlNode& item = node.items[i];
    out += commentLines(item.comment, indent);
    const std::string start = indent + keyText(node.keys[i].name) + ":";
    out += isInline(item) ? start + " " + inlineText(item) + "\n" : start + "\n" + block(item, indent + "  ");
  }
  return out;
}

std::string block(const YamlNode& node, const std::string& indent) {
  if (isInline(node)) return indent + inlineText(node) + "\n";
  if (node.kind == YamlNode::Kind::Table) return tableBlock(node, indent);
  std::string out;
  for (const YamlNode& item : node.items) {
    out += commentLines(item.comment, indent);
    std::string inner = block(item, indent + "  ");
    const std::size_t first = inner.find_first_not_of(' ');
    if (inner[first] == '#') {
      out += indent + "-\n" + inner;
    } else {
      inner[first - 2] = '-';
      out += inner;
    }
  }
  return out;
}

std::string json(const YamlNode& node, const std::string& indent) {
  if (node.kind == YamlNode::Kind::Null) return "null";
  if (node.kind == YamlNode::Kind::Scalar) return node.quoted ? quoted(node.text) : node.text;
  const bool table = node.kind == YamlNode::Kind::Table;
  if (node.items.empty()) return table ? "{}" : "[]";
  const std::string inner = indent + "  ";
  std::string out = table ? "{" : "[";
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    out += (i == 0 ? "\n" : ",\n") + inner;
    if (table) out += quoted(node.keys[i].name) + ": ";
    out += json(node.items[i], inner);
  }
  return out + "\n" + indent + (table ? "}" : "]");
}

}  // namespace

std::string inlineText(const YamlNode& node) {
  if (node.kind == YamlNode::Kind::Scalar || node.kind == YamlNode::Kind::Null) return scalarText(node);
  const bool table = node.kind == YamlNode::Kind::Table;
  std::string out = table ? "{" : "[";
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    if (i > 0) out += ", ";
    if (table) out += keyText(node.keys[i].name) + ": ";
    out += inlineText(node.items[i]);
  }
  return out + (table ? "}" : "]");
}

std::string yamlText(const YamlNode& node) {
  return commentLines(node.comment, "") + block(node, "");
}

std::string jsonText(const YamlNode& node) {
  return json(node, "") + "\n";
}

}  // namespace pos::io
