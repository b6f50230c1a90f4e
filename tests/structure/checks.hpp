#pragma once
/// What the project demands of its own sources, as functions from text to findings.

#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace pos::structure {

/// One fault: the line it stands in (from 1) and what is wrong.
struct Finding {
  int line = 0;
  std::string what;
};
using Findings = std::vector<Finding>;

/// The table of tests/structure/arrows.txt.
struct Arrows {
  std::map<std::string, std::set<std::string>> modules;    ///< module -> modules it may include
  std::map<std::string, std::set<std::string>> libraries;  ///< first header folder -> modules or files
};
/// Throws std::runtime_error on a line that is no `name: names`.
Arrows parsedArrows(std::string_view table);

/// The source with comments blanked; lines keep their numbers.
std::string withoutComments(std::string_view source);

/// Includes that the table forbids to `file` ("core/pose2.hpp", relative to include/pos or src).
Findings forbiddenIncludes(const Arrows& arrows, const std::string& file, std::string_view source);

/// Clocks, console, exits and unseeded randomness in library code.
Findings forbiddenCalls(std::string_view source);

/// Names of sensor readings, which the filters must not know.
Findings sensorNames(std::string_view source);

/// Folders that exist on one developer's machine only.
Findings machinePaths(std::string_view text);

/// Relative links of a markdown text whose target does not exist; `exists` is asked with the link's path
/// part.
Findings brokenLinks(std::string_view markdown, const std::function<bool(const std::string&)>& exists);

}  // namespace pos::structure
