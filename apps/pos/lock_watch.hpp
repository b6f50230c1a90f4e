#pragma once
/// What the lock rules make of the one vehicle that is shown, beside its first estimator.

#include <memory>
#include <string>
#include <vector>

#include "interval_watch.hpp"
#include "lock_driver.hpp"
#include "pos/interval/lock_engine.hpp"
#include "pos/interval/lock_map.hpp"
#include "pos/serve/state.hpp"

namespace pos::app {

/// The vehicle under the lock rules, as if it were the only one.
struct LockedVehicle {
  std::string route = {};  ///< of the map; it drives along it
  bool reversed = false;   ///< from its end to its beginning
  double front = 3.0;      ///< m, from the body's origin to the front
  double rear = 3.0;       ///< m
  double max_speed = 7.0;  ///< m/s
};

/// Everything that does not change while it drives.
class LockedRoute {
 public:
  /// Throws ConfigError for a route that the map does not have, DataError for one that does not lead from an
  /// open end or portal to another.
  LockedRoute(const IntervalGround& ground, const LockedVehicle& vehicle);

  const LockedVehicle& vehicle() const { return vehicle_; }
  const map::Network& network() const { return network_; }
  const std::shared_ptr<const interval::LockSite>& site() const { return site_; }
  std::size_t intervals() const { return intervals_; }
  /// At the beginning of the way.
  LockDriver driver(interval::VehicleId vehicle) const;

 private:
  LockedVehicle vehicle_;
  map::Network network_;
  std::size_t intervals_ = 0;
  std::shared_ptr<const interval::LockSite> site_;
  map::RouteLine line_;
  interval::Way way_;
};

class LockWatch {
 public:
  explicit LockWatch(std::shared_ptr<const LockedRoute> route);

  /// State of every interval after this estimate: held where the engine has locked a part of it, doubtful
  /// while it does not believe the position (stale, in doubt, alarm), free otherwise. Stamps must not
  /// decrease.
  std::vector<serve::Occupancy> take(const Estimate& estimate);

 private:
  void tell(Stamp stamp, const decltype(interval::LockEvent::what)& what);

  std::shared_ptr<const LockedRoute> route_;
  interval::LockEngine engine_;
  LockDriver driver_;
  bool begun_ = false;
  bool placed_ = false;
};

}  // namespace pos::app
