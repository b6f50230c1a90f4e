#pragma once
/// Rules across the keys of a replay configuration; each throws ConfigError. Internal to io.

#include "pos/io/run_config.hpp"

namespace pos::io {

void requireUniqueEstimators(const std::vector<EstimatorEntry>& estimators);
void requireUniqueSensors(const std::vector<SensorConfig>& sensors);
void requireTruthFile(const TruthSource& truth);
void requireOrder(const FaultConfig& faults);
void requireKnownBaseline(const RunConfig& config);
/// Every estimator once in intervals.estimators, and only such as there are.
void requireKnownAids(const RunConfig& config);
/// A run has one input: a recording with its truth, or a scenario that knows its own.
void requireOneInput(const RunConfig& config);

}  // namespace pos::io
