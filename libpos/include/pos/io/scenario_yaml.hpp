#pragma once
/// Scenarios in YAML: what moves how, in which vehicle, with which sensors, on which map.

#include <filesystem>
#include <string>
#include <vector>

#include "pos/io/options.hpp"
#include "pos/sim/scenario.hpp"

namespace pos::io {

OptionTable<sim::Scenario> scenarioOptions();

/// Reads a scenario. `vehicle` may name a file of its own and change single keys of it:
///   vehicle: {file: ../vehicles/wlr5a.yaml, wheel_radius_m: 0.449}
/// Relative paths, also those of overrides, start at the scenario's folder. The map it names is not opened.
/// Throws ConfigError with the place, in whichever of the two files it lies.
sim::Scenario loadScenario(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                           const std::filesystem::path& mrpt_share);
/// The same from a document already parsed and overridden.
sim::Scenario scenarioFrom(const YamlDocument& document, const std::filesystem::path& mrpt_share);

/// YAML text with every key, the vehicle spelt out and absolute paths; it loads back to an equal scenario
/// from anywhere.
std::string resolvedYaml(const sim::Scenario& scenario);

}  // namespace pos::io
