#pragma once
/// When the truth of a simulation passes from one zone of a receiver to the next.

#include <vector>

#include "pos/sim/scenario.hpp"
#include "pos/sim/simulation.hpp"

namespace pos::sim {

/// Moments, upward, at which the satellite receivers or the radios of the scenario change zone, to 0.1 ms.
/// A zone that is entered and left again within 50 ms may be missed.
std::vector<Stamp> zoneChanges(const Scenario& scenario, const Simulation& simulation);

}  // namespace pos::sim
