/// `pos map import`: maps from other programs' files.

#include <memory>
#include <nlohmann/json.hpp>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"
#include "pos/io/dxf_map.hpp"
#include "pos/io/map_geojson.hpp"
#include "pos/io/map_tables.hpp"
#include "starter_file.hpp"
#include "verb_map.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct ImportFiles {
  std::string in;
  std::string out;
  std::string name;
  std::string data;
  std::string units;
  std::string grid_name;
  std::vector<std::string> layers;
  std::vector<double> grid_origin;
  io::DxfImportRules dxf;
  std::vector<const CLI::Option*> for_dxf;
  std::vector<const CLI::Option*> for_tables;
  bool force = false;
  bool json = false;
};

/// What an import gave, whatever it came from.
struct Imported {
  io::MapFile file = {};
  std::vector<io::DxfCount> counts = {};
  std::vector<std::string> remarks = {};
};

/// A chosen unit of length in m.
double unitOf(const std::string& unit) {
  for (const auto& [name, metres] : std::initializer_list<std::pair<const char*, double>>{{"m", 1.0},
                                                                                          {"dm", 0.1},
                                                                                          {"cm", 0.01},
                                                                                          {"mm", 1e-3},
                                                                                          {"km", 1e3},
                                                                                          {"in", 0.0254},
                                                                                          {"ft", 0.3048}}) {
    if (unit == name) return metres;
  }
  throw ContractError("a unit that the command line does not take");
}

map::MineGrid mineGridOf(const ImportFiles& files) {
  map::MineGrid grid;
  const auto& origin = files.grid_origin;
  if (origin.size() < 2 || origin.size() > 4) {
    throw UsageError(Complaint{.what = "the origin needs an easting and a northing",
                               .key = "--grid-origin",
                               .expected = "E,N or E,N,H or E,N,H,ROTATION (m, m, m, deg)"});
  }
  grid.name = files.grid_name;
  grid.easting = origin[0];
  grid.northing = origin[1];
  if (origin.size() > 2) grid.elevation = origin[2];
  if (origin.size() > 3) grid.rotation = radians(origin[3]);
  return grid;
}

Imported fromDxf(const ImportFiles& files) {
  io::DxfImportRules rules = files.dxf;
  for (const std::string& layer : files.layers) rules.layers.push_back(io::dxfLayerRule(layer));
  if (!files.units.empty()) rules.metres_per_unit = unitOf(files.units);
  if (!files.grid_origin.empty()) rules.mine_grid = mineGridOf(files);
  io::DxfImport read = io::mapFromDxf(io::loadDxf(files.in), rules);
  return {{.map = std::move(read.map), .grid = {}}, std::move(read.counts), std::move(read.remarks)};
}

Imported fromTables(const ImportFiles& files) {
  const fs::path data = files.data.empty() ? fs::path(files.in).parent_path() : fs::path(files.data);
  io::TableMap read = io::mapFromTables(io::readTableMapping(files.in), data);
  Imported imported{{.map = std::move(read.map), .grid = {}}};
  if (read.stations > 0) imported.remarks.push_back(std::to_string(read.stations) + " stations read");
  return imported;
}

Imported imported(const ImportFiles& files) {
  const std::string ending = fs::path(files.in).extension().string();
  const bool dxf = ending == ".dxf" || ending == ".DXF";
  const bool tables = ending == ".yaml" || ending == ".yml";
  if (!dxf) refuseGiven(files.for_dxf, "an import of " + ending);
  if (!tables) refuseGiven(files.for_tables, "an import of " + ending);
  if (dxf) return fromDxf(files);
  if (tables) return fromTables(files);
  if (ending == ".geojson" || ending == ".json") {
    io::GeoJsonImport read = io::loadGeoJson(files.in);
    return {io::moved(std::move(read.file), folderOf(files.in), folderOf(files.out)), {}, read.remarks};
  }
  throw UsageError(Complaint{.what = "the ending does not tell what to read",
                             .key = "in",
                             .got = files.in,
                             .expected = "*.dxf, *.geojson, or the *.yaml that maps CSV tables"});
}

Json reportOf(const Imported& import) {
  const map::TunnelMap& map = import.file.map;
  Json json{{"name", map.name},
            {"roadways", map.roadways.size()},
            {"junctions", map.junctions.size()},
            {"chambers", map.chambers.size()},
            {"portals", map.portals.size()},
            {"anchors", map.anchors.size()}};
  json["counts"] = Json::array();
  for (const io::DxfCount& count : import.counts) {
    json["counts"].push_back({{"layer", count.layer},
                              {"type", count.type},
                              {"count", count.count},
                              {"used", count.used},
                              {count.used ? "as" : "reason", count.what}});
  }
  json["remarks"] = import.remarks;
  return json;
}

