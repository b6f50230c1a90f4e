/// `pos map`: make, check and describe maps.

#include "verb_map.hpp"

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "pos/core/error.hpp"
#include "pos/io/grid_io.hpp"
#include "pos/io/map_diff.hpp"
#include "pos/io/text.hpp"
#include "pos/map/routes.hpp"
#include "starter_file.hpp"

namespace pos::app {
namespace {

using Json = nlohmann::ordered_json;
using io::text::fixed;

/// A small map to start from: a portal, a junction, a chamber, a light and an anchor.
map::TunnelMap starterMap() {
  map::TunnelMap map{.name = "my_mine"};
  map.mine_grid = map::MineGrid{.name = "grid and datum of the mine", .easting = 500000, .northing = 4000000};
  map::Roadway main;
  main.id = "main";
  main.width = 5.0;
  main.height = 3.5;
  main.lanes = 2;
  main.centreline = {{.p_map = {0, 0, 0}}, {.p_map = {200, 0, -5}}};
  map::Roadway gate;
  gate.id = "gate";
  gate.width = 4.0;
  gate.height = 3.0;
  gate.centreline = {{.p_map = {100, 0, -2.5}}, {.p_map = {100, 80, -2.5}}};
  map.roadways = {main, gate};
  const double middle = 0.5 * std::hypot(200.0, 5.0);
  map.junctions = {{.id = "J1", .places = {{"main", middle}, {"gate", 0.0}}}};
  map.chambers = {
      {.id = "C1", .place = {"gate", 40.0}, .side = map::Side::Left, .length = 8.0, .depth = 3.0}};
  map.portals = {{.id = "P1", .place = {"main", 0.0}, .handover_from = 0.0, .handover_to = 30.0}};
  map.lights = {{.id = "L1", .place = {"gate", 5.0}, .controls = map::Direction::Forward}};
  map.anchors = {
      {.id = 1, .name = "A1", .p_map = {50, 2.5, 1.0}, .survey_sigma = 0.02, .wall = map::Wall::Left}};
  return map;
}

Json infoOf(const map::TunnelMap& tunnel_map) {
  const map::Network network(std::make_shared<const map::TunnelMap>(tunnel_map));
  const map::RoadGraph graph(network);
  Json json;
  json["name"] = tunnel_map.name;
  double total = 0.0;
  json["roadways"] = Json::array();
  for (map::RoadwayIndex r = 0; r < tunnel_map.roadways.size(); ++r) {
    const map::Roadway& roadway = tunnel_map.roadways[r];
    const map::Centreline& line = network.centreline(r);
    total += line.length();
    json["roadways"].push_back({{"id", roadway.id},
                                {"length_m", line.length()},
                                {"width_m", roadway.width},
                                {"height_m", roadway.height},
                                {"lanes", roadway.lanes},
                                {"points", roadway.centreline.size()}});
  }
  json["length_m"] = total;
  json["nodes"] = graph.nodes().size();
  json["edges"] = graph.edges().size();
  json["junctions"] = tunnel_map.junctions.size();
  json["crossings"] = tunnel_map.crossings.size();
  json["bends"] = tunnel_map.bends.size();
  json["chambers"] = tunnel_map.chambers.size();
  json["anchors"] = tunnel_map.anchors.size();
  json["portals"] = tunnel_map.portals.size();
  json["lights"] = tunnel_map.lights.size();
  json["stop_lines"] = tunnel_map.stop_lines.size();
  json["zones"] = tunnel_map.zones.size();
  json["routes"] = Json::array();
  for (const map::Route& route : tunnel_map.routes)
    json["routes"].push_back({{"id", route.id}, {"length_m", map::RouteLine(network, route).length()}});
  return json;
}

std::string infoText(const Json& info) {
  std::string text =
      info["name"].get<std::string>() + ": " + fixed(info["length_m"].get<double>(), 1) + " m of roadways\n";
  for (const Json& r : info["roadways"]) {
    text += "  roadway " + r["id"].get<std::string>() + ": " + fixed(r["length_m"].get<double>(), 1) +
            " m, " + fixed(r["width_m"].get<double>(), 2) + " x " + fixed(r["height_m"].get<double>(), 2) +
            " m, lanes " + std::to_string(r["lanes"].get<int>()) + "\n";
  }
  for (const Json& r : info["routes"]) {
    text += "  route " + r["id"].get<std::string>() + ": " + fixed(r["length_m"].get<double>(), 1) + " m\n";
  }
  for (const char* key : {"nodes", "edges", "junctions", "crossings", "bends", "chambers", "anchors",
                          "portals", "lights", "stop_lines", "zones"}) {
    text += "  " + std::string(key) + ": " + std::to_string(info[key].get<std::size_t>()) + "\n";
  }
  return text;
}

const char* nameOf(io::MapChange::Kind kind) {
  return kind == io::MapChange::Kind::Added     ? "added"
         : kind == io::MapChange::Kind::Removed ? "removed"
                                                : "changed";
}

Json toJson(const std::vector<io::MapChange>& changes) {
  Json json = Json::array();
  for (const io::MapChange& change : changes) {
    json.push_back({{"change", nameOf(change.kind)},
                    {"object", change.object},
                    {"key", change.key},
                    {"before", change.before},
                    {"after", change.after}});
  }
  return json;
}

std::string inWords(const std::vector<io::MapChange>& changes) {
  std::string text;
  for (const io::MapChange& change : changes) {
    if (!change.words.empty()) text += change.words + "\n";
  }
  return text.empty() ? "no difference\n" : text;
}

}  // namespace

map::TunnelMap mapOf(const std::string& file) {
  return io::loadMap(file, mrptShare(),
                     [](const std::filesystem::path& grid) { return io::loadGrid(grid.string()); });
}

void refuseGiven(const std::vector<const CLI::Option*>& options, const std::string& what) {
  for (const CLI::Option* option : options) {
    if (option->count() == 0) continue;
    throw UsageError(Complaint{.what = what + " has no use for this option",
                               .key = option->get_name(),
                               .suggestion = "leave it out"});
  }
}

void addMapInit(CLI::App& parent, const Verbs&) {
  CLI::App* verb = parent.add_subcommand("init", "Write a small map with every key explained");
  auto file = std::make_shared<StarterFile>();
  addStarterFile(*verb, *file);
  verb->callback([file] {
    file->write(io::exampleYaml(io::MapFile{.map = starterMap(), .grid = {}}, io::mapOptions()));
  });
}

void addMapInfo(CLI::App& parent, const Verbs& verbs) {
  CLI::App* verb = parent.add_subcommand("info", "Say what is in a map");
  auto file = std::make_shared<std::string>();
  auto as_json = std::make_shared<bool>(false);
  verb->add_option("map", *file, "Map file")->required();
  verb->add_flag("--json", *as_json, "Print JSON");
  addVoice(*verb, *verbs.voice);
  verb->callback([file, as_json] {
    const Json info = infoOf(mapOf(*file));
    print(*as_json ? info.dump(2) + "\n" : infoText(info));
  });
}

void addMapDiff(CLI::App& parent, const Verbs& verbs) {
  CLI::App* verb = parent.add_subcommand("diff", "Say what changed from one map to another");
  auto before = std::make_shared<std::string>();
  auto after = std::make_shared<std::string>();
  auto as_json = std::make_shared<bool>(false);
  verb->add_option("before", *before, "Earlier map")->required();
  verb->add_option("after", *after, "Later map")->required();
  verb->add_flag("--json", *as_json, "Print JSON");
  addVoice(*verb, *verbs.voice);
  verb->callback([before, after, as_json] {
    const auto changes = io::mapChanges(io::readMapFile(*before), io::readMapFile(*after));
    print(*as_json ? toJson(changes).dump(2) + "\n" : inWords(changes));
  });
}

void addMap(const Verbs& verbs) {
  CLI::App* verb = verbs.app->add_subcommand("map", "Make, check and describe maps");
  verb->require_subcommand(1);
  addMapInit(*verb, verbs);
  addMapCheck(*verb, verbs);
  addMapInfo(*verb, verbs);
  addMapIntervals(*verb, verbs);
  addMapCoverage(*verb, verbs);
  addMapPlanAnchors(*verb, verbs);
  addMapDiff(*verb, verbs);
  addMapImport(*verb, verbs);
  addMapExport(*verb, verbs);
  addMapRender(*verb, verbs);
}

}  // namespace pos::app
