#include "pos/io/map_yaml.hpp"

#include <fstream>
#include <map>

#include "pos/io/files.hpp"

namespace pos::io {
namespace {

using pos::map::Anchor;
using pos::map::GeodeticOrigin;

OptionTable<GeodeticOrigin> originOptions() {
  return OptionTable<GeodeticOrigin>("origin", "Where the map frame sits on the Earth (WGS84).")
      .number("latitude_deg", &GeodeticOrigin::latitude, between(-90, 90), "Latitude of the map's origin.")
      .required()
      .number("longitude_deg", &GeodeticOrigin::longitude, between(-180, 180),
              "Longitude of the map's origin.")
      .required()
      .number("altitude_m", &GeodeticOrigin::altitude, between(-15000, 10000), "Height above the ellipsoid.")
      .required()
      .number("grid_rotation_deg", &GeodeticOrigin::grid_rotation, between(-180, 180),
              "From true east counter-clockwise to the map's x axis.");
}

OptionTable<Anchor> anchorOptions() {
  return OptionTable<Anchor>("anchors", "A radio anchor at a surveyed place.")
      .integer("id", &Anchor::id, anything(), "The radio's own number of the anchor.")
      .required()
      .text("name", &Anchor::name, "Name on drawings and in messages.")
      .number(
          "x_m", [](auto& anchor) -> auto& { return anchor.p_map.x(); }, anything(), "East in the map.")
      .required()
      .number(
          "y_m", [](auto& anchor) -> auto& { return anchor.p_map.y(); }, anything(), "North in the map.")
      .required()
      .number(
          "z_m", [](auto& anchor) -> auto& { return anchor.p_map.z(); }, anything(), "Height in the map.")
      .required()
      .number("survey_sigma_m", &Anchor::survey_sigma, between(0, 1000),
              "How sure the survey is, standard deviation of each axis.")
      .number("range_bias_m", &Anchor::range_bias, between(-1000, 1000),
              "Subtracted from every range to this anchor.");
}

OptionTable<GridReference> gridOptions() {
  return OptionTable<GridReference>("grid", "Occupancy grid of the roadways, in a file of its own.")
      .path("file", &GridReference::file,
            "The grid; mrpt-common: stands for the share folder of that package.")
      .required()
      .number(
          "x_m", [](auto& grid) -> auto& { return grid.T_map_grid.x; }, anything(),
          "Place of the grid: east.")
      .number(
          "y_m", [](auto& grid) -> auto& { return grid.T_map_grid.y; }, anything(),
          "Place of the grid: north.")
      .number(
          "yaw_deg", [](auto& grid) -> auto& { return grid.T_map_grid.yaw; }, between(-360, 360),
          "The grid is turned by this, counter-clockwise.");
}

void requireUniqueAnchors(const MapFile& file, const YamlDocument& document) {
  std::map<AnchorId, FilePlace> seen;
  const YamlNode* list = document.root.find("anchors");
  for (std::size_t i = 0; i < file.anchors.size(); ++i) {
    const AnchorId id = file.anchors[i].id;
    const FilePlace place = list->items[i].find("id")->place;
    const auto [first, fresh] = seen.emplace(id, place);
    if (fresh) continue;
    throw ConfigError(Complaint{
        .what = "two anchors have the same id",
        .place = place,
        .key = "anchors[" + std::to_string(i) + "].id",
        .got = std::to_string(id),
        .expected = "every id once",
        .suggestion = "the first is at " + toString(first->second) + "; give one of the two its own id"});
  }
}

pos::map::OccupancyGrid loadedGrid(const GridReference& reference, const YamlDocument& document,
                                   const std::filesystem::path& mrpt_share, const GridLoader& grid_loader) {
  const auto path = resolvedPath(reference.file, document.file.parent_path(), mrpt_share);
  const FilePlace place = document.root.find("grid")->find("file")->place;
  pos::map::OccupancyGrid grid = grid_loader(existingFile(path, {.place = place, .key = "grid.file"}));
  grid.T_map_grid = reference.T_map_grid * grid.T_map_grid;
  return grid;
}

}  // namespace

OptionTable<MapFile> mapOptions() {
  return OptionTable<MapFile>("Map", "Anchors and roadways of a mine, in metres, x east, y north, z up.")
      .integer("schema", &MapFile::schema, between(1, 1), "Version of this format.")
      .required()
      .text("name", &MapFile::name, "Name of the map.")
      .required()
      .table("origin", &MapFile::origin, originOptions(), "Where the map frame sits on the Earth (WGS84).")
      .list("anchors", &MapFile::anchors, anchorOptions(), "The radio anchors.")
      .table("grid", &MapFile::grid, gridOptions(), "Occupancy grid of the roadways.");
}

pos::map::TunnelMap loadMap(const std::filesystem::path& file, const std::filesystem::path& mrpt_share,
                            const GridLoader& grid_loader) {
  const YamlDocument document = loadYaml(file);
  const MapFile content = readOptions(document, mapOptions());
  requireUniqueAnchors(content, document);
  pos::map::TunnelMap map{
      .name = content.name, .origin = content.origin, .anchors = content.anchors, .grid = {}};
  if (content.grid) map.grid = loadedGrid(*content.grid, document, mrpt_share, grid_loader);
  return validated(std::move(map));
}

std::string mapYaml(const pos::map::TunnelMap& map, const std::filesystem::path& grid_file) {
  if (map.grid.has_value() != !grid_file.empty()) {
    throw ConfigError(Complaint{.what = map.grid ? "the map has a grid, but no file is named for it"
                                                 : "a grid file is named for a map without grid",
                                .key = "grid.file",
                                .got = grid_file.string(),
                                .expected = map.grid ? "the path of the grid's file" : "no path"});
  }
  MapFile file{.name = map.name, .origin = map.origin, .anchors = map.anchors, .grid = {}};
  if (map.grid) file.grid = GridReference{grid_file, map.grid->T_map_grid};
  return optionsYaml(file, mapOptions());
}

void saveMap(const pos::map::TunnelMap& map, const std::filesystem::path& file,
             const std::filesystem::path& grid_file) {
  const std::string text = mapYaml(validated(map), grid_file);
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) {
    throw ConfigError(Complaint{.what = "the map cannot be written",
                                .got = file.string(),
                                .suggestion = "check the folder, its permissions and the free space"});
  }
}

}  // namespace pos::io
