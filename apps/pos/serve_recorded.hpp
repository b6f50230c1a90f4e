#pragma once
/// What a finished run wrote about one estimator.

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "pos/core/estimate.hpp"
#include "pos/core/verdict.hpp"
#include "pos/serve/state.hpp"

namespace pos::app {

using Totals = std::array<std::uint64_t, kVerdicts.size()>;

/// The rows of one estimator.
struct Recorded {
  std::vector<Estimate> estimates;
  std::vector<Totals> totals;  ///< verdicts up to each row
  std::vector<interval::IntervalBelief> places;
};

/// From <estimator>.csv and, where it is there, <estimator>.intervals.csv: of each at most `most` rows,
/// evenly spread. Throws DataError.
Recorded recordedIn(const std::filesystem::path& folder, const std::string& estimator,
                    const serve::Names& names, std::size_t most);

/// The element whose stamp is the last at or before `stamp`, or null.
template <class Element>
const Element* latest(const std::vector<Element>& all, Stamp stamp) {
  const auto after = std::upper_bound(all.begin(), all.end(), stamp,
                                      [](Stamp t, const Element& element) { return t < element.stamp; });
  return after == all.begin() ? nullptr : &*std::prev(after);
}

}  // namespace pos::app
