#pragma once
/// What a belief about intervals says. Private to serve.

#include "pos/serve/state.hpp"

namespace pos::serve {

/// The roadway is known, or one of several.
bool knowsPlace(const interval::IntervalBelief& belief);
/// That the vehicle is in this interval; 0 where it is not listed.
double probabilityOf(const interval::IntervalBelief& belief, std::size_t interval);
/// Of `locks` where they are told, else by the belief.
Occupancy lockState(const interval::IntervalBelief& belief, std::size_t interval,
                    const std::vector<Occupancy>& locks);

}  // namespace pos::serve
