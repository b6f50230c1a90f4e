#pragma once
/// When the action/observation pairs of a rawlog happened, for truth files that go by index.

#include <string>
#include <vector>

#include "pos/core/stamp.hpp"

namespace pos::io {

struct FrameStamps {
  std::vector<Stamp> stamps = {};  ///< one per pair, in the order of the log
  bool complete = true;            ///< false: the log is damaged, and the pairs after the damage are missing
};

/// The stamps of all pairs; of a damaged log those before the damage. Throws DataError when a pair has no
/// stamp or when there are no pairs.
FrameStamps frameStamps(const std::string& path);

}  // namespace pos::io
