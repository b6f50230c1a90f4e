#pragma once
/// A map made ready for locks, and what drives on it.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pos/interval/lock_map.hpp"
#include "pos/io/lock_log.hpp"
#include "pos/io/locks_config.hpp"
#include "pos/map/network.hpp"
#include "pos/report/time_distance.hpp"
#include "pos/traffic/lock_traffic.hpp"

namespace pos::app {

/// Map, sections and ways of a configuration. Throws ConfigError or DataError for a map that cannot be used.
class LockYard {
 public:
  explicit LockYard(const io::LocksConfig& config);

  io::LockScene scene() const;
  const map::Network& network() const { return network_; }
  const std::vector<map::LockInterval>& intervals() const { return intervals_; }
  const interval::LockMap& locks() const { return locks_; }
  const std::vector<interval::Way>& ways() const { return ways_; }
  /// The way along a route of the map; ConfigError with a suggestion for one that there is not.
  map::RouteLine route(const std::string& id) const;

 private:
  map::Network network_;
  map::RoadGraph graph_;
  std::vector<map::LockInterval> intervals_;
  interval::LockMap locks_;
  interval::LockRules rules_;
  std::vector<interval::Way> ways_;
};

/// Recorded vehicles under the locks: they ask ahead, and drive whatever the answer is. The audit judges.
/// Opposing bodies are not counted, for there is no truth.
traffic::TrafficResult runRecorded(const LockYard& yard, const io::LocksConfig& config,
                                   const traffic::TrafficWatch& watch);

/// Gathers the time-distance diagram along one way while the locks run.
class LockDiagram {
 public:
  LockDiagram(const LockYard& yard, const io::LocksConfig& config);

  void take(const interval::LockEvent& event, const std::vector<interval::LockRecord>& records);
  void take(double t, const std::vector<traffic::TruePlace>& places);
  report::TimeDistance finish();

 private:
  struct Held {
    std::size_t index = 0;  ///< of the way's sections
    interval::VehicleId vehicle = 0;
    int movement = 0;
    double since = 0.0;
  };
  void end(std::vector<Held>::iterator held, double t);
  std::vector<report::DistanceBand> bands() const;
  double onAxis(const traffic::TruePlace& place) const;

  const LockYard& yard_;
  interval::Way way_;
  std::shared_ptr<const interval::LockSite> site_;
  report::TimeDistance diagram_;
  std::vector<Held> held_;
  double t_ = 0.0;
};

}  // namespace pos::app
