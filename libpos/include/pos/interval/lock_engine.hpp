#pragma once
/// Lock occupancy for several vehicles: who may drive where, decided event by event. Deterministic: the same
/// events give the same records; time is only what the events' stamps say.
///
/// The rules (docs/math/intervals.md gives the reasons): everybody on a section makes the same movement, so a
/// single lane is run in one direction at a time, by a platoon if there is one; a vehicle is allowed, all at
/// once, every section up to a stop with room for it, and its place in that stop; sections are released
/// behind the rear only, by a believed report, with a margin; nothing is released and nothing granted on a
/// position that is stale, in doubt or alarmed; after a restart nothing is granted until every vehicle has
/// told where it is.

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "pos/interval/lock_events.hpp"
#include "pos/interval/lock_holder.hpp"
#include "pos/interval/lock_rules.hpp"

namespace pos::interval {

/// What the engine believes of one vehicle.
struct VehicleView {
  bool on_road = false;
  bool waiting = false;  ///< has asked to go on
  std::optional<std::size_t> stop =
      {};                  ///< index into its way's stops it may drive to; nothing without a way
  double authority = 0.0;  ///< m along the way, the end of what it holds
  bool believed = false;   ///< its position is fresh, trusted and without alarm
};

class LockEngine {
 public:
  /// Throws ConfigError for rules that make no sense.
  LockEngine(std::shared_ptr<const LockSite> site, const LockRules& rules);
  LockEngine(LockEngine&&) noexcept;
  LockEngine& operator=(LockEngine&&) noexcept;
  ~LockEngine();

  /// Takes one event, in the order of their stamps; returns what it led to, in order. An event that makes no
  /// sense changes nothing and gives one record of kind Rejected.
  std::vector<LockRecord> take(const LockEvent& event);

  const std::vector<LockHolder>& holders(std::size_t section) const;
  /// Indices of lock intervals any part of which is held.
  std::vector<std::size_t> occupiedIntervals() const;
  /// Throws DataError for a vehicle that is not enrolled.
  VehicleView view(VehicleId vehicle) const;
  /// False from a restart until every enrolled vehicle has announced itself or was removed.
  bool proven() const;

 private:
  class Desk;
  std::unique_ptr<Desk> desk_;
};

}  // namespace pos::interval
