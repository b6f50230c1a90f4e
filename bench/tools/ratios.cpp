#include "ratios.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace pos::bench {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& benchmark, const std::string& what) {
  throw std::invalid_argument("benchmark " + benchmark + " has no " + what);
}

double best(const json& run, const std::string& benchmark, const std::string& counter) {
  double least = 0.0;
  for (const json& entry : run.at("benchmarks")) {
    if (entry.contains("aggregate_name") || plainName(entry) != benchmark) continue;
    if (!entry.contains(counter)) refuse(benchmark, "counter " + counter);
    const double value = entry.at(counter);
    least = least == 0.0 ? value : std::min(least, value);
  }
  if (least <= 0.0) refuse(benchmark, "run");
  return least;
}

Ratio ratioOf(const Topic& topic, const Comparison& c, double ours, double theirs) {
  return {c.ours, c.what, topic.yardstick, c.unit, ours, theirs, theirs / ours};
}

bool among(const std::vector<QuickPair>& pairs, const Comparison& c) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const QuickPair& pair) { return pair.ours == c.ours; });
}

}  // namespace

std::vector<QuickPair> quickPairs() {
  return {{"bench_mcl", "ranges_ours"},
          {"bench_mcl", "scan_ours"},
          {"bench_mcl", "predict_ours"},
          {"bench_range_odometry", "increment_ours/calibrated"},
          {"bench_range_odometry", "range_ours/calibrated"},
          {"bench_range_odometry", "range_ours/anchor_offsets"},
          {"bench_sins", "sample_ours/flat"},
          {"bench_sins", "update_ours"},
          {"bench_eskf", "predict_structured"},
          {"bench_eskf", "range_sparse"},
          {"bench_imm", "tick_ours"},
          {"bench_shearer", "shearer_scan_ours"},
          {"bench_legs", "find/whole_row"}};
}

std::vector<Ratio> medianRatios(const json& run, const std::vector<Topic>& topics) {
  std::vector<Ratio> ratios;
  for (const Topic& topic : topics) {
    for (const Comparison& c : topic.comparisons) {
      ratios.push_back(ratioOf(topic, c, aggregate(run, "median", c.ours, c.counter),
                               aggregate(run, "median", c.yardstick, c.counter)));
    }
  }
  return ratios;
}

std::vector<Ratio> bestRatios(const json& run, const std::vector<Topic>& topics,
                              const std::vector<QuickPair>& pairs) {
  std::vector<Ratio> ratios;
  for (const Topic& topic : topics) {
    for (const Comparison& c : topic.comparisons) {
      if (among(pairs, c))
        ratios.push_back(ratioOf(topic, c, best(run, c.ours, c.counter), best(run, c.yardstick, c.counter)));
    }
  }
  if (ratios.size() != pairs.size()) throw std::invalid_argument("a pair to watch is in no topic");
  return ratios;
}

std::string filterOf(const std::vector<Topic>& topics, const std::vector<QuickPair>& pairs) {
  std::string names;
  for (const Topic& topic : topics) {
    for (const Comparison& c : topic.comparisons) {
      if (among(pairs, c)) names += (names.empty() ? "" : "|") + c.ours + "|" + c.yardstick;
    }
  }
  return "^(" + names + ")(/iterations:.*|/repeats:.*|/real_time)?$";
}

}  // namespace pos::bench
