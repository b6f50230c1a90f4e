// One feature of a GeoJSON file as an object of the map file's tree.
#include <algorithm>

#include "geojson_parts.hpp"
#include "pos/core/error.hpp"
#include "pos/io/text.hpp"
#include "pos/io/units.hpp"

namespace pos::io::geojson {

using Kind = YamlNode::Kind;

[[noreturn]] void refuse(const std::string& what, const YamlNode& node, const std::string& key,
                         const std::string& expected, const std::string& suggestion) {
  throw ConfigError(Complaint{.what = what,
                              .place = node.place,
                              .key = key,
                              .got = describe(node),
                              .expected = expected,
                              .suggestion = suggestion});
}

const YamlNode& member(const YamlNode& table, const char* name, const std::string& key,
                       const char* expected) {
  if (table.kind != Kind::Table) refuse("this is no JSON object", table, key, "{...}");
  const YamlNode* value = table.find(name);
  if (value == nullptr) refuse("a member is missing", table, joinedPath(key, name), expected);
  return *value;
}

void requireMembers(const YamlNode& table, const std::string& key, const std::vector<std::string>& known) {
  for (const YamlKey& each : table.keys) {
    if (std::find(known.begin(), known.end(), each.name) != known.end()) continue;
    throw ConfigError(Complaint{.what = "unknown member '" + each.name + "'",
                                .place = each.place,
                                .key = joinedPath(key, each.name),
                                .expected = "one of: " + text::joined(known),
                                .suggestion = text::didYouMean(each.name, known)});
  }
}

void requireType(const YamlNode& table, const std::string& key, const char* type) {
  const YamlNode& found = member(table, "type", key, type);
  if (found.kind != Kind::Scalar || found.text != type)
    refuse("this is no GeoJSON that can be read", found, joinedPath(key, "type"), type);
}

bool isPointObject(std::string_view list) {
  return list == "chambers" || list == "portals" || list == "lights" || list == "stop_lines";
}

namespace {

/// A position's coordinates as they are written, two or three.
const std::vector<YamlNode>& position(const YamlNode& node, const std::string& key) {
  if (node.kind != Kind::List || node.items.size() < 2 || node.items.size() > 3)
    refuse("this is no position", node, key, "[x, y, z] in metres");
  for (const YamlNode& number : node.items) {
    if (number.kind != Kind::Scalar || number.quoted || !isNumber(number.text))
      refuse("a coordinate is no number", number, key, "metres in the map frame");
  }
  return node.items;
}

/// Coordinates of a geometry of this type.
const YamlNode& coordinatesOf(const Feature& feature, const char* type) {
  const std::string key = feature.name + ".geometry";
  requireMembers(*feature.geometry, key, {"type", "coordinates", "bbox"});
  requireType(*feature.geometry, key, type);
  return member(*feature.geometry, "coordinates", key, "positions");
}

YamlNode pointTable(const YamlNode& coordinates, const std::string& key) {
  const auto& numbers = position(coordinates, key);
  if (numbers.size() != 3) refuse("a position without height", coordinates, key, "[x, y, z] in metres");
  YamlNode point = tableNode();
  point.place = coordinates.place;
  const char* names[] = {"x_m", "y_m", "z_m"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point.add(names[axis], numbers[axis]);
    point.keys.back().place = numbers[axis].place;
  }
  return point;
}

/// Moves a property that has one value for each point into the points.
void spread(YamlNode& object, YamlNode& centreline, const char* name, const std::string& feature) {
  for (std::size_t i = 0; i < object.keys.size(); ++i) {
    if (object.keys[i].name != name) continue;
    const YamlNode values = object.items[i];
    const FilePlace place = object.keys[i].place;
    object.keys.erase(object.keys.begin() + static_cast<std::ptrdiff_t>(i));
    object.items.erase(object.items.begin() + static_cast<std::ptrdiff_t>(i));
    if (values.kind != Kind::List || values.items.size() != centreline.items.size()) {
      refuse("this property needs a value for each point of the line", values, feature + "." + name,
             "a list of " + std::to_string(centreline.items.size()) + " numbers or nulls");
    }
    for (std::size_t k = 0; k < values.items.size(); ++k) {
      if (values.items[k].kind == Kind::Null) continue;
      centreline.items[k].add(name, values.items[k]);
      centreline.items[k].keys.back().place = place;
    }
    return;
  }
}

void addGeometry(Feature& feature) {
  const bool roadway = feature.kind->list == "roadways";
  const bool anchor = feature.kind->list == "anchors";
  if (!roadway && !anchor) return;
  if (feature.geometry->kind == Kind::Null) {
    refuse("a " + std::string(feature.kind->word) + " without geometry", *feature.geometry,
           feature.name + ".geometry", roadway ? "a LineString" : "a Point");
  }
  const std::string key = feature.name + ".geometry.coordinates";
  if (anchor) {
    const YamlNode point = pointTable(coordinatesOf(feature, "Point"), key);
    for (std::size_t i = 0; i < point.items.size(); ++i) {
      feature.object.add(point.keys[i].name, point.items[i]);
      feature.object.keys.back().place = point.keys[i].place;
    }
    return;
  }
  const YamlNode& coordinates = coordinatesOf(feature, "LineString");
  if (coordinates.kind != Kind::List)
    refuse("this is no list of positions", coordinates, key, "[[x, y, z], ...]");
  YamlNode centreline = listNode();
  centreline.place = coordinates.place;
  for (const YamlNode& each : coordinates.items) centreline.items.push_back(pointTable(each, key));
  spread(feature.object, centreline, "arc_deg", feature.name);
  spread(feature.object, centreline, "station_m", feature.name);
  feature.object.add("centreline", std::move(centreline));
  feature.object.keys.back().place = coordinates.place;
}

std::string wordsKnown() {
  std::string words(kMapWord);
  for (const ObjectKind& kind : kObjectKinds) words += ", " + std::string(kind.word);
  return words;
}

}  // namespace

Feature featureOf(const YamlNode& node, std::size_t index) {
  Feature feature;
  feature.name = "features[" + std::to_string(index) + "]";
  if (node.kind != Kind::Table)
    refuse("this is no feature", node, feature.name, "{\"type\": \"Feature\", ...}");
  requireMembers(node, feature.name, {"type", "id", "bbox", "geometry", "properties"});
  requireType(node, feature.name, "Feature");
  feature.geometry = &member(node, "geometry", feature.name, "a geometry or null");
  const YamlNode& properties = member(node, "properties", feature.name, "the object's properties");
  const std::string key = feature.name + ".properties";
  const YamlNode& word = member(properties, "object", key, "one of: an object's kind");
  const YamlNode* id = properties.find("id");
  const bool map = word.text == kMapWord;
  for (const ObjectKind& kind : kObjectKinds) {
    if (word.kind == Kind::Scalar && word.text == kind.word) feature.kind = &kind;
  }
  if (!map && feature.kind == nullptr)
    refuse("no object of a map is called so", word, key + ".object", "one of: " + wordsKnown());
  feature.name += " (" + word.text + (id != nullptr && !id->text.empty() ? " " + id->text : "") + ")";
  feature.object = tableNode();
  feature.object.place = properties.place;
  for (std::size_t i = 0; i < properties.items.size(); ++i) {
    const YamlKey& name = properties.keys[i];
    if (name.name == "object" || properties.items[i].kind == Kind::Null) continue;
    feature.object.add(name.name, properties.items[i]);
    feature.object.keys.back().place = name.place;
  }
  if (feature.kind != nullptr) addGeometry(feature);
  feature.computed = feature.kind != nullptr && isPointObject(feature.kind->list) &&
                     feature.object.find("chainage_m") == nullptr && feature.geometry->kind != Kind::Null;
  return feature;
}

Eigen::Vector3d pointOf(const Feature& feature) {
  const auto& numbers = position(coordinatesOf(feature, "Point"), feature.name + ".geometry.coordinates");
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  for (std::size_t axis = 0; axis < numbers.size(); ++axis)
    p[static_cast<Eigen::Index>(axis)] = siValue(numbers[axis].text, "");
  return p;
}

}  // namespace pos::io::geojson
