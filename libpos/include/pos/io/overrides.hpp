#pragma once
/// `--set key=value`: values from the command line laid over a configuration file before it is read.

#include <string>
#include <vector>

#include "pos/io/yaml_document.hpp"

namespace pos::io {

/// The document with each "key.path=value" put in place. Items of a list are addressed by index
/// (`estimators[0].range_sigma_m=0.3`) or, where they have a `name`, by that
/// (`estimators.odometry.range_sigma_m=0.3`). Values are YAML. Places of overridden values read "--set
/// key.path=value", so the complaints of the reader (unknown key, wrong unit, out of range) point there.
/// Throws ConfigError for a text that is no assignment, and for an item that the list does not have.
YamlDocument applyOverrides(YamlDocument document, const std::vector<std::string>& overrides);

}  // namespace pos::io
