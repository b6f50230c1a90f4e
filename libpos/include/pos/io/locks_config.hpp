#pragma once
/// The configuration of `pos locks`: a map, the rules, and generated traffic or recorded vehicles.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pos/interval/lock_map.hpp"
#include "pos/interval/lock_rules.hpp"
#include "pos/io/options.hpp"
#include "pos/traffic/lock_traffic.hpp"

namespace pos::io {

/// A vehicle whose positions are in a file.
struct LockVehicle {
  std::filesystem::path file = {};  ///< TUM (20 columns) or <estimator>.csv; absolute after loading
  std::string route = {};           ///< of the map; it drives along it
  bool reversed = false;            ///< from its end to its beginning
  double front = 3.0;               ///< m, from the reported point to the front
  double rear = 3.0;                ///< m
  double max_speed = 7.0;           ///< m/s
  int priority = 1;                 ///< 0 goes first

  bool operator==(const LockVehicle&) const = default;
};

struct LocksConfig {
  enum class Ways {
    Ends,    ///< between all open ends and portals
    Routes,  ///< the routes of the map, in both directions
    Both
  };
  /// What the time-distance diagram shows.
  struct Diagram {
    std::optional<std::string> route = {};  ///< absent: the first route, else the longest way
    double from = 0.0;                      ///< s
    double length = 3600.0;                 ///< s

    bool operator==(const Diagram&) const = default;
  };
  int schema = 1;
  std::string name = {};
  std::filesystem::path map = {};  ///< absolute after loading
  std::uint64_t seed = 1;
  int merge = 1;
  interval::LockMapRules sections = {};
  interval::LockRules rules = {};
  Ways ways = Ways::Both;
  std::optional<traffic::TrafficOptions> traffic = {};
  std::vector<LockVehicle> vehicles = {};
  Diagram diagram = {};
};

OptionTable<LocksConfig> locksOptions();

/// Reads it; relative paths start at the file's folder. Throws ConfigError.
LocksConfig loadLocksConfig(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                            const std::filesystem::path& mrpt_share);
/// YAML text with every key.
std::string resolvedYaml(const LocksConfig& config);

}  // namespace pos::io
