#include "pos/io/map_diff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "pos/io/units.hpp"

namespace pos::io {
namespace {

using Kind = MapChange::Kind;

/// "chambers" -> "chamber", "stop_lines" -> "stop line".
std::string singular(std::string list) {
  std::replace(list.begin(), list.end(), '_', ' ');
  list.pop_back();
  return list;
}

std::string textOf(const YamlNode* node) {
  return node == nullptr ? "" : inlineText(*node);
}

std::string shown(const std::string& text) {
  if (text.empty()) return "nothing";
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

bool isList(const YamlNode* node) {
  return node != nullptr && node->kind == YamlNode::Kind::List;
}

/// Keys of both tables, those of the first in front.
std::vector<std::string> keysOf(const YamlNode& a, const YamlNode& b) {
  std::vector<std::string> keys;
  for (const YamlNode* table : {&a, &b}) {
    for (const YamlKey& key : table->keys) {
      if (std::find(keys.begin(), keys.end(), key.name) == keys.end()) keys.push_back(key.name);
    }
  }
  return keys;
}

double numberOf(const YamlNode& table, const char* key) {
  const YamlNode* value = table.find(key);
  return value == nullptr ? 0.0 : siValue(value->text, key);
}

/// "moved by 0.35 m (0.3, 0.18, 0)", in place of three changes of coordinates.
std::string movedWords(const YamlNode& before, const YamlNode& after) {
  const double dx = numberOf(after, "x_m") - numberOf(before, "x_m");
  const double dy = numberOf(after, "y_m") - numberOf(before, "y_m");
  const double dz = numberOf(after, "z_m") - numberOf(before, "z_m");
  std::array<char, 120> text{};
  std::snprintf(text.data(), text.size(), "moved by %.3f m (%+.3f, %+.3f, %+.3f)",
                std::sqrt(dx * dx + dy * dy + dz * dz), dx, dy, dz);
  return text.data();
}

std::string listWords(const std::string& key, const YamlNode* before, const YamlNode* after) {
  const std::size_t a = isList(before) ? before->items.size() : 0;
  const std::size_t b = isList(after) ? after->items.size() : 0;
  std::size_t first = 0;
  while (first < std::min(a, b) && inlineText(before->items[first]) == inlineText(after->items[first]))
    ++first;
  const std::string count = a == b ? std::to_string(a) + " entries as before"
                                   : std::to_string(a) + " -> " + std::to_string(b) + " entries";
  return key + ": " + count + ", different from number " + std::to_string(first + 1) + " on";
}

bool isCoordinate(const std::string& key) {
  return key == "x_m" || key == "y_m" || key == "z_m";
}

std::vector<MapChange> tableChanges(const std::string& object, const YamlNode& before,
                                    const YamlNode& after) {
  std::vector<MapChange> changes;
  bool moved = false;
  for (const std::string& key : keysOf(before, after)) {
    const YamlNode* a = before.find(key);
    const YamlNode* b = after.find(key);
    MapChange change{.object = object, .key = key, .before = textOf(a), .after = textOf(b)};
    if (change.before == change.after) continue;
    change.words = isList(a) || isList(b)
                       ? object + ": " + listWords(key, a, b)
                       : object + ": " + key + " " + shown(change.before) + " -> " + shown(change.after);
    if (isCoordinate(key)) {
      change.words = std::exchange(moved, true) ? "" : object + " " + movedWords(before, after);
    }
    changes.push_back(std::move(change));
  }
  return changes;
}

using ById = std::map<std::string, const YamlNode*>;

ById byId(const YamlNode* list) {
  ById objects;
  if (list == nullptr) return objects;
  for (const YamlNode& item : list->items) objects.emplace(textOf(item.find("id")), &item);
  return objects;
}

MapChange wholeObject(Kind kind, const std::string& object, const YamlNode& item) {
  const bool added = kind == Kind::Added;
  return {.kind = kind,
          .object = object,
          .before = added ? "" : inlineText(item),
          .after = added ? inlineText(item) : "",
          .words = object + (added ? " is new" : " is gone")};
}

std::vector<MapChange> objectChanges(const std::string& list, const YamlNode* before, const YamlNode* after) {
  std::vector<MapChange> changes;
  const auto nameOf = [&](const YamlNode& item) { return singular(list) + " " + textOf(item.find("id")); };
  const ById there_before = byId(before);
  const ById there_after = byId(after);
  for (const YamlNode& item : before != nullptr ? before->items : std::vector<YamlNode>{}) {
    const auto other = there_after.find(textOf(item.find("id")));
    if (other == there_after.end()) {
      changes.push_back(wholeObject(Kind::Removed, nameOf(item), item));
      continue;
    }
    const std::vector<MapChange> inner = tableChanges(nameOf(item), item, *other->second);
    changes.insert(changes.end(), inner.begin(), inner.end());
  }
  for (const YamlNode& item : after != nullptr ? after->items : std::vector<YamlNode>{}) {
    if (!there_before.contains(textOf(item.find("id"))))
      changes.push_back(wholeObject(Kind::Added, nameOf(item), item));
  }
  return changes;
}

bool holdsObjects(const YamlNode* list) {
  return isList(list) && !list->items.empty() && list->items[0].find("id") != nullptr;
}

}  // namespace

std::vector<MapChange> mapChanges(const MapFile& before, const MapFile& after) {
  const YamlNode a = parseYaml(mapText(before), "before").root;
  const YamlNode b = parseYaml(mapText(after), "after").root;
  std::vector<MapChange> changes;
  for (const std::string& key : keysOf(a, b)) {
    const YamlNode* x = a.find(key);
    const YamlNode* y = b.find(key);
    std::vector<MapChange> inner;
    if (holdsObjects(x) || holdsObjects(y)) {
      inner = objectChanges(key, x, y);
    } else if (x != nullptr && y != nullptr && x->kind == YamlNode::Kind::Table) {
      inner = tableChanges(key, *x, *y);
    } else if (textOf(x) != textOf(y)) {
      inner = {{.kind = x == nullptr   ? Kind::Added
                        : y == nullptr ? Kind::Removed
                                       : Kind::Changed,
                .object = "map",
                .key = key,
                .before = textOf(x),
                .after = textOf(y),
                .words = "map: " + key + " " + shown(textOf(x)) + " -> " + shown(textOf(y))}};
    }
    changes.insert(changes.end(), inner.begin(), inner.end());
  }
  return changes;
}

}  // namespace pos::io
