/// `pos map coverage` and `pos map plan-anchors`.

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "pos/io/text.hpp"
#include "pos/map/plan_anchors.hpp"
#include "verb_map.hpp"

namespace pos::app {
namespace {

using Json = nlohmann::ordered_json;
using io::text::fixed;

struct RadioOptions {
  std::optional<double> sigma;
  std::optional<double> range;
  std::optional<double> tag_height;
  std::optional<double> step;
};

void addRadio(CLI::App& verb, RadioOptions& radio) {
  verb.add_option("--sigma", radio.sigma, "Standard deviation of a range, m (0.1)");
  verb.add_option("--range", radio.range, "Range of the radio, m (the map's requirements, or 120)");
  verb.add_option("--tag-height", radio.tag_height,
                  "Height of the tag above the floor, m (the same, or 1.5)");
  verb.add_option("--step", radio.step, "Distance between samples, m");
}

map::CoverageRules rulesOf(const RadioOptions& radio, const map::TunnelMap& tunnel_map, double step) {
  const map::Requirements site = tunnel_map.requirements.value_or(map::Requirements{});
  return map::validated(map::CoverageRules{.range_sigma = radio.sigma.value_or(0.1),
                                           .range_limit = radio.range.value_or(site.range_limit),
                                           .tag_height = radio.tag_height.value_or(site.tag_height),
                                           .step = radio.step.value_or(step)});
}

/// A number, or null where the geometry is singular.
Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}
std::string shown(double value) {
  return std::isfinite(value) ? fixed(value, 3) : "singular";
}

Json toJson(const map::CoverageSummary& summary) {
  return {{"samples", summary.samples},
          {"singular", summary.singular},
          {"anchors_min", summary.anchors_min},
          {"anchors_mean", summary.anchors_mean},
          {"along_median_m", finite(summary.along_median)},
          {"along_p90_m", finite(summary.along_p90)},
          {"along_max_m", finite(summary.along_max)},
          {"across_median_m", finite(summary.across_median)},
          {"across_p90_m", finite(summary.across_p90)},
          {"across_max_m", finite(summary.across_max)}};
}

std::string toText(const std::string& name, const map::CoverageSummary& s) {
  return name + ": along " + shown(s.along_median) + " (p90 " + shown(s.along_p90) + ") m, across " +
         shown(s.across_median) + " (p90 " + shown(s.across_p90) + ") m, anchors " +
         fixed(s.anchors_mean, 1) + " (at least " + std::to_string(s.anchors_min) + "), singular at " +
         std::to_string(s.singular) + " of " + std::to_string(s.samples) + " samples\n";
}

std::string csv(const map::TunnelMap& tunnel_map, const std::vector<map::CoverageSample>& samples) {
  std::string text = "roadway,chainage_m,x_m,y_m,z_m,anchors,along_sigma_m,across_sigma_m\n";
  for (const map::CoverageSample& s : samples) {
    text += io::text::csvCell(tunnel_map.roadways[s.point.roadway].id) + "," + fixed(s.point.chainage, 3) +
            "," + fixed(s.p_map.x(), 3) + "," + fixed(s.p_map.y(), 3) + "," + fixed(s.p_map.z(), 3) + "," +
            std::to_string(s.anchors) + "," + (s.along ? fixed(*s.along, 4) : "") + "," +
            (s.across ? fixed(*s.across, 4) : "") + "\n";
  }
  return text;
}

struct CoverageOptions {
  std::string file;
  std::string csv;
  RadioOptions radio = {};
  bool json = false;
};

void runCoverage(const CoverageOptions& options) {
  const auto tunnel_map = std::make_shared<const map::TunnelMap>(mapOf(options.file));
  const map::Network network(tunnel_map);
  const map::CoverageRules rules = rulesOf(options.radio, *tunnel_map, 1.0);
  Json json{
      {"map", options.file}, {"range_sigma_m", rules.range_sigma}, {"range_limit_m", rules.range_limit}};
  const std::vector<map::CoverageSample> all = coverage(network, rules);
  std::vector<std::vector<map::CoverageSample>> of_roadway(tunnel_map->roadways.size());
  for (const map::CoverageSample& sample : all) of_roadway[sample.point.roadway].push_back(sample);
  std::string text;
  json["roadways"] = Json::array();
  for (map::RoadwayIndex r = 0; r < of_roadway.size(); ++r) {
    const map::CoverageSummary summary = map::summary(of_roadway[r]);
    Json row = toJson(summary);
    row["id"] = tunnel_map->roadways[r].id;
    json["roadways"].push_back(std::move(row));
    text += toText("roadway " + tunnel_map->roadways[r].id, summary);
  }
  json["whole"] = toJson(summary(all));
  if (!options.csv.empty()) writeFile(options.csv, csv(*tunnel_map, all));
  print(options.json ? json.dump(2) + "\n" : text + toText("whole map", summary(all)));
}

struct PlanOptions {
  std::string file;
  std::string out;
  map::PlanRules rules = {};
  RadioOptions radio = {};
  bool json = false;
};

Json toJson(const map::AnchorPlan& plan) {
  Json anchors = Json::array();
  for (const map::Anchor& anchor : plan.added) {
    anchors.push_back({{"id", anchor.id},
                       {"x_m", anchor.p_map.x()},
                       {"y_m", anchor.p_map.y()},
                       {"z_m", anchor.p_map.z()},
                       {"wall", anchor.wall == map::Wall::Left ? "left" : "right"}});
  }
  return {{"met", plan.met},
          {"added", anchors},
          {"anchors_per_km", plan.anchorsPerKilometre()},
          {"samples_met", plan.samples_met},
          {"samples", plan.samples},
          {"before", toJson(plan.before)},
          {"after", toJson(plan.after)}};
}

std::string toText(const map::AnchorPlan& plan, const map::PlanRules& rules) {
  std::string text = std::string(plan.met ? "target met" : "target NOT met by any number of anchors") +
                     ": along " + fixed(rules.along, 2) + " m and across " + fixed(rules.across, 2) +
                     " m at " + std::to_string(plan.samples_met) + " of " + std::to_string(plan.samples) +
                     " samples\n";
  text += "cost: " + std::to_string(plan.added.size()) + " anchors more, " +
          fixed(plan.anchorsPerKilometre(), 1) + " a kilometre of " + fixed(plan.roadway_length, 0) + " m\n";
  text += toText("before", plan.before) + toText("after", plan.after);
  for (const map::Anchor& anchor : plan.added) {
    text += "  anchor " + std::to_string(anchor.id) + ": x " + fixed(anchor.p_map.x(), 2) + ", y " +
            fixed(anchor.p_map.y(), 2) + ", z " + fixed(anchor.p_map.z(), 2) + " m, " +
            (anchor.wall == map::Wall::Left ? "left" : "right") + " wall\n";
  }
  return text;
}

ExitCode runPlan(PlanOptions options) {
  io::MapFile file = io::readMapFile(options.file);
  options.rules.coverage = rulesOf(options.radio, file.map, 5.0);
  const map::Network network(std::make_shared<const map::TunnelMap>(file.map));
  const map::AnchorPlan plan = plannedAnchors(network, options.rules);
  print(options.json ? toJson(plan).dump(2) + "\n" : toText(plan, options.rules));
  if (!options.out.empty()) {
    file.map.anchors.insert(file.map.anchors.end(), plan.added.begin(), plan.added.end());
    writeFile(options.out,
              io::checkedMapText(io::moved(file, folderOf(options.file), folderOf(options.out))));
  }
  return plan.met ? ExitCode::Ok : ExitCode::Missed;
}

}  // namespace

