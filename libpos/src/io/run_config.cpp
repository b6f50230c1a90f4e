#include "pos/io/run_config.hpp"

#include "pos/io/files.hpp"
#include "pos/io/overrides.hpp"

namespace pos::io {
namespace {

/// The run's seed for every estimator that draws random numbers and has none of its own.
void handSeedDown(const YamlNode& root, RunConfig& run) {
  const YamlNode& entries = *root.find("estimators");
  for (std::size_t i = 0; i < run.estimators.size(); ++i) {
    if (entries.items[i].find("seed") != nullptr) continue;
    std::visit(
        [&](auto& config) {
          if constexpr (requires { config.seed; }) config.seed = run.seed;
        },
        run.estimators[i].config);
  }
}

}  // namespace

RunConfig runConfigFrom(const YamlDocument& document, const std::filesystem::path& mrpt_share) {
  RunConfig config = readOptions(document, runOptions());
  handSeedDown(document.root, config);
  const auto resolve = [&](std::filesystem::path& path) {
    path = resolvedPath(path, document.file.parent_path(), mrpt_share);
  };
  if (config.log) resolve(config.log->file);
  if (config.scenario) resolve(config.scenario->file);
  if (config.map) resolve(*config.map);
  if (config.truth && config.truth->file) resolve(*config.truth->file);
  for (EstimatorEntry& entry : config.estimators) {
    auto* dual = std::get_if<estimation::DualUwbConfig>(&entry.config);
    if (dual == nullptr || dual->range_bias_table.empty()) continue;
    std::filesystem::path table = dual->range_bias_table;
    resolve(table);
    dual->range_bias_table = table.string();
  }
  return config;
}

RunConfig loadRunConfig(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                        const std::filesystem::path& mrpt_share) {
  return runConfigFrom(applyOverrides(loadYaml(file), overrides), mrpt_share);
}

std::string resolvedYaml(const RunConfig& config) {
  return optionsYaml(config, runOptions());
}

std::string exampleRunConfig() {
  RunConfig config;
  config.name = "my_run";
  config.log = LogSource{"my_log.rawlog"};
  config.map = "map.yaml";
  config.estimators = {{.name = "range_odometry", .config = estimation::RangeOdometryConfig{}}};
  return exampleYaml(config, runOptions());
}

}  // namespace pos::io
