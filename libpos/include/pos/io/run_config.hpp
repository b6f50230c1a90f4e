#pragma once
/// The configuration of a replay: which log, which map, which estimators, and how they are judged.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pos/io/estimator_options.hpp"
#include "pos/io/interval_options.hpp"

namespace pos::io {

struct LogSource {
  std::filesystem::path file;  ///< absolute after loading

  bool operator==(const LogSource&) const = default;
};

/// A simulation instead of a recording; it brings its own map and truth.
struct ScenarioSource {
  std::filesystem::path file;      ///< absolute after loading
  double truth_rate = 20.0;        ///< Hz, reference poses for the evaluation
  std::optional<double> duration;  ///< s, less than the scenario's own

  bool operator==(const ScenarioSource&) const = default;
};

/// Where the reference poses come from.
struct TruthSource {
  enum class Format {
    Tum,        ///< t x y z qx qy qz qw
    Euroc,      ///< EuRoC's ground-truth csv
    MrptIndex,  ///< MRPT's text files: row i belongs to frame i of the log
    Log,        ///< the PoseTruth measurements of the log itself
  };
  std::optional<std::filesystem::path> file;  ///< absolute after loading; absent for Format::Log
  Format format = Format::Tum;
  Pose2 T_map_truth;  ///< composed in front of every truth pose

  bool operator==(const TruthSource&) const = default;
};

struct SequencerConfig {
  double lag = 0.0;  ///< s, how late a measurement may arrive and still be put in order

  bool operator==(const SequencerConfig&) const = default;
};

struct RecordConfig {
  double max_rate = 20.0;  ///< Hz, estimates written per second and estimator

  bool operator==(const RecordConfig&) const = default;
};

/// Damage done to the log on purpose, to see what the estimators make of it.
struct FaultConfig {
  double range_outlier_probability = 0.0;
  double range_outlier_min = 3.0;     ///< m, added to a spoilt range
  double range_outlier_max = 20.0;    ///< m
  std::optional<std::uint64_t> seed;  ///< absent: the run's own seed

  bool operator==(const FaultConfig&) const = default;
};

/// What to know of one sensor of the log.
struct SensorConfig {
  std::string sensor;    ///< its label in the log
  bool use = true;       ///< false: its measurements are left out
  double latency = 0.0;  ///< s, its stamps are this late; they are moved back by it

  bool operator==(const SensorConfig&) const = default;
};

/// A stretch of the run whose errors are also given by themselves; windows of one name are taken together.
struct WindowConfig {
  std::string name;
  double from = 0.0;  ///< s since the start of the truth, or of the log without one
  double to = 0.0;    ///< s

  bool operator==(const WindowConfig&) const = default;
};

struct EvaluationConfig {
  enum class Align { None, Origin, Se2, Se3, PosYaw };
  Align align = Align::None;
  double skip_start = 0.0;         ///< s, not judged at the beginning
  double max_gap = 1.0;            ///< s, truth is not interpolated over a longer gap
  double truth_time_offset = 0.0;  ///< s, added to the stamps of the truth
  double truth_sigma = 0.0;        ///< m per axis, how good the truth is; enters the NEES only
  std::vector<WindowConfig> windows = {};

  bool operator==(const EvaluationConfig&) const = default;
};

/// How many runs of this configuration are taken together (pos campaign).
struct CampaignConfig {
  std::optional<double> step;  ///< s between the moments at which runs are compared; absent: 1 / max_rate
  std::optional<std::string> baseline;  ///< estimator the others are compared with; absent: the first

  bool operator==(const CampaignConfig&) const = default;
};

struct RunConfig {
  int schema = 1;
  std::string name;
  std::optional<LogSource> log;              ///< absent: named on the command line
  std::optional<ScenarioSource> scenario;    ///< instead of a log
  std::optional<std::filesystem::path> map;  ///< absolute after loading; absent: on the command line, or none
  std::optional<TruthSource> truth;
  SequencerConfig sequencer;
  std::uint64_t seed = 1;
  RecordConfig record;
  FaultConfig faults;
  std::vector<SensorConfig> sensors;
  EvaluationConfig evaluation;
  CampaignConfig campaign;
  std::optional<IntervalsConfig> intervals = {};  ///< absent: intervals are not evaluated
  std::vector<EstimatorEntry> estimators;

  bool operator==(const RunConfig&) const = default;
};

OptionTable<RunConfig> runOptions();

/// The config itself when it can be run: at least one estimator, names that are unique and fit a file name,
/// rules across keys. Throws ConfigError; keys are spelt as in the file.
RunConfig validated(RunConfig config);

/// Reads a replay configuration. Relative paths, also those of overrides, start at the file's folder;
/// `mrpt-common:` stands for `mrpt_share`. Files named in it are not opened. Throws ConfigError.
RunConfig loadRunConfig(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                        const std::filesystem::path& mrpt_share);
/// The same from a document already parsed and overridden.
RunConfig runConfigFrom(const YamlDocument& document, const std::filesystem::path& mrpt_share);

/// YAML text with every key and absolute paths; it loads back to an equal struct from anywhere.
std::string resolvedYaml(const RunConfig& config);

/// A commented configuration to start from, with one estimator.
std::string exampleRunConfig();

}  // namespace pos::io
