#include "pos/io/locks_config.hpp"

#include "pos/core/error.hpp"
#include "pos/io/files.hpp"
#include "pos/io/overrides.hpp"

namespace pos::io {
namespace {

using interval::LockMapRules;
using interval::LockRules;
using traffic::TrafficOptions;

OptionTable<LockRules> ruleOptions() {
  return OptionTable<LockRules>("rules", "When road is released and granted.")
      .number("footprint_sigmas", &LockRules::footprint_sigmas, between(0.1, 100),
              "The footprint is the body widened by so many sigmas at both ends.")
      .number("release_sigmas", &LockRules::release_sigmas, between(0, 100),
              "So many sigmas more before road is released behind a vehicle.")
      .number("release_margin_m", &LockRules::release_margin, between(0, 1000), "And so much more.")
      .number("stale_after_s", &LockRules::stale_after, between(0.1, 3600),
              "Time without a report after which a position is stale.")
      .number("steady_for_s", &LockRules::steady_for, between(0.1, 3600),
              "Time of steady reports before a position is believed again.")
      .number("jump_sigmas", &LockRules::jump_sigmas, between(0.1, 100),
              "A report farther off the dead reckoning is a jump.")
      .number("speed_error_m_per_s", &LockRules::speed_error, between(0, 100),
              "How wrong a told speed may be.")
      .number("jump_slack_m", &LockRules::jump_slack, between(0.1, 10000),
              "Error of the dead reckoning beyond which only a passage ends a doubt.")
      .number("gap_between_m", &LockRules::gap_between, between(0, 1000),
              "Between vehicles that wait in one place.")
      .number("patience_s", &LockRules::patience, between(0, 86400),
              "Waiting time after which nobody of equal rank is let in before it.")
      .number("aging_s", &LockRules::aging, between(1, 86400),
              "Waiting time that raises the rank by one class.");
}

OptionTable<LockMapRules> sectionOptions() {
  return OptionTable<LockMapRules>("sections", "How the map is cut into sections.")
      .number("bay_margin_m", &LockMapRules::bay_margin, between(0, 1000),
              "The road belongs to a chamber this far beyond both of its ends.")
      .number("junction_reach_m", &LockMapRules::junction_reach, between(0.1, 1000),
              "Of every road at a junction, so much belongs to the junction.")
      .number("stop_line_m", &LockMapRules::stop_line, between(0, 1000),
              "On two lanes the vehicle waits this far before the junction's part.")
      .number("queue_length_m", &LockMapRules::queue_length, between(1, 10000),
              "Longest queue on one lane before a junction.")
      .number("queue_margin_m", &LockMapRules::queue_margin, between(0, 1000),
              "So much of that queue is left free.");
}

OptionTable<TrafficOptions> trafficOptions() {
  return OptionTable<TrafficOptions>("traffic", "Vehicles that ask, obey, and report badly.")
      .integer("vehicles", &TrafficOptions::vehicles, between(1, 1000), "How many.")
      .integer("requests", &TrafficOptions::requests, between(1, 1e9), "No new way is begun after so many.")
      .number("missing_rate_hz", &TrafficOptions::missing_per_s, between(0, 1),
              "How often reports go missing, for 2 to 40 s.")
      .number("jump_rate_hz", &TrafficOptions::jump_per_s, between(0, 1),
              "How often positions are wrong by 10 to 80 m, for 1 to 8 s.")
      .number("vague_rate_hz", &TrafficOptions::vague_per_s, between(0, 1),
              "How often the sigma is 2 to 8 m, for 5 to 30 s.")
      .number("alarm_rate_hz", &TrafficOptions::alarm_per_s, between(0, 1),
              "How often a vehicle raises an alarm, for 5 to 20 s.")
      .number("restart_rate_hz", &TrafficOptions::restart_per_s, between(0, 1),
              "How often the engine loses its memory.")
      .number("stuck_after_s", &TrafficOptions::stuck_after, between(60, 1e6),
              "Time without any grant while somebody waits that counts as a deadlock.");
}

OptionTable<LockVehicle> vehicleOptions() {
  return OptionTable<LockVehicle>("vehicles", "A vehicle whose positions are in a file.")
      .path("file", &LockVehicle::file,
            "TUM with covariance (20 columns), or <estimator>.csv of a run folder.")
      .required()
      .text("route", &LockVehicle::route, "The route of the map that it drives.")
      .required()
      .flag("reversed", &LockVehicle::reversed, "Whether it drives the route from its end.")
      .number("front_m", &LockVehicle::front, between(0, 100), "From the reported point to the front.")
      .number("rear_m", &LockVehicle::rear, between(0, 100), "From the reported point to the rear.")
      .number("max_speed_m_per_s", &LockVehicle::max_speed, between(0.1, 100), "What it can do at most.")
      .integer("priority", &LockVehicle::priority, between(0, 100), "Class; 0 goes first.");
}

OptionTable<LocksConfig::Diagram> diagramOptions() {
  using Diagram = LocksConfig::Diagram;
  return OptionTable<Diagram>("diagram", "The time-distance diagram of the report.")
      .text("route", &Diagram::route,
            "The route of the map it is drawn along; the first, or else the longest way, where absent.")
      .number("from_s", &Diagram::from, between(0, 1e9), "Where its time begins.")
      .number("length_s", &Diagram::length, between(10, 1e6), "How much time it shows.");
}

/// Either generated traffic or recorded vehicles.
void requireOneKind(const LocksConfig& config) {
  if (config.traffic.has_value() != config.vehicles.empty()) {
    throw ConfigError(Complaint{.what = "there has to be either generated traffic or recorded vehicles",
                                .key = "traffic",
                                .got = config.traffic ? "both" : "none",
                                .expected = "either traffic or vehicles"});
  }
}

}  // namespace

OptionTable<LocksConfig> locksOptions() {
  using Ways = LocksConfig::Ways;
  return OptionTable<LocksConfig>("Configuration of locks",
                                  "Which vehicles drive on which map under which rules.")
      .integer("schema", &LocksConfig::schema, between(1, 1), "Version of this format.")
      .required()
      .text("name", &LocksConfig::name, "Name of the run in reports.")
      .required()
      .path("map", &LocksConfig::map, "The map file.")
      .required()
      .integer("seed", &LocksConfig::seed, atLeast(0), "Seed of all random numbers of the traffic.")
      .integer("merge", &LocksConfig::merge, between(1, 1000),
               "Every so many chambers are an interval's boundary.")
      .table("sections", &LocksConfig::sections, sectionOptions(), "How the map is cut into sections.")
      .table("rules", &LocksConfig::rules, ruleOptions(), "When road is released and granted.")
      .choice("ways", &LocksConfig::ways,
              {{"ends", Ways::Ends}, {"routes", Ways::Routes}, {"both", Ways::Both}},
              "Traffic drives between all open ends and portals, along the routes of the map, or both.")
      .table("traffic", &LocksConfig::traffic, trafficOptions(), "Vehicles that ask, obey, and report badly.")
      .list("vehicles", &LocksConfig::vehicles, vehicleOptions(), "Vehicles whose positions are in files.")
      .table("diagram", &LocksConfig::diagram, diagramOptions(), "The time-distance diagram of the report.")
      .check(requireOneKind);
}

LocksConfig loadLocksConfig(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                            const std::filesystem::path& mrpt_share) {
  const YamlDocument document = applyOverrides(loadYaml(file), overrides);
  LocksConfig config = readOptions(document, locksOptions());
  const auto resolve = [&](std::filesystem::path& path) {
    path = resolvedPath(path, document.file.parent_path(), mrpt_share);
  };
  resolve(config.map);
  for (LockVehicle& vehicle : config.vehicles) resolve(vehicle.file);
  return config;
}

std::string resolvedYaml(const LocksConfig& config) {
  return optionsYaml(config, locksOptions());
}

}  // namespace pos::io
