#pragma once
/// What writing and reading GeoJSON share. Internal to io.

#include <array>
#include <string_view>

#include "pos/io/map_geojson.hpp"
#include "pos/io/yaml_document.hpp"
#include "pos/map/network.hpp"

namespace pos::io::geojson {

/// A list of the map and the word for one of its objects.
struct ObjectKind {
  std::string_view list;
  std::string_view word;
};
inline constexpr std::array<ObjectKind, 11> kObjectKinds = {{{"roadways", "roadway"},
                                                             {"junctions", "junction"},
                                                             {"crossings", "crossing"},
                                                             {"bends", "bend"},
                                                             {"chambers", "chamber"},
                                                             {"anchors", "anchor"},
                                                             {"portals", "portal"},
                                                             {"lights", "light"},
                                                             {"stop_lines", "stop_line"},
                                                             {"zones", "zone"},
                                                             {"routes", "route"}}};
inline constexpr std::string_view kMapWord = "map";

/// Where objects with a chainage are drawn. Lines follow the centreline.
class Shapes {
 public:
  explicit Shapes(const map::TunnelMap& map);

  using Line = std::vector<Eigen::Vector3d>;
  /// One point for a Point, one line for a LineString, several for a MultiLineString; empty: no geometry.
  std::vector<Line> of(std::string_view list, std::size_t index) const;

 private:
  Eigen::Vector3d at(const map::RoadwayPlace& place) const;
  Eigen::Vector3d beside(const map::RoadwayPlace& place, map::Side side, double beyond_wall) const;
  Line along(const map::RoadwayStretch& stretch) const;

  map::Network network_;
  const map::TunnelMap& map_;
};

/// One feature on its way into the map's tree.
struct Feature {
  std::string name;                  ///< "features[3] (chamber C1)"
  const ObjectKind* kind = nullptr;  ///< null for the map itself
  const YamlNode* geometry = nullptr;
  YamlNode object;        ///< as the map file has it
  bool computed = false;  ///< its chainage has to come from its point
};

/// A ConfigError about a node of the file.
[[noreturn]] void refuse(const std::string& what, const YamlNode& node, const std::string& key,
                         const std::string& expected, const std::string& suggestion = {});
/// A member that has to be there.
const YamlNode& member(const YamlNode& table, const char* name, const std::string& key, const char* expected);
/// Refuses members that are not among `known`.
void requireMembers(const YamlNode& table, const std::string& key, const std::vector<std::string>& known);
/// Refuses an object of another type.
void requireType(const YamlNode& table, const std::string& key, const char* type);
/// Whether objects of this list have one point that may give their chainage.
bool isPointObject(std::string_view list);
/// The point of a feature, m.
Eigen::Vector3d pointOf(const Feature& feature);
/// `index` counts features from 0.
Feature featureOf(const YamlNode& node, std::size_t index);

}  // namespace pos::io::geojson
