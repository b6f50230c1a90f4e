#include "pos/io/map_yaml.hpp"

#include <fstream>
#include <map>
#include <set>

#include "map_options.hpp"
#include "pos/io/files.hpp"

namespace pos::io {
namespace {

using pos::map::Anchor;
using pos::map::GeodeticOrigin;
using pos::map::MineGrid;
using pos::map::Side;
using pos::map::TunnelMap;
using pos::map::Wall;

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
              "From true east counter-clockwise to the map's x axis.")
      .number(
          "x_m", [](auto& origin) -> auto& { return origin.p_map.x(); }, anything(),
          "The map point with these coordinates: east.")
      .number(
          "y_m", [](auto& origin) -> auto& { return origin.p_map.y(); }, anything(), "The same: north.")
      .number(
          "z_m", [](auto& origin) -> auto& { return origin.p_map.z(); }, anything(), "The same: height.");
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
              "Subtracted from every range to this anchor.")
      .choice("wall", &Anchor::wall,
              {{"left", Wall::Left},
               {"right", Wall::Right},
               {"roof", Wall::Roof},
               {"floor", Wall::Floor},
               {"post", Wall::Post}},
              "What it is fixed to; left and right are seen along growing chainage.")
      .text("survey_date", &Anchor::survey_date, "Day of the survey, YYYY-MM-DD.")
      .number("antenna_delay_s", &Anchor::antenna_delay, between(0, 1e-3),
              "Transmit and receive delay together, as programmed into the radio.");
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
  for (std::size_t i = 0; i < file.map.anchors.size(); ++i) {
    const AnchorId id = file.map.anchors[i].id;
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

/// An id given twice is left to requireUniqueAnchors, which names the lines of both.
TunnelMap withoutRepeatedAnchors(TunnelMap map) {
  std::set<AnchorId> seen;
  std::erase_if(map.anchors, [&seen](const Anchor& anchor) { return !seen.insert(anchor.id).second; });
  return map;
}

/// Keys that came with schema 2 are refused in a file that says it is of schema 1.
void requireSchema(const MapFile& file, const YamlDocument& document) {
  if (file.schema == kMapSchema) return;
  for (const YamlKey& key : document.root.keys) {
    if (key.name == "schema" || key.name == "name" || key.name == "origin" || key.name == "anchors" ||
        key.name == "grid") {
      continue;
    }
    throw ConfigError(Complaint{.what = "this key came with a later schema than the file's",
                                .place = key.place,
                                .key = key.name,
                                .got = "schema: " + std::to_string(file.schema),
                                .suggestion = "write schema: " + std::to_string(kMapSchema)});
  }
}

MapFile checkedFile(const YamlDocument& document) {
  MapFile file = readOptions(document, mapOptions());
  requireSchema(file, document);
  requireUniqueAnchors(file, document);
  file.schema = kMapSchema;
  return file;
}

/// A path that starts at the folder `from`, from the folder `to`. Absolute ones and those of a package stay.
std::filesystem::path movedPath(const std::filesystem::path& path, const std::filesystem::path& from,
                                const std::filesystem::path& to) {
  const std::filesystem::path target = resolvedPath(path, from, "/");
  if (resolvedPath(path, to, "/") == target) return path;
  return target.lexically_relative(resolvedPath(".", to, "/"));
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

OptionTable<MineGrid> mineGridOptions() {
  return OptionTable<MineGrid>("mine_grid", "Where the map's origin sits in the mine's own grid.")
      .text("name", &MineGrid::name, "Name of the grid and its datum.")
      .number("easting_m", &MineGrid::easting, anything(), "Easting of the map's origin.")
      .required()
      .number("northing_m", &MineGrid::northing, anything(), "Northing of the map's origin.")
      .required()
      .number("elevation_m", &MineGrid::elevation, anything(), "Height of the map's origin.")
      .number("rotation_deg", &MineGrid::rotation, between(-180, 180),
              "From the grid's east counter-clockwise to the map's x axis.");
}

OptionTable<MapFile> mapOptions() {
  return OptionTable<MapFile>("Map", "Anchors and roadways of a mine, in metres, x east, y north, z up.")
      .integer("schema", &MapFile::schema, between(1, kMapSchema), "Version of this format.")
      .required()
      .text(
          "name", [](auto& file) -> auto& { return file.map.name; }, "Name of the map.")
      .required()
      .table(
          "mine_grid", [](auto& file) -> auto& { return file.map.mine_grid; }, mineGridOptions(),
          "Where the map's origin sits in the mine's own grid.")
      .table(
          "origin", [](auto& file) -> auto& { return file.map.origin; }, originOptions(),
          "Where the map frame sits on the Earth (WGS84).")
      .choice(
          "driving_side", [](auto& file) -> auto& { return file.map.driving_side; }, sideNames(),
          "Side of the road on roadways with two lanes.")
      .list(
          "roadways", [](auto& file) -> auto& { return file.map.roadways; }, roadwayOptions(),
          "The roadways.")
      .list(
          "junctions", [](auto& file) -> auto& { return file.map.junctions; }, junctionOptions(),
          "Where roadways meet.")
      .list(
          "crossings", [](auto& file) -> auto& { return file.map.crossings; }, crossingOptions(),
          "Where roadways pass above each other.")
      .list(
          "bends", [](auto& file) -> auto& { return file.map.bends; }, bendOptions(), "Bends.")
      .list(
          "chambers", [](auto& file) -> auto& { return file.map.chambers; }, chamberOptions(),
          "Refuge and passing chambers.")
      .list(
          "anchors", [](auto& file) -> auto& { return file.map.anchors; }, anchorOptions(),
          "The radio anchors.")
      .list(
          "portals", [](auto& file) -> auto& { return file.map.portals; }, portalOptions(),
          "Ways to the surface.")
      .list(
          "lights", [](auto& file) -> auto& { return file.map.lights; }, lightOptions(), "Signal lamps.")
      .list(
          "stop_lines", [](auto& file) -> auto& { return file.map.stop_lines; }, stopLineOptions(),
          "Lines to wait at.")
      .list(
          "zones", [](auto& file) -> auto& { return file.map.zones; }, zoneOptions(),
          "Stretches with a rule of their own.")
      .list(
          "routes", [](auto& file) -> auto& { return file.map.routes; }, routeOptions(), "Transport routes.")
      .table(
          "requirements", [](auto& file) -> auto& { return file.map.requirements; }, requirementOptions(),
          "What the site has to offer; the checks ask for it.")
      .table(
          "background", [](auto& file) -> auto& { return file.map.background; }, backgroundOptions(),
          "A scanned plan to draw under the map.")
      .table("grid", &MapFile::grid, gridOptions(), "Occupancy grid of the roadways.")
      .check([](const MapFile& file) { return validated(withoutRepeatedAnchors(file.map)); });
}

MapFile parsedMap(const std::string& text, const std::filesystem::path& file) {
  return checkedFile(parseYaml(text, file));
}

MapFile readMapFile(const std::filesystem::path& file) {
  return checkedFile(loadYaml(file));
}

std::string checkedMapText(const MapFile& file) {
  (void)validated(file.map);
  const std::string text = mapText(file);
  try {
    (void)parsedMap(text, "map");
  } catch (const ConfigError& error) {
    Complaint complaint = error.complaint();
    complaint.place = {};  // of the text, which nobody has seen
    throw ConfigError(complaint);
  }
  return text;
}

MapFile moved(MapFile file, const std::filesystem::path& from, const std::filesystem::path& to) {
  if (file.grid) file.grid->file = movedPath(file.grid->file, from, to);
  if (file.map.background)
    file.map.background->file = movedPath(file.map.background->file, from, to).string();
  return file;
}

pos::map::TunnelMap loadMap(const std::filesystem::path& file, const std::filesystem::path& mrpt_share,
                            const GridLoader& grid_loader) {
  const YamlDocument document = loadYaml(file);
  MapFile content = checkedFile(document);
  if (content.grid) content.map.grid = loadedGrid(*content.grid, document, mrpt_share, grid_loader);
  return validated(std::move(content.map));
}

std::string mapYaml(const pos::map::TunnelMap& map, const std::filesystem::path& grid_file) {
  if (map.grid.has_value() != !grid_file.empty()) {
    throw ConfigError(Complaint{.what = map.grid ? "the map has a grid, but no file is named for it"
                                                 : "a grid file is named for a map without grid",
                                .key = "grid.file",
                                .got = grid_file.string(),
                                .expected = map.grid ? "the path of the grid's file" : "no path"});
  }
  MapFile file{.map = map, .grid = {}};
  if (map.grid) file.grid = GridReference{grid_file, map.grid->T_map_grid};
  return mapText(file);
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