void sayImport(const Imported& import, const std::string& out, const Voice& voice) {
  for (const io::DxfCount& count : import.counts) {
    const std::string what = std::to_string(count.count) + " " + count.type + " on layer " + count.layer;
    voice.say((count.used ? "read:     " : "left out: ") + what + ": " + count.what);
  }
  for (const std::string& remark : import.remarks) voice.say("note:     " + remark);
  const map::TunnelMap& map = import.file.map;
  voice.say(out + ": " + std::to_string(map.roadways.size()) + " roadways, " +
            std::to_string(map.junctions.size()) + " junctions, " + std::to_string(map.chambers.size()) +
            " chambers, " + std::to_string(map.portals.size()) + " portals, " +
            std::to_string(map.anchors.size()) + " anchors");
}

void runImport(const ImportFiles& files, const Voice& voice) {
  StarterFile{files.out, files.force}.requireFree();
  Imported import = imported(files);
  std::string& name = import.file.map.name;
  if (!files.name.empty()) name = files.name;
  if (name.empty()) name = fs::path(files.in).stem().string();
  writeFile(files.out, io::checkedMapText(import.file));
  sayImport(import, files.out, voice);
  if (files.json) print(reportOf(import).dump(2) + "\n");
}

std::vector<const CLI::Option*> addDxfOptions(CLI::App& verb, ImportFiles& files) {
  io::DxfImportRules& rules = files.dxf;
  CLI::Option* origin =
      verb.add_option(
              "--grid-origin", files.grid_origin,
              "DXF: the drawing is in the mine's grid; E,N[,H[,ROTATION_DEG]] of the map's origin in it")
          ->delimiter(',')
          ->expected(2, 4);
  return {
      verb.add_option(
              "--layer", files.layers,
              "DXF: NAME=kind; kinds are roadway, anchor, chamber, refuge, portal, ignore; * stands for any "
              "letters")
          ->allow_extra_args(false),
      verb.add_option("--units", files.units, "DXF: unit of the drawing, where it does not say or is wrong")
          ->check(CLI::IsMember({"m", "dm", "cm", "mm", "km", "in", "ft"})),
      origin,
      verb.add_option("--grid-name", files.grid_name, "DXF: name of the mine's grid and datum")
          ->needs(origin),
      verb.add_option("--roadway-width-m", rules.roadway.width, "DXF: width of all roadways (default 4)")
          ->check(CLI::Range(0.5, 100.0)),
      verb.add_option("--roadway-height-m", rules.roadway.height, "DXF: height of all roadways (default 3)")
          ->check(CLI::Range(0.5, 100.0)),
      verb.add_option("--join-m", rules.join,
                      "DXF: loose lines whose ends are this near are one (default 0.01)")
          ->check(CLI::Range(0.0, 10.0)),
      verb.add_option("--junction-reach-m", rules.junction_reach,
                      "DXF: a roadway that ends this near another joins it (default 0.5)")
          ->check(CLI::Range(0.0, 100.0)),
      verb.add_option("--label-distance-m", rules.label_distance,
                      "DXF: a text this near is an object's name (default 5)")
          ->check(CLI::Range(0.0, 1000.0))};
}

}  // namespace

void addMapImport(CLI::App& parent, const Verbs& verbs) {
  CLI::App* verb = parent.add_subcommand("import", "A map from a DXF drawing, GeoJSON or CSV tables");
  auto files = std::make_shared<ImportFiles>();
  verb->add_option("in", files->in, "*.dxf, *.geojson, or the *.yaml that maps CSV tables")->required();
  verb->add_option("--out", files->out, "Map file to write")->required();
  verb->add_option("--name", files->name, "Name of the map (default: as in the source, or the file's)");
  files->for_tables = {
      verb->add_option("--data", files->data, "CSV: folder with the tables (default: the mapping's)")};
  files->for_dxf = addDxfOptions(*verb, *files);
  verb->add_flag("--force", files->force, "Replace the map file if it is there");
  verb->add_flag("--json", files->json, "Print what was read and left out as JSON");
  addVoice(*verb, *verbs.voice);
  verb->callback([files, verbs] { runImport(*files, *verbs.voice); });
}

}  // namespace pos::app
