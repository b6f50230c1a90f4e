#pragma once
/// Strict reading of YAML nodes for the import mapping. Internal to the import; includes yaml-cpp.

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pos/core/error.hpp"
#include "pos/core/stamp.hpp"

namespace pos::io::mapping_yaml {

using Keys = std::vector<std::string>;

/// A node of the mapping with what a complaint about it needs.
struct Entry {
  YAML::Node node;
  std::string path;
  std::string file;
};

FilePlace placeOf(const YAML::Mark& mark, const std::string& file);
/// Throws a ConfigError about the entry.
[[noreturn]] void refuse(const Entry& at, const std::string& what, const std::string& expected,
                         const std::string& suggestion = {});

Entry childOf(const Entry& at, const std::string& key, const YAML::Node& node);
/// Refuses anything but a map whose keys are among `allowed`, each once.
void requireKeys(const Entry& at, const Keys& allowed);
std::optional<Entry> find(const Entry& at, const std::string& key);
/// As above; a missing key is a ConfigError.
Entry need(const Entry& at, const std::string& key, const std::string& expected);
/// The entries of a list.
std::vector<Entry> listOf(const Entry& at);

std::string textOf(const Entry& at, const std::string& expected);
double numberOf(const Entry& at, const std::string& expected);
std::int32_t idOf(const Entry& at);
/// Seconds, within +-`limit`.
Duration secondsOf(const Entry& at, Duration limit, const std::string& expected);

}  // namespace pos::io::mapping_yaml
