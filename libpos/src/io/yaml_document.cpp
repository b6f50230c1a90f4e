#include "pos/io/yaml_document.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <utility>

#include "pos/io/files.hpp"

namespace pos::io {
namespace {

/// Deeper nesting than any file of ours has; keeps recursion over the tree shallow.
constexpr std::size_t kMaxDepth = 40;

FilePlace placeOf(const YAML::Mark& mark, const std::string& file) {
  if (mark.is_null()) return {.file = file};
  return {.file = file, .line = mark.line + 1, .column = mark.column + 1};
}

/// Builds the tree from the parser's events.
class TreeBuilder final : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::string file) : file_(std::move(file)) {}
  YamlNode root() && { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { attach(nodeAt(mark, YamlNode::Kind::Null)); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    refuse(mark, "YAML aliases (*name) are not read here", "write the value out");
  }
  void OnAnchor(const YAML::Mark& mark, const std::string& name) override {
    refuse(mark, "YAML anchors (&" + name + ") are not read here",
           "write the value out, or put it in quotes");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& value) override {
    refuseTag(mark, tag);
    YamlNode node = nodeAt(mark, YamlNode::Kind::Scalar);
    node.text = value;
    node.quoted = tag == "!";
    attach(std::move(node));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, YamlNode::Kind::List);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, YamlNode::Kind::Table);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    YamlNode node;
    std::optional<YamlKey> key = std::nullopt;  ///< Table: read, its value still to come
  };

  YamlNode nodeAt(const YAML::Mark& mark, YamlNode::Kind kind) const {
    return {.kind = kind, .place = placeOf(mark, file_)};
  }

  bool expectsKey() const {
    return !open_.empty() && open_.back().node.kind == YamlNode::Kind::Table && !open_.back().key;
  }

  void open(const YAML::Mark& mark, const std::string& tag, YamlNode::Kind kind) {
    refuseTag(mark, tag);
    if (expectsKey()) refuse(mark, "a key has to be a single word, not a list or a table", "");
    if (open_.size() >= kMaxDepth) refuse(mark, "lists and tables are nested too deep", "");
    open_.push_back({nodeAt(mark, kind)});
  }

  void close() {
    YamlNode node = std::move(open_.back().node);
    open_.pop_back();
    attach(std::move(node));
  }

  void attach(YamlNode node) {
    if (open_.empty()) {
      root_ = std::move(node);
    } else if (expectsKey()) {
      takeKey(std::move(node));
    } else {
      Open& parent = open_.back();
      if (parent.key) parent.node.keys.push_back(*std::exchange(parent.key, std::nullopt));
      parent.node.items.push_back(std::move(node));
    }
  }

  void takeKey(YamlNode node) {
    if (node.kind != YamlNode::Kind::Scalar || node.text.empty()) {
      throw ConfigError(Complaint{.what = "a key is missing before the colon", .place = node.place});
    }
    YamlNode& table = open_.back().node;
    if (table.find(node.text) != nullptr) {
      const int first = table.placeOfKey(node.text).line;
      open_.back().key = YamlKey{node.text, node.place};
      throw ConfigError(Complaint{
          .what = "the key '" + node.text + "' is given twice",
          .place = node.place,
          .key = path(),
          .expected = "every key once",
          .suggestion = "it stands in line " + std::to_string(first) + " already; keep one of the two"});
    }
    open_.back().key = YamlKey{node.text, node.place};
  }

  /// Key path of what is being read.
  std::string path() const {
    std::string text;
    for (const Open& open : open_) {
      if (open.node.kind == YamlNode::Kind::List) {
        text += "[" + std::to_string(open.node.items.size()) + "]";
      } else if (open.key) {
        text += (text.empty() ? "" : ".") + open.key->name;
      }
    }
    return text;
  }

  void refuseTag(const YAML::Mark& mark, const std::string& tag) const {
    if (tag != "?" && tag != "!" && !tag.empty()) {
      refuse(mark, "YAML tags (!name) are not read here", "remove the tag, or put the text in quotes");
    }
  }

  [[noreturn]] void refuse(const YAML::Mark& mark, const std::string& what,
                           const std::string& suggestion) const {
    throw ConfigError(
        Complaint{.what = what, .place = placeOf(mark, file_), .key = path(), .suggestion = suggestion});
  }

  std::string file_;
  YamlNode root_;
  std::vector<Open> open_;
};

