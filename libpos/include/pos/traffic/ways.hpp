#pragma once
/// The ways that traffic drives on a map.

#include <vector>

#include "pos/interval/lock_map.hpp"

namespace pos::traffic {

/// Shortest ways between all open ends and portals, in both directions.
std::vector<interval::Way> waysBetweenEnds(const map::RoadGraph& graph, const interval::LockMap& locks);

/// The map's own routes, in both directions. Throws DataError for one that does not begin and end at an open
/// end or a portal.
std::vector<interval::Way> waysOfRoutes(const map::Network& network, const interval::LockMap& locks);

}  // namespace pos::traffic
