#pragma once
/// How many times faster than its yardstick each hot path is. What a machine that is busy, or clocked down,
/// does to times it mostly does to both sides.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "performance_table.hpp"

namespace pos::bench {

struct Ratio {
  std::string pair;  ///< name of our benchmark, which is one of a pair only
  std::string what;
  std::string yardstick;
  std::string unit;
  double ours = 0.0;
  double theirs = 0.0;
  double ratio = 0.0;  ///< theirs / ours
};

/// Pairs that take a second or two and whose ratio repeats within a few per cent: arithmetic in the cache on
/// both sides, by processor time. Left out is what waits for memory, disk or a second processor.
struct QuickPair {
  std::string program;
  std::string ours;
};
std::vector<QuickPair> quickPairs();

/// The medians of a whole run, in the order of the topics. Throws std::invalid_argument for what is missing.
std::vector<Ratio> medianRatios(const nlohmann::json& run, const std::vector<Topic>& topics);

/// The shortest times of the repetitions of these pairs: what disturbs a repetition only lengthens it. Throws
/// std::invalid_argument for what is missing in the run or the topics.
std::vector<Ratio> bestRatios(const nlohmann::json& run, const std::vector<Topic>& topics,
                              const std::vector<QuickPair>& pairs);

/// Both benchmarks of these pairs, and no other, as --benchmark_filter.
std::string filterOf(const std::vector<Topic>& topics, const std::vector<QuickPair>& pairs);

}  // namespace pos::bench
