#pragma once
/// What the lock engine is told, and what it writes down. Both together are the audit log.

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pos/core/stamp.hpp"
#include "pos/interval/lock_site.hpp"

namespace pos::interval {

/// The fleet's number of a vehicle.
using VehicleId = int;

/// A vehicle of the fleet's register. The engine asks about every one of them after a restart.
struct Enrol {
  VehicleId vehicle = 0;
  double front = 0.0;      ///< m, from the reported point to the front
  double rear = 0.0;       ///< m, from the reported point to the rear
  double max_speed = 0.0;  ///< m/s, what it can do at most
  int priority = 1;        ///< class, 0 goes first (loaded before empty)
};
/// A parked vehicle takes up a way that begins at the depot where it stands. It locks nothing yet.
struct Begin {
  VehicleId vehicle = 0;
  Way way = {};
};
/// The vehicle wants to go on beyond the stop it may drive to now.
struct Request {
  VehicleId vehicle = 0;
};
/// It no longer wants to.
struct Withdraw {
  VehicleId vehicle = 0;
};
/// A position along the vehicle's way.
struct Report {
  enum class Integrity {
    Good,
    Alarm  ///< isolated too long, branch not decided, off the map
  };
  enum class Evidence {
    Estimate,
    Passage  ///< a chamber passage that passed its checks proves the position
  };
  VehicleId vehicle = 0;
  double distance = 0.0;             ///< m along the way
  double sigma = 0.0;                ///< m
  std::optional<double> speed = {};  ///< m/s along the way, from the wheels; makes small jumps visible
  Integrity integrity = Integrity::Good;
  Evidence evidence = Evidence::Estimate;
};
/// A niche or depot on its way, where room is kept for the vehicle, says that the vehicle is in it, off the
/// road.
struct Parked {
  VehicleId vehicle = 0;
  std::size_t stop = 0;  ///< index into the way's stops
};
/// Nothing but time has passed.
struct Tick {};
/// The engine has lost its memory, all but the register.
struct Restart {};
/// After a restart a vehicle tells what it had been allowed: its way and the stop it may drive to. A vehicle
/// that is off the road and has no way sends an empty one.
struct Announce {
  VehicleId vehicle = 0;
  Way way = {};
  std::size_t stop = 0;     ///< index into way.stops
  double rear_limit = 0.0;  ///< m along the way; nothing of the vehicle is behind it
  bool parked = false;      ///< off the road, in that stop
};
/// A person decides what the engine cannot know.
struct Override {
  enum class Action {
    Remove,  ///< the vehicle is off the road: free all that it holds
    Trust    ///< the vehicle's next report may be believed
  };
  Action action = Action::Remove;
  VehicleId vehicle = 0;
  std::string who = {};
  std::string why = {};
};

struct LockEvent {
  Stamp stamp = {};
  std::variant<Enrol, Begin, Request, Withdraw, Report, Parked, Tick, Restart, Announce, Override> what =
      Tick{};
};

/// One line of what the engine decided.
struct LockRecord {
  enum class Kind {
    Granted,   ///< the vehicle may drive to `stop`
    Refused,   ///< it may not yet; `reason`, `other` is in its way (or -1)
    Locked,    ///< it holds `section`, with `movement`
    Released,  ///< it no longer does
    SlotTaken,
    SlotFreed,
    Stale,    ///< no report for too long: what it holds stays held
    Doubted,  ///< its reports contradict each other or themselves
    Trusted,  ///< they can be believed again
    Alarmed,
    AlarmOver,
    Trespass,  ///< it is certainly where it was not allowed; the section is locked all the same
    Proven,    ///< after a restart: every vehicle is accounted for
    Restarted,
    Overridden,
    Rejected  ///< the event itself makes no sense; nothing was changed
  };
  Stamp stamp = {};
  Kind kind = Kind::Refused;
  VehicleId vehicle = -1;
  VehicleId other = -1;
  std::size_t section = 0;
  std::size_t stop = 0;
  int movement = 0;
  std::string reason = {};
};
std::string_view name(LockRecord::Kind kind);

}  // namespace pos::interval
