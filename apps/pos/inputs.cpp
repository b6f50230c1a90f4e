#include "inputs.hpp"

#include <algorithm>

#include "pos/core/error.hpp"
#include "pos/io/files.hpp"
#include "pos/io/grid_io.hpp"
#include "pos/io/log_reader.hpp"
#include "pos/io/map_yaml.hpp"
#include "pos/io/overrides.hpp"
#include "pos/io/range_bias_yaml.hpp"
#include "pos/io/scenario_yaml.hpp"
#include "pos/io/trajectory_io.hpp"
#include "pos/sim/simulation.hpp"
#include "pos/sim/zone_changes.hpp"

namespace pos::app {
namespace {

using Format = io::TruthSource::Format;
namespace fs = std::filesystem;

Format formatOf(const std::string& word) {
  if (word == "euroc") return Format::Euroc;
  if (word == "mrpt_index") return Format::MrptIndex;
  return word == "log" ? Format::Log : Format::Tum;
}

/// `--truth` replaces the configuration's truth, placement included; `--truth-format log` needs no file.
void applyTruth(const InputOptions& options, io::RunConfig& config) {
  const bool in_log = options.truth_format == "log";
  if (in_log && options.truth.empty()) {
    config.truth = io::TruthSource{{}, Format::Log, {}};
  } else if (!options.truth.empty() && !in_log) {
    config.truth = io::TruthSource{fs::absolute(options.truth), formatOf(options.truth_format), {}};
  } else if (!options.truth_format.empty()) {
    throw UsageError(
        Complaint{.what = in_log ? "--truth-format log takes the poses in the log, so no --truth goes with it"
                                 : "--truth-format describes a file, and no --truth names one",
                  .key = "--truth-format",
                  .got = options.truth_format,
                  .suggestion = in_log ? "leave --truth out" : "add --truth FILE"});
  }
}

/// Every file by name before any is read, so that a wrong path is told with the key it stands under.
void requireFiles(const InputOptions& options, const io::RunConfig& config) {
  const auto require = [&](const fs::path& file, bool on_command_line, const std::string& option,
                           const std::string& key) {
    const std::string place = on_command_line ? option : options.config;
    io::existingFile(file, Complaint{.place = {.file = place}, .key = on_command_line ? "" : key});
  };
  if (!config.log && !config.scenario) {
    throw UsageError(Complaint{.what = "no log to replay",
                               .place = {.file = options.config},
                               .key = "log.file",
                               .suggestion = "name it in the configuration (log or scenario) or with --log"});
  }
  if (config.map) require(*config.map, !options.map.empty(), "--map", "map");
  if (config.scenario) {
    require(config.scenario->file, false, "", "scenario.file");
    return;
  }
  try {
    require(config.log->file, !options.log.empty(), "--log", "log.file");
    if (config.truth && config.truth->file)
      require(*config.truth->file, !options.truth.empty(), "--truth", "truth.file");
  } catch (const ConfigError& missing) {
    throw DataError(missing.complaint());  // the configuration may be in order; the recording is not there
  }
}

void applyCommandLine(const InputOptions& options, io::RunConfig& config) {
  if (!options.log.empty()) {
    config.log = io::LogSource{fs::absolute(options.log)};
    config.scenario.reset();
  }
  if (!options.map.empty()) config.map = fs::absolute(options.map);
  applyTruth(options, config);
}

Truth truthInLog(const fs::path& log) {
  Truth truth;
  const auto reader = io::openLog(log.string()).reader;
  while (const auto m = reader->next()) {
    const auto* pose = std::get_if<PoseTruth>(&m->reading);
    if (pose != nullptr && (truth.poses.empty() || m->stamp > truth.poses.back().stamp)) {
      truth.poses.push_back({m->stamp, pose->T_map_body});
    }
  }
  if (truth.poses.empty()) {
    throw DataError(Complaint{.what = "the log holds no reference poses",
                              .place = {.file = log.string()},
                              .key = "truth.format",
                              .suggestion = "name a truth file, or leave truth out"});
  }
  return truth;
}

Truth readTruth(const io::TruthSource& source, const fs::path& log) {
  switch (source.format) {
    case Format::Tum:
      return io::readTumTruth(*source.file);
    case Format::Euroc:
      return io::readEurocTruth(*source.file);
    case Format::MrptIndex:
      return io::readIndexTruth(*source.file, io::frameStamps(log.string()));
    case Format::Log:
      return truthInLog(log);
  }
  throw ContractError("unknown truth format");
}

std::shared_ptr<const map::TunnelMap> loadedMap(const std::optional<fs::path>& file) {
  if (!file) return std::make_shared<const map::TunnelMap>();
  return std::make_shared<const map::TunnelMap>(
      io::loadMap(*file, mrptShare(), [](const fs::path& grid) { return io::loadGrid(grid.string()); }));
}

/// The scenario in the place of a log, with its own map and truth. The estimators get the configuration's map
/// where it names one: theirs may have errors that the mine has not.
void loadScenario(Inputs& inputs) {
  const io::ScenarioSource& source = *inputs.config.scenario;
  sim::Scenario scenario = io::loadScenario(source.file, {}, mrptShare());
  if (source.duration) scenario.duration = *source.duration;
  inputs.scenario_map = loadedMap(scenario.map);
  if (!inputs.config.map) inputs.map = inputs.scenario_map;
  inputs.scenario = std::make_shared<const sim::Scenario>(std::move(scenario));
  const sim::Simulation simulation(*inputs.scenario, inputs.scenario_map, inputs.config.seed);
  inputs.truth = sim::sampledTruth(simulation, source.truth_rate);
  inputs.boundaries = sim::zoneChanges(*inputs.scenario, simulation);
}

/// `at_truth`: the place of the first reference pose, as a crew would survey the mark the run starts from.
/// Its heading too where the reference has one; otherwise the heading is left to the estimator.
void spellOutStart(estimation::StartConfig& start, const std::optional<Truth>& truth,
                   const std::string& name) {
  if (start.mode != estimation::StartMode::AtTruth) return;
  if (!truth || truth->poses.empty()) {
    throw ConfigError(Complaint{.what = "start.mode is at_truth, and there is no truth",
                                .key = "estimators." + name + ".start.mode",
                                .suggestion = "give --truth, or use known, unknown_heading or unknown"});
  }
  start.pose = truth->poses.front().T_map_body.planar();
  start.mode = truth->has_yaw ? estimation::StartMode::Known : estimation::StartMode::UnknownHeading;
}

/// The table of range biases that the estimator names, spelt out, so that run.json holds all that a run
/// needs.
void spellOutBiases(io::EstimatorEntry& entry) {
  auto* dual = std::get_if<estimation::DualUwbConfig>(&entry.config);
  if (dual == nullptr || dual->range_bias_table.empty()) return;
  const fs::path file = io::existingFile(
      dual->range_bias_table,
      Complaint{.key = "estimators." + entry.name + ".range_bias_table",
                .suggestion = "write it with pos calibrate ranges, see docs/howto/calibrate_ranges.md"});
  *dual = io::withTable(*dual, io::loadRangeBiasTable(file));
}

io::RunConfig configFrom(const io::YamlDocument& file, const InputOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.seed) overrides.push_back("seed=" + std::to_string(*options.seed));
  io::RunConfig config = io::runConfigFrom(io::applyOverrides(file, overrides), mrptShare());
  applyCommandLine(options, config);
  return config;
}

/// Starts at the truth spelt out, and the whole checked again: one that was spelt out may not suit its
/// estimator.
void spellOutStarts(Inputs& inputs) {
  for (io::EstimatorEntry& entry : inputs.config.estimators) {
    std::visit([&](auto& own) { spellOutStart(own.start, inputs.truth, entry.name); }, entry.config);
    spellOutBiases(entry);
  }
  inputs.config = io::validated(std::move(inputs.config));
}

}  // namespace

