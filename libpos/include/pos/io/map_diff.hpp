#pragma once
/// What changed from one version of a map to the next, object by object and key by key.

#include <string>
#include <vector>

#include "pos/io/map_yaml.hpp"

namespace pos::io {

struct MapChange {
  enum class Kind { Added, Removed, Changed };
  Kind kind = Kind::Changed;
  std::string object = {};  ///< "anchor 12", "roadway R1", "map"
  std::string key = {};     ///< "width_m"; empty for a whole object
  std::string before = {};  ///< as written in the file; empty where there was nothing
  std::string after = {};   ///< the same
  std::string words = {};   ///< one sentence without full stop
};

/// Every difference between the canonical texts; objects are told by their ids, so their order does not
/// matter. Empty exactly when the maps are equal but for that order.
std::vector<MapChange> mapChanges(const MapFile& before, const MapFile& after);

}  // namespace pos::io
