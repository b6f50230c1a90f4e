/// `pos simulate`: a scenario into a log, its truth and its map.

#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "common.hpp"
#include "pos/core/error.hpp"
#include "pos/io/files.hpp"
#include "pos/io/grid_io.hpp"
#include "pos/io/map_yaml.hpp"
#include "pos/io/overrides.hpp"
#include "pos/io/rawlog_writer.hpp"
#include "pos/io/run_folder.hpp"
#include "pos/io/scenario_yaml.hpp"
#include "pos/io/sha256.hpp"
#include "pos/sim/simulation.hpp"
#include "progress.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t kProgressEvery = 4096;

struct Options {
  std::string scenario;
  std::vector<std::string> overrides;
  std::uint64_t seed = 1;
  std::string folder;
  double truth_rate = 20.0;
  bool stream = false;
  bool json = false;
  bool force = false;
  bool dry_run = false;
};

struct Site {
  sim::Scenario scenario;
  std::shared_ptr<const map::TunnelMap> map;
};

Site loadSite(const Options& options) {
  Site site{io::loadScenario(options.scenario, options.overrides, mrptShare()), nullptr};
  if (site.scenario.map) {
    io::existingFile(*site.scenario.map, Complaint{.place = {.file = options.scenario}, .key = "map"});
    site.map = std::make_shared<const map::TunnelMap>(io::loadMap(
        *site.scenario.map, mrptShare(), [](const fs::path& grid) { return io::loadGrid(grid.string()); }));
  } else {
    site.map = std::make_shared<const map::TunnelMap>();
  }
  return site;
}

/// The simulation; what it has to say of a key is said of the scenario's file.
sim::Simulation started(const Site& site, const Options& options) {
  try {
    return sim::Simulation(site.scenario, site.map, options.seed);
  } catch (const ConfigError& error) {
    Complaint complaint = error.complaint();
    if (complaint.place.file.empty()) complaint.place.file = options.scenario;
    throw ConfigError(complaint);
  }
}

/// What a pass over the sensors was like.
struct Made {
  std::uint64_t measurements = 0;
  std::map<std::string, std::uint64_t> by_sensor = {};
  bool interrupted = false;
};

template <class Take>
Made passed(sim::Simulation& simulation, const Voice& voice, Take take) {
  Made made;
  ProgressLine line(voice, "simulate", simulation.end());
  while (const auto delivery = simulation.next()) {
    take(delivery->measurement);
    ++made.by_sensor[delivery->measurement.sensor];
    if (++made.measurements % kProgressEvery != 0) continue;
    line.draw(made.measurements, delivery->arrival);
    if (interrupted()) {
      made.interrupted = true;
      break;
    }
  }
  return made;
}

void writeTruth(const sim::Simulation& simulation, double rate, const fs::path& file) {
  io::TumWriter tum(file);
  sim::TruthSampler sampler(simulation, rate);
  while (const auto pose = sampler.next()) {
    tum.write({.stamp = pose->stamp, .T_map_body = pose->T_map_body});
  }
  tum.close();
}

/// The map as it was named; one with a grid takes the grid along.
void writeMap(const Site& site, const io::RunFolder& folder) {
  if (!site.scenario.map) return;
  if (site.map->grid) {
    io::saveMrptGrid(*site.map->grid, folder.grid().string());
    io::saveMap(*site.map, folder.map(), folder.grid().filename());
  } else {
    writeFile(folder.map(), io::fileText(*site.scenario.map));
  }
}

Json fileEntry(const char* role, const fs::path& file) {
  return {{"role", role}, {"file", file.string()}, {"sha256", io::sha256OfFile(file)}};
}

/// Everything needed to simulate it again, and to know that it came out the same.
std::string runJson(const Site& site, const Options& options, const io::RunFolder& folder) {
  Json run{{"run", site.scenario.name},
           {"pos_version", version()},
           {"git", gitHash()},
           {"seed", options.seed},
           {"truth_rate_hz", options.truth_rate}};
  run["inputs"] = Json::array({fileEntry("scenario", options.scenario)});
  if (site.scenario.map) run["inputs"].push_back(fileEntry("map", *site.scenario.map));
  run["outputs"] = {{{"file", "log.rawlog"}, {"sha256", io::sha256OfFile(folder.log())}},
                    {{"file", "truth.tum"}, {"sha256", io::sha256OfFile(folder.truth())}}};
  run["scenario"] = io::resolvedYaml(site.scenario);
  return run.dump(2) + "\n";
}