void addInputs(CLI::App& verb, InputOptions& options) {
  verb.add_option("config", options.config, "Configuration file (YAML)")->required();
  addInputChoices(verb, options);
}

void addInputChoices(CLI::App& verb, InputOptions& options) {
  verb.add_option("--log", options.log, "Rawlog to replay, instead of the configuration's");
  verb.add_option("--map", options.map, "Map, instead of the configuration's");
  verb.add_option("--truth", options.truth, "Reference poses, instead of the configuration's");
  verb.add_option("--truth-format", options.truth_format, "Format of --truth (default tum)")
      ->check(CLI::IsMember({"tum", "euroc", "mrpt_index", "log"}));
  verb.add_option("--set", options.overrides,
                  "key=value laid over the configuration, e.g. estimators.ekf.range_sigma_m=0.3")
      ->take_all()
      ->allow_extra_args(false);
  verb.add_option("--seed", options.seed, "Seed of the run; estimators with a seed of their own keep it")
      ->check(kWholeNumber);
}

std::optional<Truth> loadTruth(const io::RunConfig& config) {
  if (!config.truth) return std::nullopt;
  Truth truth = readTruth(*config.truth, config.log ? config.log->file : fs::path{});
  const Pose3 T_map_truth = Pose3::fromPlanar(config.truth->T_map_truth);
  for (TruthPose& pose : truth.poses) pose.T_map_body = T_map_truth * pose.T_map_body;
  return truth;
}

