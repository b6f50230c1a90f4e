// Maps as GeoJSON.
#include <memory>

#include "geojson_parts.hpp"
#include "json_document.hpp"
#include "pos/core/error.hpp"
#include "pos/io/text.hpp"
#include "pos/map/outline.hpp"

namespace pos::io {
namespace geojson {

Shapes::Shapes(const map::TunnelMap& map)
    : network_(std::make_shared<const map::TunnelMap>(map)), map_(network_.map()) {}

Eigen::Vector3d Shapes::at(const map::RoadwayPlace& place) const {
  return network_.toMap({network_.indexOf(place.roadway), place.chainage, 0.0, 0.0});
}

Eigen::Vector3d Shapes::beside(const map::RoadwayPlace& place, map::Side side, double beyond_wall) const {
  const map::RoadwayIndex i = network_.indexOf(place.roadway);
  const double offset = (0.5 * map_.roadways[i].width + beyond_wall) * (side == map::Side::Left ? 1.0 : -1.0);
  return network_.toMap({i, place.chainage, offset, 0.0});
}

Shapes::Line Shapes::along(const map::RoadwayStretch& stretch) const {
  const map::Centreline& line = network_.centreline(network_.indexOf(stretch.roadway));
  Line points;
  for (const double chainage : map::sampleChainages(line, stretch.from, stretch.to, 0.05))
    points.push_back(line.at(chainage).p_map);
  return points;
}

std::vector<Shapes::Line> Shapes::of(std::string_view list, std::size_t i) const {
  if (list == "junctions") {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const map::RoadwayPlace& place : map_.junctions[i].places) sum += at(place);
    return {{sum / static_cast<double>(map_.junctions[i].places.size())}};
  }
  if (list == "crossings") return {{at(map_.crossings[i].upper)}};
  if (list == "bends") return {along(map_.bends[i].stretch)};
  if (list == "chambers") {
    const map::Chamber& chamber = map_.chambers[i];
    return {{beside(chamber.place, chamber.side, 0.5 * chamber.depth)}};
  }
  if (list == "portals") return {{at(map_.portals[i].place)}};
  if (list == "lights") return {{beside(map_.lights[i].place, map_.lights[i].side, 0.0)}};
  if (list == "stop_lines") return {{at(map_.stop_lines[i].place)}};
  if (list == "zones") return {along(map_.zones[i].stretch)};
  if (list != "routes") return {};
  std::vector<Line> legs;
  for (const map::RoadwayStretch& leg : map_.routes[i].legs) legs.push_back(along(leg));
  return legs;
}

}  // namespace geojson

namespace {

using namespace geojson;

/// A coordinate that was written with the map's own digits.
YamlNode pick(const YamlNode& table, const char* key) {
  const YamlNode* value = table.find(key);
  ensure(value != nullptr, "a map object without coordinates");
  return *value;
}

YamlNode positionOf(const YamlNode& point) {
  YamlNode position = listNode();
  for (const char* key : {"x_m", "y_m", "z_m"}) position.items.push_back(pick(point, key));
  return position;
}

YamlNode positionOf(const Eigen::Vector3d& p) {
  YamlNode position = listNode();
  for (int axis = 0; axis < 3; ++axis) {
    std::string digits = text::fixed(p[axis], 3);
    while (digits.ends_with('0')) digits.pop_back();
    if (digits.ends_with('.')) digits.pop_back();
    position.items.push_back(plainNode(digits));
  }
  return position;
}

YamlNode geometryNode(const char* type, YamlNode coordinates) {
  YamlNode geometry = tableNode();
  geometry.add("type", textNode(type));
  geometry.add("coordinates", std::move(coordinates));
  return geometry;
}

YamlNode lineNode(const Shapes::Line& line) {
  YamlNode positions = listNode();
  for (const Eigen::Vector3d& p : line) positions.items.push_back(positionOf(p));
  return positions;
}

YamlNode geometryOf(const std::vector<Shapes::Line>& shape, bool several) {
  if (several) {
    YamlNode lines = listNode();
    for (const auto& line : shape) lines.items.push_back(lineNode(line));
    return geometryNode("MultiLineString", std::move(lines));
  }
  if (shape.front().size() > 1) return geometryNode("LineString", lineNode(shape.front()));
  return geometryNode("Point", positionOf(shape.front().front()));
}

/// A property for each point, where any point has it.
void addPointProperty(YamlNode& properties, const YamlNode& centreline, const char* key) {
  YamlNode values = listNode();
  bool any = false;
  for (const YamlNode& point : centreline.items) {
    const YamlNode* value = point.find(key);
    any = any || value != nullptr;
    values.items.push_back(value != nullptr ? *value : YamlNode{});
  }
  if (any) properties.add(key, std::move(values));
}

YamlNode featureNode(YamlNode geometry, YamlNode properties) {
  YamlNode feature = tableNode();
  feature.add("type", textNode("Feature"));
  feature.add("geometry", std::move(geometry));
  feature.add("properties", std::move(properties));
  return feature;
}

YamlNode objectFeature(const ObjectKind& kind, const YamlNode& object, const Shapes& shapes,
                       std::size_t index) {
  YamlNode properties = tableNode();
  properties.add("object", textNode(std::string(kind.word)));
  const bool roadway = kind.list == "roadways";
  const bool anchor = kind.list == "anchors";
  for (std::size_t i = 0; i < object.items.size(); ++i) {
    const std::string& key = object.keys[i].name;
    if (roadway && key == "centreline") continue;
    if (anchor && (key == "x_m" || key == "y_m" || key == "z_m")) continue;
    properties.add(key, object.items[i]);
  }
  if (anchor) return featureNode(geometryNode("Point", positionOf(object)), std::move(properties));
  if (!roadway)
    return featureNode(geometryOf(shapes.of(kind.list, index), kind.list == "routes"), std::move(properties));
  const YamlNode& centreline = *object.find("centreline");
  YamlNode positions = listNode();
  for (const YamlNode& point : centreline.items) positions.items.push_back(positionOf(point));
  addPointProperty(properties, centreline, "arc_deg");
  addPointProperty(properties, centreline, "station_m");
  return featureNode(geometryNode("LineString", std::move(positions)), std::move(properties));
}

bool isObjectList(const std::string& key) {
  for (const ObjectKind& kind : kObjectKinds) {
    if (key == kind.list) return true;
  }
  return false;
}

}  // namespace

std::string mapGeoJson(const MapFile& file) {
  const YamlNode root = parseYaml(mapText(file), "map").root;
  const Shapes shapes(file.map);
  YamlNode whole = tableNode();
  whole.add("object", textNode(std::string(kMapWord)));
  std::string features;
  for (std::size_t i = 0; i < root.items.size(); ++i) {
    if (!isObjectList(root.keys[i].name)) whole.add(root.keys[i].name, root.items[i]);
  }
  features += compactJson(featureNode(YamlNode{}, std::move(whole)));
  for (const ObjectKind& kind : kObjectKinds) {
    const YamlNode* list = root.find(kind.list);
    if (list == nullptr) continue;
    for (std::size_t i = 0; i < list->items.size(); ++i)
      features += ",\n" + compactJson(objectFeature(kind, list->items[i], shapes, i));
  }
  return "{\"type\": \"FeatureCollection\", \"features\": [\n" + features + "\n]}\n";
}

}  // namespace pos::io
