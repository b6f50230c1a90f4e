#pragma once
/// Numbers of the lock rules (spec A section 6.6 and the field's rules; docs/math/intervals.md).

#include "pos/core/stamp.hpp"

namespace pos::interval {

struct LockRules {
  double footprint_sigmas = 3.0;  ///< the footprint is the body widened by this many sigmas at both ends
  double release_sigmas = 2.0;    ///< hysteresis of a release: this many sigmas more ...
  double release_margin = 2.0;    ///< m, ... and this
  double stale_after = 5.0;       ///< s without a report after which a position is stale
  double steady_for = 10.0;       ///< s of steady reports before a position is believed again after a gap
  double jump_sigmas = 3.0;       ///< a report off the dead reckoning by more than this many sigmas is a jump
  double speed_error = 0.5;       ///< m/s, how wrong a told speed may be
  double jump_slack = 30.0;       ///< m of dead-reckoning error beyond which only a passage ends a doubt
  double gap_between = 2.0;       ///< m, between vehicles that wait in one place
  double patience = 120.0;        ///< s of waiting after which nobody of equal rank is admitted against one
  double aging = 600.0;           ///< s of waiting that raise a vehicle by one priority class
};
/// The rules themselves; throws ConfigError for a number that is none, is negative or makes no sense.
LockRules validated(LockRules rules);

}  // namespace pos::interval