io::RunConfig loadConfig(const InputOptions& options) {
  return configFrom(io::loadYaml(options.config), options);
}

Inputs loadInputs(const InputOptions& options) {
  io::RunConfig config = loadConfig(options);
  requireFiles(options, config);
  return loadInputs(std::move(config));
}

Inputs loadInputs(io::RunConfig config) {
  Inputs inputs{std::move(config), nullptr, std::nullopt};
  inputs.map = loadedMap(inputs.config.map);
  inputs.truth = loadTruth(inputs.config);
  if (inputs.config.scenario) loadScenario(inputs);
  spellOutStarts(inputs);
  return inputs;
}

Inputs inputsOfRun(const io::YamlDocument& file, InputOptions options, std::uint64_t seed,
                   const Inputs& shared) {
  options.seed = seed;
  Inputs inputs = shared;
  inputs.config = configFrom(file, options);
  if (inputs.config.scenario) loadScenario(inputs);  // its noise is the seed's
  spellOutStarts(inputs);
  return inputs;
}

std::vector<InputFile> inputFiles(const Inputs& inputs) {
  const io::RunConfig& config = inputs.config;
  std::vector<InputFile> files;
  if (config.scenario) files.push_back({"scenario", config.scenario->file});
  if (config.log) files.push_back({"log", config.log->file});
  if (config.map) files.push_back({"map", *config.map});
  if (!config.map && inputs.scenario && inputs.scenario->map) files.push_back({"map", *inputs.scenario->map});
  if (config.truth && config.truth->file) files.push_back({"truth", *config.truth->file});
  return files;
}

eval::EvaluationOptions evaluationOptions(const io::EvaluationConfig& config) {
  using Align = io::EvaluationConfig::Align;
  eval::EvaluationOptions options;
  options.association.max_truth_gap = durationFromSeconds(config.max_gap);
  options.association.time_offset = durationFromSeconds(-config.truth_time_offset);
  options.truth_sigma = config.truth_sigma;
  switch (config.align) {
    case Align::None:
      options.alignment = eval::AlignmentMode::None;
      break;
    case Align::Origin:
      options.alignment = eval::AlignmentMode::Origin;
      break;
    case Align::Se2:
      options.alignment = eval::AlignmentMode::Se2;
      break;
    case Align::Se3:
      options.alignment = eval::AlignmentMode::Se3;
      break;
    case Align::PosYaw:
      options.alignment = eval::AlignmentMode::PosYaw;
      break;
  }
  return options;
}

}  // namespace pos::app