void addMapCoverage(CLI::App& parent, const Verbs& verbs) {
  CLI::App* verb = parent.add_subcommand("coverage", "How well ranges can fix a tag, along and across");
  auto options = std::make_shared<CoverageOptions>();
  verb->add_option("map", options->file, "Map file")->required();
  verb->add_option("--csv", options->csv, "Write every sample to this table");
  addRadio(*verb, options->radio);
  verb->add_flag("--json", options->json, "Print JSON");
  addVoice(*verb, *verbs.voice);
  verb->callback([options] { runCoverage(*options); });
}

void addMapPlanAnchors(CLI::App& parent, const Verbs& verbs) {
  CLI::App* verb = parent.add_subcommand("plan-anchors", "Propose places of anchors for a target");
  auto options = std::make_shared<PlanOptions>();
  verb->add_option("map", options->file, "Map file")->required();
  verb->add_option("--along", options->rules.along, "Bound to be met along the roadway, m")
      ->capture_default_str();
  verb->add_option("--across", options->rules.across, "Bound to be met across it, m")->capture_default_str();
  verb->add_option("--share", options->rules.met_share, "Share of the roadways to meet it")
      ->capture_default_str();
  verb->add_option("--anchor-height", options->rules.anchor_height, "Above the floor, m")
      ->capture_default_str();
  verb->add_option("--candidate-step", options->rules.candidate_step, "Distance between places tried, m")
      ->capture_default_str();
  verb->add_option("--out", options->out, "Write the map with the anchors added");
  addRadio(*verb, options->radio);
  verb->add_flag("--json", options->json, "Print JSON");
  addVoice(*verb, *verbs.voice);
  verb->footer("Exit code 4 when the target cannot be met.");
  verb->callback([options, verbs] { *verbs.code = runPlan(*options); });
}

}  // namespace pos::app
