#pragma once
/// From a scenario's entries to sensor streams.

#include <memory>
#include <string>

#include "pos/sim/scenario.hpp"

namespace pos::sim {

/// What the sensors of one run share.
struct SensorSite {
  std::shared_ptr<const Motion> motion;
  std::shared_ptr<const map::TunnelMap> map;
  std::shared_ptr<const Earth> earth;
  std::shared_ptr<const map::OccupancyGrid> grid;  ///< null where the map has none
  std::shared_ptr<const ShearerMotion> shearer;    ///< null for any other motion
  LineOfSight line_of_sight;                       ///< empty: everything is in sight
  Vehicle vehicle;
  RunSetup run;
  double duration = 0.0;  ///< s
};

/// Throws ConfigError where scenario and map do not fit together.
SensorSite sensorSite(const Scenario& scenario, std::shared_ptr<const map::TunnelMap> map,
                      std::uint64_t seed);

/// `key` is the entry's key path, for complaints.
std::unique_ptr<SensorStream> sensorStream(const SensorEntry& entry, const std::string& key,
                                           const SensorSite& site);

}  // namespace pos::sim
