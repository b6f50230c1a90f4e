#include "pos/io/overrides.hpp"

#include "pos/io/files.hpp"
#include "pos/io/option_core.hpp"

namespace pos::io {
namespace {

struct Override {
  FilePlace place = {};  ///< "--set key=value"
  std::string key = {};
  std::vector<PathStep> steps = {};
  YamlNode value = {};
};

void setPlace(YamlNode& node, const FilePlace& place) {
  node.place = place;
  for (YamlKey& key : node.keys) key.place = place;
  for (YamlNode& item : node.items) setPlace(item, place);
}

[[noreturn]] void refuse(const Override& change, const std::string& what, const std::string& got,
                         const std::string& expected, const std::string& suggestion) {
  throw ConfigError(Complaint{.what = what,
                              .place = change.place,
                              .key = change.key,
                              .got = got,
                              .expected = expected,
                              .suggestion = suggestion});
}

YamlNode parsedValue(const std::string& text, const FilePlace& place) {
  if (text.find_first_not_of(" \t") == std::string::npos) return {.place = place};
  try {
    YamlNode value = parseYaml(text, place.file).root;
    setPlace(value, place);
    return value;
  } catch (const ConfigError& error) {
    Complaint complaint = error.complaint();
    complaint.place = place;
    complaint.got = text;
    throw ConfigError(complaint);
  }
}

Override parsedOverride(const std::string& text) {
  Override change{.place = {.file = "--set " + text}};
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    refuse(change, "this sets nothing", text, "key=value, for example estimators[0].range_sigma_m=0.3", "");
  }
  change.key = text.substr(0, equals);
  const auto steps = pathSteps(change.key);
  if (!steps)
    refuse(change, "this is not a key", change.key, "names joined by dots, list items as name[0]", "");
  change.steps = *steps;
  change.value = parsedValue(text.substr(equals + 1), change.place);
  return change;
}

/// The item of a list whose `name` is the one wanted.
YamlNode& namedItem(YamlNode& list, const std::string& name, const Override& change) {
  std::vector<std::string> names;
  for (YamlNode& item : list.items) {
    const YamlNode* own = item.find("name");
    if (own == nullptr) continue;
    if (own->text == name) return item;
    names.push_back(own->text);
  }
  std::string all;
  for (const std::string& known : names) all += (all.empty() ? "one of: " : ", ") + known;
  const auto near = nearestName(name, names);
  refuse(change, "the list has no item of this name", name, all.empty() ? "an index, as in name[0]" : all,
         near ? "did you mean " + *near + "?" : "");
}

YamlNode& indexedItem(YamlNode& node, std::size_t index, const Override& change) {
  if (node.kind != YamlNode::Kind::List) refuse(change, "this is not a list", describe(node), "a list", "");
  if (index < node.items.size()) return node.items[index];
  refuse(change, "the list has no item of this index", std::to_string(index),
         node.items.empty() ? "no index; the list is empty" : "0 to " + std::to_string(node.items.size() - 1),
         "");
}

/// The value one step down; a key that a table does not have yet is added to it.
YamlNode& stepped(YamlNode& node, const PathStep& step, const Override& change) {
  if (step.index) return indexedItem(node, *step.index, change);
  if (node.kind == YamlNode::Kind::List) return namedItem(node, step.name, change);
  if (node.kind != YamlNode::Kind::Table) {
    refuse(change, "there is no table to set '" + step.name + "' in", describe(node), "a table", "");
  }
  if (YamlNode* value = node.find(step.name)) return *value;
  node.add(step.name, {.kind = YamlNode::Kind::Table, .place = change.place});
  return node.items.back();
}

void apply(YamlNode& root, const Override& change) {
  YamlNode* node = &root;
  for (const PathStep& step : change.steps) node = &stepped(*node, step, change);
  *node = change.value;
}

}  // namespace

YamlDocument applyOverrides(YamlDocument document, const std::vector<std::string>& overrides) {
  for (const std::string& text : overrides) apply(document.root, parsedOverride(text));
  return document;
}

}  // namespace pos::io
