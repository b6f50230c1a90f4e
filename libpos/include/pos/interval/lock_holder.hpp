#pragma once
/// One vehicle's hold on a section.

#include "pos/interval/lock_events.hpp"

namespace pos::interval {

struct LockHolder {
  VehicleId vehicle = 0;
  int movement = 0;  ///< as in WaySection

  bool operator==(const LockHolder&) const = default;
};

}  // namespace pos::interval
