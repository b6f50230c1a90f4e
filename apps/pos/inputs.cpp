#include "inputs.hpp"

#include <algorithm>

#include "pos/core/error.hpp"
#include "pos/io/files.hpp"
#include "pos/io/grid_io.hpp"
#include "pos/io/map_yaml.hpp"
#include "pos/io/rawlog_reader.hpp"
#include "pos/io/trajectory_io.hpp"

namespace pos::app {
namespace {

using Format = io::TruthSource::Format;
namespace fs = std::filesystem;

void applyCommandLine(const InputOptions& options, io::RunConfig& config) {
  if (!options.log.empty()) config.log = io::LogSource{fs::absolute(options.log)};
  if (!options.map.empty()) config.map = fs::absolute(options.map);
  if (!options.truth.empty()) config.truth = io::TruthSource{fs::absolute(options.truth), Format::Tum, {}};
  if (config.truth && !options.truth_format.empty()) {
    const std::vector<std::pair<std::string, Format>> names{{"tum", Format::Tum},
                                                            {"euroc", Format::Euroc},
                                                            {"mrpt_index", Format::MrptIndex},
                                                            {"log", Format::Log}};
    for (const auto& [name, format] : names) {
      if (name == options.truth_format) config.truth->format = format;
    }
  }
  if (options.seed) config.seed = *options.seed;
  if (!config.log) {
    throw UsageError(Complaint{.what = "no log to replay",
                               .place = {.file = options.config},
                               .key = "log.file",
                               .suggestion = "name it in the configuration or with --log"});
  }
}

Truth truthInLog(const fs::path& log) {
  Truth truth;
  io::RawlogReader reader(log.string());
  while (const auto m = reader.next()) {
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

map::TunnelMap mapOf(const io::RunConfig& config) {
  if (!config.map) return {};
  return io::loadMap(*config.map, mrptShare(),
                     [](const fs::path& file) { return io::loadGrid(file.string()); });
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

}  // namespace

void addInputs(CLI::App& verb, InputOptions& options) {
  verb.add_option("config", options.config, "Configuration file (YAML)")->required();
  verb.add_option("--log", options.log, "Rawlog to replay, instead of the configuration's");
  verb.add_option("--map", options.map, "Map, instead of the configuration's");
  verb.add_option("--truth", options.truth, "Reference poses, instead of the configuration's");
  verb.add_option("--truth-format", options.truth_format, "Format of --truth (default tum)")
      ->check(CLI::IsMember({"tum", "euroc", "mrpt_index", "log"}));
  verb.add_option("--set", options.overrides,
                  "key=value laid over the configuration, e.g. estimators.ekf.range_sigma_m=0.3")
      ->take_all()
      ->allow_extra_args(false);
  verb.add_option("--seed", options.seed, "Seed of everything random in the run");
}

std::optional<Truth> loadTruth(const io::RunConfig& config) {
  if (!config.truth) return std::nullopt;
  Truth truth = readTruth(*config.truth, config.log ? config.log->file : fs::path{});
  const Pose3 T_map_truth = Pose3::fromPlanar(config.truth->T_map_truth);
  for (TruthPose& pose : truth.poses) pose.T_map_body = T_map_truth * pose.T_map_body;
  return truth;
}

Inputs loadInputs(const InputOptions& options) {
  Inputs inputs;
  inputs.config = io::loadRunConfig(options.config, options.overrides, mrptShare());
  applyCommandLine(options, inputs.config);
  io::existingFile(inputs.config.log->file, Complaint{.place = {.file = options.config}, .key = "log.file"});
  inputs.map = std::make_shared<const map::TunnelMap>(mapOf(inputs.config));
  inputs.truth = loadTruth(inputs.config);
  for (io::EstimatorEntry& entry : inputs.config.estimators) {
    std::visit([&](auto& config) { spellOutStart(config.start, inputs.truth, entry.name); }, entry.config);
    if (options.seed) {
      std::visit(
          [&](auto& config) {
            if constexpr (requires { config.seed; }) config.seed = *options.seed;
          },
          entry.config);
    }
  }
  inputs.config =
      io::validated(std::move(inputs.config));  // a start that was spelt out may not suit its estimator
  return inputs;
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