/// Length of the UTF-8 character that starts at `i`, 0 when there is none.
std::size_t utf8Length(const std::string& text, std::size_t i) {
  const auto byte = [&text](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const auto leads = [lead = byte(i)](unsigned low, unsigned high) { return lead >= low && lead < high; };
  const std::size_t length = leads(0, 0x80)      ? 1
                             : leads(0xc2, 0xe0) ? 2
                             : leads(0xe0, 0xf0) ? 3
                             : leads(0xf0, 0xf5) ? 4
                                                 : 0;
  if (length == 0 || i + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(i + k) & 0xc0) != 0x80) return 0;
  }
  return length;
}

bool isControl(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7f;
}

/// yaml-cpp takes byte 4 for the end of the file and passes damaged characters on; neither may slip through.
void refuseDamagedText(const std::string& text, const std::string& file) {
  FilePlace place{.file = file, .line = 1, .column = 1};
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8Length(text, i);
    if (length == 0 || isControl(text[i])) {
      throw ConfigError(Complaint{.what = "there is a character here that is no text",
                                  .place = place,
                                  .got = "byte " + std::to_string(static_cast<unsigned char>(text[i])),
                                  .expected = "plain text in UTF-8"});
    }
    place.column = text[i] == '\n' ? 1 : place.column + 1;
    place.line += text[i] == '\n' ? 1 : 0;
    i += length;
  }
}

}  // namespace

const YamlNode* YamlNode::find(std::string_view name) const {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i].name == name) return &items[i];
  }
  return nullptr;
}

YamlNode* YamlNode::find(std::string_view name) {
  return const_cast<YamlNode*>(std::as_const(*this).find(name));
}

const FilePlace& YamlNode::placeOfKey(std::string_view name) const {
  const auto key = std::find_if(keys.begin(), keys.end(), [&](const YamlKey& k) { return k.name == name; });
  return key == keys.end() ? place : key->place;
}

void YamlNode::add(std::string name, YamlNode value) {
  keys.push_back({std::move(name), value.place});
  items.push_back(std::move(value));
}

YamlNode textNode(std::string text) {
  return {.kind = YamlNode::Kind::Scalar, .text = std::move(text), .quoted = true};
}
YamlNode plainNode(std::string text) {
  return {.kind = YamlNode::Kind::Scalar, .text = std::move(text)};
}
YamlNode tableNode() {
  return {.kind = YamlNode::Kind::Table};
}
YamlNode listNode() {
  return {.kind = YamlNode::Kind::List};
}

YamlDocument parseYaml(const std::string& text, const std::filesystem::path& file) {
  const std::string name = file.string();
  refuseDamagedText(text, name);
  std::istringstream stream(text);
  TreeBuilder first(name);
  TreeBuilder second(name);
  try {
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(first)) {
      throw ConfigError(Complaint{.what = "the file is empty", .place = {.file = name}});
    }
    if (parser.HandleNextDocument(second)) {
      const FilePlace place = std::move(second).root().place;
      throw ConfigError(Complaint{.what = "a second YAML document (---) begins in the same file",
                                  .place = place,
                                  .expected = "one document a file"});
    }
  } catch (const YAML::Exception& error) {
    throw ConfigError(
        Complaint{.what = "this is not YAML: " + error.msg,
                  .place = placeOf(error.mark, name),
                  .suggestion = "look at this line and the one above: indentation, colons, quotes"});
  }
  return {file, std::move(first).root()};
}

YamlDocument loadYaml(const std::filesystem::path& file) {
  return parseYaml(fileText(file), file);
}

}  // namespace pos::io
