#include "json_document.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "pos/io/units.hpp"
#include "quoted.hpp"

namespace pos::io {
namespace {

constexpr std::size_t kDeepest = 32;

/// Line and column after the characters read so far.
struct Reached {
  int line = 1;
  int column = 1;
};

/// An input iterator that counts lines.
class Counted {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  Counted(const char* at, std::array<Reached, 2>* reached) : at_(at), reached_(reached) {}
  reference operator*() const { return *at_; }
  Counted& operator++() {
    Reached& now = (*reached_)[0];
    (*reached_)[1] = now;
    if (*at_ == '\n') {
      ++now.line;
      now.column = 1;
    } else {
      ++now.column;
    }
    ++at_;
    return *this;
  }
  Counted operator++(int) {
    const Counted before = *this;
    ++*this;
    return before;
  }
  bool operator==(const Counted& other) const { return at_ == other.at_; }
  bool operator!=(const Counted& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  std::array<Reached, 2>* reached_;  // now, and one character before
};

/// nlohmann's events as a tree. Names of its members are nlohmann's.
class Builder {
 public:
  using Json = nlohmann::json;

  Builder(std::string file, const std::array<Reached, 2>& reached)
      : file_(std::move(file)), reached_(reached) {}

  bool null() { return put({.kind = YamlNode::Kind::Null, .place = placeBehind(4)}); }
  bool boolean(bool value) { return put(scalar(value ? "true" : "false", placeBehind(value ? 4 : 5))); }
  bool number_integer(Json::number_integer_t value) { return number(std::to_string(value)); }
  bool number_unsigned(Json::number_unsigned_t value) { return number(std::to_string(value)); }
  bool number_float(Json::number_float_t, const std::string& digits) { return number(digits); }
  bool string(std::string& value) {
    YamlNode node = scalar(value, placeBehind(value.size() + 2));
    node.quoted = true;
    return put(std::move(node));
  }
  bool binary(Json::binary_t&) { return false; }
  bool start_object(std::size_t) { return open(YamlNode::Kind::Table); }
  bool key(std::string& name) {
    const FilePlace place = placeBehind(name.size() + 2);
    for (const YamlKey& known : open_.back().keys) {
      if (known.name != name) continue;
      throw ConfigError(Complaint{.what = "the name '" + name + "' is given twice",
                                  .place = place,
                                  .key = name,
                                  .suggestion = "the first is at " + toString(known.place)});
    }
    open_.back().keys.push_back({name, place});
    return true;
  }
  bool end_object() { return close(); }
  bool start_array(std::size_t) { return open(YamlNode::Kind::List); }
  bool end_array() { return close(); }
  bool parse_error(std::size_t, const std::string& token, const nlohmann::detail::exception& error) {
    const std::string what = error.what();
    const std::size_t reason = what.rfind("; ");
    throw ConfigError(
        Complaint{.what = "this is no JSON",
                  .place = placeBehind(1),
                  .got = printable(token),
                  .expected = reason == std::string::npos ? "" : printable(what.substr(reason + 2))});
  }

  YamlNode take() { return std::move(root_); }

 private:
  static YamlNode scalar(const std::string& text, const FilePlace& place) {
    YamlNode node = plainNode(text);
    node.place = place;
    return node;
  }
  static std::string printable(const std::string& text) {
    std::string out;
    for (const char c : text.substr(0, 120)) out += c >= ' ' && c < 0x7f ? c : '?';
    return out;
  }
  /// nlohmann has read one character past a number, or one past its end of input.
  bool number(const std::string& digits) {
    FilePlace place{file_, reached_[1].line, reached_[1].column};
    place.column = std::max(1, place.column - static_cast<int>(digits.size()));
    return put(scalar(digits, place));
  }
  FilePlace placeBehind(std::size_t length) const {
    return {file_, reached_[0].line,
            std::max(1, reached_[0].column - static_cast<int>(std::min<std::size_t>(length, 1u << 20)))};
  }
  bool put(YamlNode node) {
    if (open_.empty()) {
      root_ = std::move(node);
    } else {
      open_.back().items.push_back(std::move(node));
    }
    return true;
  }
  bool open(YamlNode::Kind kind) {
    if (open_.size() >= kDeepest) {
      throw ConfigError(Complaint{.what = "the JSON is nested too deep",
                                  .place = placeBehind(1),
                                  .expected = "at most " + std::to_string(kDeepest) + " levels"});
    }
    YamlNode node;
    node.kind = kind;
    node.place = placeBehind(1);
    open_.push_back(std::move(node));
    return true;
  }
  bool close() {
    YamlNode node = std::move(open_.back());
    open_.pop_back();
    return put(std::move(node));
  }

  std::string file_;
  const std::array<Reached, 2>& reached_;
  std::vector<YamlNode> open_;
  YamlNode root_;
};

std::string scalarJson(const YamlNode& node) {
  if (node.kind == YamlNode::Kind::Null) return "null";
  if (node.quoted) return quoted(node.text);
  if (node.text == "-0") return "-0.0";  // JSON readers take -0 for the integer 0
  const bool bare = isNumber(node.text) || node.text == "true" || node.text == "false";
  return bare ? node.text : quoted(node.text);
}

}  // namespace

YamlDocument parseJson(const std::string& text, const std::filesystem::path& file) {
  std::array<Reached, 2> reached{};
  Builder builder(file.string(), reached);
  const char* begin = text.data();
  nlohmann::json::sax_parse(Counted(begin, &reached), Counted(begin + text.size(), &reached), &builder);
  return {file, builder.take()};
}

std::string compactJson(const YamlNode& node) {
  const bool table = node.kind == YamlNode::Kind::Table;
  if (!table && node.kind != YamlNode::Kind::List) return scalarJson(node);
  std::string out = table ? "{" : "[";
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    if (i > 0) out += ", ";
    if (table) out += quoted(node.keys[i].name) + ": ";
    out += compactJson(node.items[i]);
  }
  return out + (table ? "}" : "]");
}

}  // namespace pos::io