Json summary(const Site& site, const sim::Simulation& simulation, const Options& options, const Made& made) {
  return {{"scenario", site.scenario.name},      {"seed", options.seed},
          {"duration_s", simulation.duration()}, {"measurements", made.measurements},
          {"sensors", made.by_sensor},           {"interrupted", made.interrupted}};
}

void show(const Site& site, const sim::Simulation& simulation, const Options& options, const Made& made) {
  if (options.json) {
    print(summary(site, simulation, options, made).dump(2) + "\n");
    return;
  }
  char line[160];
  std::snprintf(line, sizeof line, "%s: %.1f s, %llu measurements, seed %llu\n", site.scenario.name.c_str(),
                simulation.duration(), static_cast<unsigned long long>(made.measurements),
                static_cast<unsigned long long>(options.seed));
  print(line);
  for (const auto& [sensor, count] : made.by_sensor) {
    std::snprintf(line, sizeof line, "  %-16s %10llu\n", sensor.c_str(),
                  static_cast<unsigned long long>(count));
    print(line);
  }
}

Made written(const Site& site, sim::Simulation& simulation, const Options& options, const Voice& voice) {
  const auto folder = io::RunFolder::create(
      options.folder, options.force ? io::ExistingRun::Replace : io::ExistingRun::Refuse);
  io::RawlogWriter log(folder.log().string());
  Made made = passed(simulation, voice, [&](const Measurement& m) { log.write(m); });
  log.close();
  writeTruth(simulation, options.truth_rate, folder.truth());
  writeMap(site, folder);
  writeFile(folder.runJson(), runJson(site, options, folder));
  voice.say("written: " + folder.log().string() + ", truth.tum" + (site.scenario.map ? ", map.yaml" : "") +
            ", run.json");
  return made;
}

ExitCode runSimulate(const Options& options, const Voice& voice) {
  if (options.folder.empty() && !options.stream && !options.dry_run) {
    throw UsageError(Complaint{.what = "no folder to write to",
                               .key = "--out",
                               .suggestion = "add --out FOLDER, or --stream to make the measurements only"});
  }
  const Site site = loadSite(options);
  sim::Simulation simulation = started(site, options);
  if (options.dry_run) {
    print(io::resolvedYaml(site.scenario));
    voice.say("nothing was simulated: the scenario and the map are in order");
    return ExitCode::Ok;
  }
  watchInterrupts();
  const Made made = options.stream ? passed(simulation, voice, [](const Measurement&) {})
                                   : written(site, simulation, options, voice);
  show(site, simulation, options, made);
  if (!made.interrupted) return ExitCode::Ok;
  voice.warn("interrupted: the measurements end where it was stopped");
  return ExitCode::Interrupted;
}

}  // namespace

void addSimulate(const Verbs& verbs) {
  CLI::App* verb = verbs.app->add_subcommand("simulate", "Make the log, the truth and the map of a scenario");
  auto options = std::make_shared<Options>();
  verb->add_option("scenario", options->scenario, "Scenario file (YAML)")->required();
  verb->add_option("--seed", options->seed, "Seed of all random numbers (default 1)")->check(kWholeNumber);
  verb->add_option("--out", options->folder, "Folder for log.rawlog, truth.tum, map.yaml and run.json");
  verb->add_flag("--force", options->force, "Replace the files of an earlier run in --out");
  verb->add_option("--set", options->overrides,
                   "key=value laid over the scenario, e.g. sensors.uwb.sigma_m=0.3 or duration_s=10")
      ->take_all()
      ->allow_extra_args(false);
  verb->add_option("--rate-truth", options->truth_rate, "Reference poses per second (default 20)")
      ->check(CLI::Range(0.001, 10000.0));
  verb->add_flag("--stream", options->stream, "Make the measurements without writing them; only count them");
  verb->add_flag("--json", options->json, "Print what was made as JSON");
  verb->add_flag("--dry-run", options->dry_run,
                 "Check everything, print the resolved scenario, simulate nothing");
  addVoice(*verb, *verbs.voice);
  verb->callback([options, verbs] { *verbs.code = runSimulate(*options, *verbs.voice); });
}

}  // namespace pos::app
