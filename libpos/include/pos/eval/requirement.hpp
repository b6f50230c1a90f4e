#pragma once
/// `--require 'p95_xy<1.0'`: a limit that a run must keep.

#include <string>
#include <vector>

#include "pos/eval/metrics.hpp"

namespace pos::eval {

enum class Relation { Less, LessOrEqual, Greater, GreaterOrEqual };

struct Requirement {
  std::string text;       ///< as written
  std::string estimator;  ///< empty: every estimator of the run
  std::string metric;     ///< full name: "errors.xy.p95"
  Relation relation = Relation::Less;
  double limit = 0.0;
};

/// The outcome for one estimator.
struct RequirementResult {
  bool passed = false;
  std::string line;  ///< "pass  range_odometry: errors.xy.p95 = 0.412 < 1"
};

/// The requirement is on a figure of one sensor, window or switch. Which of these there are is known after
/// the run only, so that it cannot be checked for mistyped names before.
bool isOfASensor(const std::string& text);

/// Reads `[estimator.]metric(<|<=|>|>=)number`. The metric is a path of summary.json ("errors.xy.p95", with
/// or without "errors."), or a short form: "p95_xy", "rmse_yaw", "nees_xy_mean", "real_time_factor".
/// UsageError, with the nearest name, for a metric or estimator this run does not know.
Requirement parseRequirement(const std::string& text, const RunSummary& run);
/// The same for figures from elsewhere.
Requirement parseRequirement(const std::string& text, const std::vector<NamedMetrics>& estimators);

/// One result per estimator meant. A figure without a value misses the requirement.
std::vector<RequirementResult> check(const Requirement& requirement, const RunSummary& run);
std::vector<RequirementResult> check(const Requirement& requirement,
                                     const std::vector<NamedMetrics>& estimators);

}  // namespace pos::eval
