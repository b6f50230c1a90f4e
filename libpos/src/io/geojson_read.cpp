// Maps from GeoJSON.
#include <algorithm>
#include <cmath>
#include <map>

#include "geojson_parts.hpp"
#include "json_document.hpp"
#include "pos/core/error.hpp"
#include "pos/io/files.hpp"
#include "pos/io/text.hpp"
#include "pos/io/units.hpp"

namespace pos::io {
namespace {

using namespace geojson;
using Kind = YamlNode::Kind;

constexpr double kMoved = 0.01;  // m between a point and the place of its chainage

class Reader {
 public:
  explicit Reader(const YamlDocument& document) : document_(document) {
    const YamlNode& root = document.root;
    requireMembers(root.kind == Kind::Table ? root : YamlNode{}, "",
                   {"type", "name", "crs", "bbox", "features"});
    requireType(root, "", "FeatureCollection");
    const YamlNode& list = member(root, "features", "", "the features");
    if (list.kind != Kind::List) refuse("this is no list", list, "features", "[...]");
    for (const YamlNode& node : list.items) features_.push_back(featureOf(node, features_.size()));
    if (root.find("crs") != nullptr && root.find("crs")->kind != Kind::Null) {
      result_.remarks.emplace_back(
          "the file names a coordinate system; its coordinates are taken as metres in the map frame");
    }
  }

  GeoJsonImport run() {
    if (std::any_of(features_.begin(), features_.end(), [](const Feature& f) { return f.computed; })) {
      result_.file = mapOf(tree(Points::LeftOut));
      computeChainages();
    }
    result_.file = mapOf(tree(Points::In));
    lookForMoved();
    return std::move(result_);
  }

 private:
  /// Whether the objects at a point are in; some may wait for their chainage.
  enum class Points { In, LeftOut };

  /// The map file's tree.
  YamlNode tree(Points points) {
    YamlNode root = tableNode();
    root.place = document_.root.place;
    const Feature* map = nullptr;
    for (const Feature& feature : features_) {
      if (feature.kind != nullptr) continue;
      if (map != nullptr)
        refuse("there are two features for the map as a whole", feature.object, feature.name, "one");
      map = &feature;
    }
    if (map == nullptr) {
      throw ConfigError(
          Complaint{.what = "the feature of the map as a whole is missing",
                    .place = {.file = document_.file.string()},
                    .expected = "a feature without geometry and with the properties \"object\": "
                                "\"map\", \"schema\": " +
                                std::to_string(kMapSchema) + ", \"name\": ..."});
    }
    for (std::size_t i = 0; i < map->object.items.size(); ++i) {
      root.add(map->object.keys[i].name, map->object.items[i]);
      root.keys.back().place = map->object.keys[i].place;
    }
    owners_.clear();
    for (const ObjectKind& kind : kObjectKinds) {
      if (points == Points::In || !isPointObject(kind.list)) addList(root, kind);
    }
    return root;
  }

  void addList(YamlNode& root, const ObjectKind& kind) {
    YamlNode list = listNode();
    for (const Feature& feature : features_) {
      if (feature.kind != &kind) continue;
      owners_[std::string(kind.list) + "[" + std::to_string(list.items.size()) + "]"] = &feature;
      list.items.push_back(feature.object);
    }
    if (list.items.empty()) return;
    if (root.find(kind.list) != nullptr) {
      throw ConfigError(Complaint{.what = "objects have features of their own",
                                  .place = root.placeOfKey(kind.list),
                                  .key = std::string(kind.list)});
    }
    root.add(std::string(kind.list), std::move(list));
    root.keys.back().place = root.place;
  }

  MapFile mapOf(YamlNode root) const {
    try {
      MapFile file = readOptions(YamlDocument{document_.file, std::move(root)}, mapOptions());
      file.map = map::validated(std::move(file.map));
      file.schema = kMapSchema;
      return file;
    } catch (const ConfigError& error) {
      throw ConfigError(named(error.complaint()));
    }
  }

  /// "chambers[0].side" as "features[7] (chamber C1).side".
  Complaint named(Complaint complaint) const {
    const std::size_t end = complaint.key.find(']');
    const auto owner = owners_.find(complaint.key.substr(0, end == std::string::npos ? 0 : end + 1));
    if (owner != owners_.end()) {
      complaint.key = owner->second->name + complaint.key.substr(end + 1);
      if (complaint.place.line == 0) complaint.place = owner->second->object.place;
    }
    return complaint;
  }

  void computeChainages() {
    for (Feature& feature : features_) {
      if (!feature.computed) continue;
      const Eigen::Vector3d p = pointOf(feature);
      const YamlNode* roadway = feature.object.find("roadway");
      const map::Roadway* on = roadway == nullptr ? nullptr : result_.file.map.findRoadway(roadway->text);
      if (on == nullptr) {
        refuse("a point without chainage_m needs the id of its roadway", feature.object,
               feature.name + ".roadway", "a roadway's id");
      }
      const double chainage = map::Centreline(*on).foot(p).chainage;
      const std::string digits = text::fixed(chainage, 3);
      feature.object.add("chainage_m", plainNode(digits));
      feature.object.keys.back().place = feature.geometry->place;
      result_.remarks.push_back(feature.name + ": chainage_m " + digits + " from its point");
    }
  }

  void lookForMoved() {
    const Shapes shapes(result_.file.map);
    std::map<std::string_view, std::size_t> counts;
    for (const Feature& feature : features_) {
      if (feature.kind == nullptr) continue;
      const std::size_t index = counts[feature.kind->list]++;
      if (!isPointObject(feature.kind->list) || feature.computed || feature.geometry->kind == Kind::Null)
        continue;
      const Eigen::Vector3d p = pointOf(feature);
      const Eigen::Vector3d place = shapes.of(feature.kind->list, index).front().front();
      const double distance = (p - place).head<2>().norm();
      if (distance <= kMoved) continue;
      result_.remarks.push_back(
          feature.name + ": its point is " + text::fixed(distance, 2) +
          " m from the place of its chainage, which counts; take chainage_m out to use the point");
    }
  }

  const YamlDocument& document_;
  std::vector<Feature> features_;
  std::map<std::string, const Feature*> owners_;
  GeoJsonImport result_;
};

}  // namespace

GeoJsonImport parsedGeoJson(const std::string& text, const std::filesystem::path& file) {
  const YamlDocument document = parseJson(text, file);
  return Reader(document).run();
}

GeoJsonImport loadGeoJson(const std::filesystem::path& file) {
  return parsedGeoJson(fileText(existingFile(file)), file);
}

}  // namespace pos::io
