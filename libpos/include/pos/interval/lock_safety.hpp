#pragma once
/// Whether everybody can still get home: the banker's question (Dijkstra 1965) for roads.

#include <vector>

#include "pos/interval/lock_site.hpp"

namespace pos::interval {

/// A vehicle at the stop that it has been allowed to drive to.
struct Settled {
  const Way* way = nullptr;
  std::size_t stop = 0;      ///< index into way->stops
  double still_to_go = 0.0;  ///< m to that stop; who has less is in front ...
  double spread = 0.0;  ///< m, ... if the difference is beyond both vehicles' spreads, else either may be
};

/// True when there is an order in which one vehicle after the other can drive to the end of its way without
/// being stuck behind another one that waits on the road. Vehicles in niches and depots are in nobody's way,
/// and the room at the stops in between is not needed by a vehicle that drives through; so while no
/// stop is on the road the answer is always yes. O(n^3 stops) at worst.
bool everybodyCanFinish(const LockSite& site, const std::vector<Settled>& vehicles);

}  // namespace pos::interval
