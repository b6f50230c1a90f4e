#include "run_rules.hpp"

#include <algorithm>

#include "pos/core/config_checks.hpp"
#include "pos/io/text.hpp"

namespace pos::io {
namespace {

bool fitsFileName(const std::string& name) {
  return !name.empty() && name.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                              "0123456789_-") == std::string::npos;
}

void requireUniqueEstimators(const std::vector<EstimatorEntry>& estimators) {
  if (estimators.empty()) {
    refuse("there is no estimator to run", "estimators", "an empty list",
           "at least one item with name and type");
  }
  for (std::size_t i = 0; i < estimators.size(); ++i) {
    const std::string& name = estimators[i].name;
    const std::string key = indexed("estimators", i) + ".name";
    if (!fitsFileName(name)) {
      refuse("the name does not fit a file name", key, name, "letters, digits, _ and - only");
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (estimators[j].name != name) continue;
      refuse("two estimators have the same name", key, name, "every name once",
             "estimators[" + std::to_string(j) + "] has it already; rename one of the two");
    }
  }
}

void requireUniqueSensors(const std::vector<SensorConfig>& sensors) {
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (sensors[j].sensor != sensors[i].sensor) continue;
      refuse("a sensor is listed twice", indexed("sensors", i) + ".sensor", sensors[i].sensor,
             "every sensor once", "sensors[" + std::to_string(j) + "] names it already; join the two");
    }
  }
}

void requireKnownBaseline(const RunConfig& config) {
  if (!config.campaign.baseline) return;
  std::vector<std::string> names;
  for (const EstimatorEntry& entry : config.estimators) names.push_back(entry.name);
  if (std::find(names.begin(), names.end(), *config.campaign.baseline) != names.end()) return;
  refuse("the baseline is none of the estimators", "campaign.baseline", *config.campaign.baseline,
         "one of: " + text::joined(names));
}

/// Every estimator once in intervals.estimators, and only such as there are.
void requireKnownAids(const RunConfig& config) {
  if (!config.intervals) return;
  std::vector<std::string> names;
  for (const EstimatorEntry& entry : config.estimators) names.push_back(entry.name);
  std::vector<std::string> seen;
  for (const IntervalAid& aid : config.intervals->estimators) {
    const std::string key = indexed("intervals.estimators", seen.size()) + ".estimator";
    if (std::find(names.begin(), names.end(), aid.estimator) == names.end())
      refuse("the run has no such estimator", key, aid.estimator, "one of: " + text::joined(names));
    if (std::find(seen.begin(), seen.end(), aid.estimator) != seen.end())
      refuse("an estimator is listed twice", key, aid.estimator, "every estimator once");
    seen.push_back(aid.estimator);
  }
}

/// A run has one input: a recording with its truth, or a scenario that knows its own.
void requireOneInput(const RunConfig& config) {
  if (!config.scenario) return;
  if (config.log) {
    refuse("the run has a recording and a scenario", "scenario", config.scenario->file.string(),
           "either log or scenario");
  }
  if (config.truth) {
    refuse("the run has a scenario and a truth of its own", "truth", "a table",
           "no truth; the scenario knows it", "remove truth");
  }
}

}  // namespace

void requireTruthFile(const TruthSource& truth) {
  if (truth.format == TruthSource::Format::Log && truth.file) {
    refuse("the truth is to come from the log, yet a file is named", "file", truth.file->string(),
           "no file with format: log");
  }
  if (truth.format != TruthSource::Format::Log && !truth.file) {
    refuse("the truth has no file", "file", "", "a path, unless format: log");
  }
}

void requireWindow(const WindowConfig& window) {
  if (!fitsFileName(window.name))
    refuse("the name does not fit a figure", "name", window.name, "letters, digits, _ and - only");
  if (window.to <= window.from)
    refuse("the window ends before it begins", "to_s", std::to_string(window.to), "more than from_s");
}

void requireOrder(const FaultConfig& faults) {
  if (faults.range_outlier_min > faults.range_outlier_max) {
    refuse("the smallest outlier exceeds the largest", "range_outlier_min_m",
           std::to_string(faults.range_outlier_min),
           "at most range_outlier_max_m = " + std::to_string(faults.range_outlier_max));
  }
}

void requireWhole(const RunConfig& config) {
  requireUniqueEstimators(config.estimators);
  requireUniqueSensors(config.sensors);
  requireOneInput(config);
  requireKnownBaseline(config);
  requireKnownAids(config);
}

RunConfig validated(RunConfig config) {
  requireWhole(config);
  if (config.truth) under("truth", [&] { requireTruthFile(*config.truth); });
  under("faults", [&] { requireOrder(config.faults); });
  for (std::size_t i = 0; i < config.estimators.size(); ++i) {
    under("estimators[" + std::to_string(i) + "]", [&] { (void)validated(config.estimators[i].config); });
  }
  return config;
}

}  // namespace pos::io
