#pragma once
/// From a configuration and the command line to everything a replay needs.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common.hpp"
#include "pos/core/estimate.hpp"
#include "pos/eval/run_summary.hpp"
#include "pos/io/run_config.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::sim {
struct Scenario;
}

namespace pos::app {

/// Options that name or change the inputs, the same for every verb that runs estimators.
struct InputOptions {
  std::string config;
  std::string log;
  std::string map;
  std::string truth;
  std::string truth_format;
  std::vector<std::string> overrides;
  std::optional<std::uint64_t> seed;
};

void addInputs(CLI::App& verb, InputOptions& options);
/// The same without the configuration itself, which a verb may name in its own way.
void addInputChoices(CLI::App& verb, InputOptions& options);

/// Everything loaded and checked. `config` is resolved: absolute paths, the command line's choices, starts
/// taken from the truth spelt out.
struct Inputs {
  io::RunConfig config;
  std::shared_ptr<const map::TunnelMap> map;  ///< what the estimators know
  std::optional<Truth> truth;
  std::shared_ptr<const sim::Scenario> scenario = {};       ///< where it takes the place of a log
  std::shared_ptr<const map::TunnelMap> scenario_map = {};  ///< what is really there
  std::optional<eval::TimeGrid> grid = {};                  ///< where the run is one of a campaign
};

Inputs loadInputs(const InputOptions& options);
/// The inputs of one run of a campaign: the file's content as it was when the campaign began, with the run's
/// own seed; map and truth are taken over from `shared` instead of being read again.
Inputs inputsOfRun(const io::YamlDocument& file, InputOptions options, std::uint64_t seed,
                   const Inputs& shared);
/// The same from a configuration that was resolved before (run.json).
Inputs loadInputs(io::RunConfig config);

/// A file that the figures of a run depend on.
struct InputFile {
  std::string role;  ///< "log", "scenario", "map" or "truth"
  std::filesystem::path file;
};
/// The log or scenario first.
std::vector<InputFile> inputFiles(const Inputs& inputs);

/// The configuration with the command line's choices; nothing it names is opened.
io::RunConfig loadConfig(const InputOptions& options);

/// The reference poses that the configuration names, in the map frame. Throws DataError.
std::optional<Truth> loadTruth(const io::RunConfig& config);

eval::EvaluationOptions evaluationOptions(const io::EvaluationConfig& config);

}  // namespace pos::app
