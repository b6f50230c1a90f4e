#pragma once
/// Which settings of a replay go together. Each throws ConfigError with the key relative to its struct.

#include "pos/io/run_config.hpp"

namespace pos::io {

void requireTruthFile(const TruthSource& truth);
void requireOrder(const FaultConfig& faults);
void requireWindow(const WindowConfig& window);
/// Names that occur once, one input, a baseline that is there; nothing of what the inner tables check.
void requireWhole(const RunConfig& config);

}  // namespace pos::io
