#pragma once
/// Tables of docs/performance.md from what the benchmark programs print (`--benchmark_format=json`).

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pos::bench {

/// One row: a benchmark of ours beside its yardstick, both as the median of the repetitions.
struct Comparison {
  std::string what;
  std::string ours;
  std::string yardstick;
  std::string counter;        ///< compared; "cpu_time" for the whole benchmark
  std::string unit;           ///< shown: "ns", "ms"
  double least_factor = 0.0;  ///< what yardstick / ours should reach; 0 = no target
};

/// One benchmark without a yardstick: the median over its repetitions, of memory the largest.
struct Figure {
  std::string what;
  std::string benchmark;
  std::string counter;
  std::string unit;
};

struct Topic {
  std::string title;
  std::string yardstick;  ///< who it is
  std::vector<Comparison> comparisons;
  std::vector<Figure> figures;
};

/// What is compared with what in this project.
std::vector<Topic> topics();

/// What a benchmark program wrote. It writes NaN and Infinity, which JSON does not have, for statistics that
/// do not exist (the coefficient of variation of zeros); they become null.
nlohmann::json parsed(const std::string& text);

/// The runs joined: their benchmarks in order, the context of the first. Throws std::invalid_argument when
/// one holds no benchmarks.
nlohmann::json joined(const std::vector<nlohmann::json>& runs);

/// The benchmark's name without what its repetition added: "read_ours/iterations:1" is "read_ours".
std::string plainName(const nlohmann::json& entry);

/// A statistic over the repetitions ("median", "max") of a benchmark's counter. Throws std::invalid_argument
/// naming what is missing.
double aggregate(const nlohmann::json& run, const std::string& statistic, const std::string& benchmark,
                 const std::string& counter);

/// "2 CPUs at 4500 MHz, ...": the machine and the load, without its name.
std::string machineLine(const nlohmann::json& run);

/// One Markdown table per topic. Throws std::invalid_argument naming a benchmark or counter that is missing.
std::string tables(const nlohmann::json& run, const std::vector<Topic>& topics);

}  // namespace pos::bench
