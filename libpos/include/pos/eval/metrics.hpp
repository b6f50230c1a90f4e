#pragma once
/// Every figure of an estimator by its name, for requirements and campaigns.

#include <map>
#include <optional>
#include <string>

#include "pos/eval/run_summary.hpp"

namespace pos::eval {

/// Figures of one estimator by full name, as metrics() gives them.
struct NamedMetrics {
  std::string estimator;
  std::map<std::string, std::optional<double>> values;
};

/// Every figure of an estimator under the name it has in summary.json below `estimators.<name>` (yaw in
/// degrees); nothing where this run gives the figure no value (no truth, no heading in it, ...).
std::map<std::string, std::optional<double>> metrics(const EstimatorSummary& estimator, Duration log_span);

}  // namespace pos::eval
