#pragma once
/// What a belief about intervals says. Private to serve.

#include "pos/interval/interval_tracker.hpp"

namespace pos::serve {

/// The roadway is known, or one of several.
bool knowsPlace(const interval::IntervalBelief& belief);
/// That the vehicle is in this interval; 0 where it is not listed.
double probabilityOf(const interval::IntervalBelief& belief, std::size_t interval);

}  // namespace pos::serve
