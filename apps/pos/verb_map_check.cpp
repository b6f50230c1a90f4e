/// `pos map check` and `pos map intervals`.

#include <memory>
#include <nlohmann/json.hpp>

#include "pos/core/error.hpp"
#include "pos/io/text.hpp"
#include "pos/map/checks.hpp"
#include "pos/map/lock_intervals.hpp"
#include "verb_map.hpp"

namespace pos::app {
namespace {

using Json = nlohmann::ordered_json;
using io::text::fixed;

map::Network networkOf(map::TunnelMap tunnel_map) {
  return map::Network(std::make_shared<const map::TunnelMap>(std::move(tunnel_map)));
}

// ---- check ------------------------------------------------------------------------------------------------

struct CheckOptions {
  std::vector<std::string> files;
  std::optional<int> anchors;
  std::optional<double> range;
  std::vector<std::string> vehicles;
  bool json = false;
};

/// "1.245x1.3" or "1.245x1.3x4.6": width, height and length in m.
map::SiteVehicle vehicleOf(const std::string& text) {
  map::SiteVehicle vehicle{.id = text, .length = 1.0};
  std::vector<double*> parts = {&vehicle.width, &vehicle.height, &vehicle.length};
  std::size_t begin = 0;
  std::size_t read = 0;
  while (begin <= text.size() && read < parts.size()) {
    const std::size_t end = std::min(text.find('x', begin), text.size());
    const auto value = io::text::number(text.substr(begin, end - begin));
    if (!value || !(*value > 0.0)) break;
    *parts[read++] = *value;
    begin = end + 1;
  }
  if (read >= 2 && begin > text.size()) return vehicle;
  throw UsageError(Complaint{.what = "this is no size of a vehicle",
                             .key = "--vehicle",
                             .got = text,
                             .expected = "WIDTHxHEIGHT or WIDTHxHEIGHTxLENGTH in m, 1.9x1.6x5"});
}

map::TunnelMap withOptions(map::TunnelMap tunnel_map, const CheckOptions& options) {
  if (!options.anchors && !options.range && options.vehicles.empty()) return tunnel_map;
  if (!tunnel_map.requirements) tunnel_map.requirements.emplace();
  if (options.anchors) tunnel_map.requirements->anchors_visible = *options.anchors;
  if (options.range) tunnel_map.requirements->range_limit = *options.range;
  for (const std::string& text : options.vehicles)
    tunnel_map.requirements->vehicles.push_back(vehicleOf(text));
  return tunnel_map;
}

Json place(const Eigen::Vector3d& p) {
  return {{"x_m", p.x()}, {"y_m", p.y()}, {"z_m", p.z()}};
}

Json toJson(const map::Finding& finding, const std::optional<map::MineGrid>& grid) {
  Json json{
      {"severity", name(finding.severity)}, {"check", name(finding.check)}, {"what", finding.what},
      {"remedy", finding.remedy},           {"objects", finding.objects},   {"place", place(finding.p_map)}};
  if (grid) {
    const Eigen::Vector3d p = toGrid(*grid, finding.p_map);
    json["mine_grid"] = {{"easting_m", p.x()}, {"northing_m", p.y()}, {"elevation_m", p.z()}};
  }
  return json;
}

std::string toText(const map::Finding& finding, const std::optional<map::MineGrid>& grid) {
  const Eigen::Vector3d& p = finding.p_map;
  std::string text = std::string(name(finding.severity)) + " " + std::string(name(finding.check)) + ": " +
                     finding.what + "\n  at:  x " + fixed(p.x(), 2) + ", y " + fixed(p.y(), 2) + ", z " +
                     fixed(p.z(), 2) + " m";
  if (grid) {
    const Eigen::Vector3d g = toGrid(*grid, p);
    text += " (easting " + fixed(g.x(), 2) + ", northing " + fixed(g.y(), 2) + ")";
  }
  return text + "\n  try: " + finding.remedy + "\n";
}

ExitCode runCheck(const CheckOptions& options) {
  bool errors = false;
  Json all = Json::array();
  for (const std::string& file : options.files) {
    const map::TunnelMap tunnel_map = withOptions(mapOf(file), options);
    const std::vector<map::Finding> findings = map::findings(networkOf(tunnel_map), {});
    Json json{{"map", file}, {"findings", Json::array()}};
    if (!options.json) {
      print(file + ": " + (findings.empty() ? "in order" : std::to_string(findings.size()) + " findings") +
            "\n");
    }
    for (const map::Finding& finding : findings) {
      errors = errors || finding.severity == map::Severity::Error;
      json["findings"].push_back(toJson(finding, tunnel_map.mine_grid));
      if (!options.json) print(toText(finding, tunnel_map.mine_grid));
    }
    all.push_back(std::move(json));
  }
  if (options.json) print((all.size() == 1 ? all.front() : all).dump(2) + "\n");
  return errors ? ExitCode::Config : ExitCode::Ok;
}

// ---- intervals --------------------------------------------------------------------------------------------

struct IntervalOptions {
  std::string file;
  std::string route;
  map::DivisionRules rules = {};
  bool json = false;
};

const char* nameOf(map::Lane lane) {
  return lane == map::Lane::Both ? "both" : lane == map::Lane::Forward ? "forward" : "backward";
}

Json toJson(const map::LockInterval& interval, const map::TunnelMap& tunnel_map) {
  Json spans = Json::array();
  for (const map::IntervalSpan& span : interval.spans) {
    spans.push_back({{"roadway", tunnel_map.roadways[span.roadway].id},
                     {"from_m", span.from},
                     {"to_m", span.to},
                     {"lane", nameOf(span.lane)}});
  }
  return {{"id", interval.id},
          {"label", interval.label()},
          {"from", interval.from},
          {"to", interval.to},
          {"length_m", interval.length()},
          {"spans", spans},
          {"inner_chambers", interval.inner_chambers},
          {"nodes", interval.nodes}};
}

std::string toText(const map::LockInterval& interval, const map::TunnelMap& tunnel_map) {
  std::string text = interval.label() + "  " + interval.from + " to " + interval.to + "  " +
                     fixed(interval.length(), 1) + " m ";
  for (const map::IntervalSpan& span : interval.spans) {
    text += " " + tunnel_map.roadways[span.roadway].id + "[" + fixed(span.from, 1) + ".." +
            fixed(span.to, 1) + (span.lane == map::Lane::Both ? "" : std::string(" ") + nameOf(span.lane)) +
            "]";
  }
  return text + "  id " + interval.id + "\n";
}

map::RouteLine routeOf(const map::Network& network, const std::string& id) {
  const map::Route* route = network.map().findRoute(id);
  if (route != nullptr) return map::RouteLine(network, *route);
  std::vector<std::string> ids;
  for (const map::Route& each : network.map().routes) ids.push_back(each.id);
  throw UsageError(Complaint{.what = "the map has no such route",
                             .key = "--route",
                             .got = id,
                             .expected = "one of: " + io::text::joined(ids),
                             .suggestion = io::text::didYouMean(id, ids)});
}

void runIntervals(const IntervalOptions& options) {
  const map::Network network = networkOf(mapOf(options.file));
  const map::RoadGraph graph(network);
  const auto intervals = options.route.empty()
                             ? divided(graph, network, options.rules)
                             : divided(graph, network, routeOf(network, options.route), options.rules);
  Json json = Json::array();
  for (const map::LockInterval& interval : intervals) {
    json.push_back(toJson(interval, network.map()));
    if (!options.json) print(toText(interval, network.map()));
  }
  if (options.json) print(json.dump(2) + "\n");
}

}  // namespace

void addMapCheck(CLI::App& parent, const Verbs& verbs) {
  CLI::App* verb = parent.add_subcommand("check", "Look for what a surveyor should correct");
  auto options = std::make_shared<CheckOptions>();
  verb->add_option("maps", options->files, "Map files")->required();
  verb->add_option("--anchors", options->anchors, "Anchors to be seen from everywhere");
  verb->add_option("--range", options->range, "Range of the radio, m");
  verb->add_option("--vehicle", options->vehicles,
                   "WIDTHxHEIGHT[xLENGTH] in m that every roadway has to let through");
  verb->add_flag("--json", options->json, "Print JSON");
  addVoice(*verb, *verbs.voice);
  verb->footer("Exit code 3 when there is an error; warnings and notes alone give 0.");
  verb->callback([options, verbs] { *verbs.code = runCheck(*options); });
}

void addMapIntervals(CLI::App& parent, const Verbs& verbs) {
  CLI::App* verb = parent.add_subcommand("intervals", "Divide the roadways into lock intervals");
  auto options = std::make_shared<IntervalOptions>();
  verb->add_option("map", options->file, "Map file")->required();
  verb->add_option("--route", options->route, "Along this route, instead of the whole map");
  verb->add_option("--merge", options->rules.merge, "Every so many chambers of a leg end an interval");
  verb->add_flag("--json", options->json, "Print JSON");
  addVoice(*verb, *verbs.voice);
  verb->callback([options] { runIntervals(*options); });
}

}  // namespace pos::app
