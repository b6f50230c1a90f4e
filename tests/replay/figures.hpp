#pragma once
/// Figures of replays against tests/replay/expected.csv.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "replay/run_pos.hpp"

namespace pos::replay {

using nlohmann::json;

struct Expected {
  std::string run;  ///< configuration below configs/ without its ending, then what is special about this run
  std::string estimator;
  std::string metric;  ///< path below estimators.<name>; "median", "worst" in front: over several runs
  double low = 0.0;
  double high = 0.0;
  std::string reason;
};

/// The rows of tests/replay/expected.csv.
const std::vector<Expected>& expectedFigures();

/// Runs `pos replay <arguments> --json` and gives the summary; a failed test and null when the run fails.
json replayed(const Bench& bench, std::vector<std::string> arguments);

/// The number at a dotted path; throws when there is none.
double at(const json& object, const std::string& path);

/// Middle value, the lower of the two of an even number.
double median(std::vector<double> values);

/// Checks every row of `run` against the estimators of one or more summaries and prints the figures. A run
/// without rows fails.
void expectFigures(const std::string& run, const std::vector<json>& summaries);

/// Checks one figure that the test has computed itself.
void expectFigure(const std::string& run, const std::string& estimator, const std::string& metric,
                  double value);

}  // namespace pos::replay
