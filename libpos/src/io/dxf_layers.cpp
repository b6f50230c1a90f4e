// Which layer of a drawing is what.
#include <algorithm>
#include <set>

#include "dxf_parts.hpp"
#include "pos/core/error.hpp"
#include "pos/io/files.hpp"
#include "pos/io/text.hpp"

namespace pos::io {
namespace {

struct KindWord {
  const char* word;
  DxfLayerKind kind;
};
constexpr KindWord kWords[] = {
    {"roadway", DxfLayerKind::Roadway},        {"anchor", DxfLayerKind::Anchor},
    {"chamber", DxfLayerKind::PassingChamber}, {"refuge", DxfLayerKind::RefugeChamber},
    {"portal", DxfLayerKind::Portal},          {"ignore", DxfLayerKind::Ignore}};

std::vector<std::string> words() {
  std::vector<std::string> all;
  for (const KindWord& each : kWords) all.emplace_back(each.word);
  return all;
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

std::string lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), lower);
  return text;
}

/// '*' stands for any letters. Linear in time: only the last '*' is ever tried again.
bool fits(const std::string& pattern, const std::string& name) {
  std::size_t p = 0, n = 0, star = std::string::npos, mark = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      mark = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++p;
      ++n;
    } else if (star != std::string::npos) {
      p = star + 1;
      n = ++mark;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

}  // namespace

DxfLayerKind dxfLayerKind(const std::string& word) {
  for (const KindWord& each : kWords) {
    if (word == each.word) return each.kind;
  }
  throw UsageError(Complaint{.what = "no layer can be this",
                             .key = "--layer",
                             .got = word,
                             .expected = "one of: " + text::joined(words()),
                             .suggestion = text::didYouMean(word, words())});
}

DxfLayerRule dxfLayerRule(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError(Complaint{.what = "a layer and what it is are written NAME=kind",
                               .key = "--layer",
                               .got = text,
                               .expected = "for example --layer DRIFTS=roadway --layer 'TEXT*=ignore'"});
  }
  return {text.substr(0, equals), dxfLayerKind(text.substr(equals + 1))};
}

std::vector<DxfLayerRule> ownDxfLayers() {
  using Kind = DxfLayerKind;
  return {{"ROADWAY", Kind::Roadway},      {"ANCHOR", Kind::Anchor}, {"CHAMBER", Kind::PassingChamber},
          {"REFUGE", Kind::RefugeChamber}, {"PORTAL", Kind::Portal}, {"WALL", Kind::Ignore},
          {"JUNCTION", Kind::Ignore},      {"LIGHT", Kind::Ignore},  {"STOPLINE", Kind::Ignore},
          {"ZONE", Kind::Ignore}};
}

namespace dxf {

LayerKinds::LayerKinds(const DxfDrawing& drawing, const std::vector<DxfLayerRule>& rules)
    : rules_(rules.empty() ? ownDxfLayers() : rules) {
  std::map<std::string, std::size_t> layers;
  for (const DxfEntity& entity : drawing.entities) ++layers[entity.layer];
  std::vector<std::string> names;
  std::string listed;
  bool any = false;
  for (const auto& [name, count] : layers) {
    names.push_back(name);
    if (names.size() <= 40)
      listed += (listed.empty() ? "" : ", ") + name + " (" + std::to_string(count) + ")";
    const auto kind = kindOf(name);
    any = any || (kind && *kind != DxfLayerKind::Ignore);
  }
  if (names.size() > 40) listed += ", ...";
  for (const DxfLayerRule& rule : rules) {
    const bool found = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return fits(lowered(rule.pattern), lowered(name));
    });
    if (found) continue;
    throw ConfigError(Complaint{.what = "the drawing has nothing on this layer",
                                .place = {.file = drawing.file},
                                .key = "--layer",
                                .got = rule.pattern,
                                .expected = "a layer with shapes: " + listed,
                                .suggestion = text::didYouMean(rule.pattern, names)});
  }
  if (any) return;
  throw ConfigError(Complaint{.what = "no layer of the drawing is said to hold roadways or anchors",
                              .place = {.file = drawing.file},
                              .got = listed.empty() ? "a drawing without shapes that can be read"
                                                    : "layers (and shapes on them): " + listed,
                              .suggestion =
                                  "say what they are: --layer NAME=roadway, anchor, chamber, refuge, "
                                  "portal or ignore"});
}

std::optional<DxfLayerKind> LayerKinds::kindOf(const std::string& layer) const {
  for (const DxfLayerRule& rule : rules_) {
    if (fits(lowered(rule.pattern), lowered(layer))) return rule.kind;
  }
  return std::nullopt;
}

}  // namespace dxf
}  // namespace pos::io
