#include "pos/map/tunnel_map.hpp"

#include <cmath>
#include <set>

#include "pos/core/error.hpp"

namespace pos::map {
namespace {

void check(const Anchor& anchor) {
  const std::string key = "anchors[id " + std::to_string(anchor.id) + "]";
  if (!anchor.p_map.allFinite()) {
    throw ConfigError(Complaint{"anchor has a coordinate that is no number",
                                {},
                                key,
                                "",
                                "x_m, y_m, z_m in metres",
                                "look up the anchor in the survey"});
  }
  if (!(anchor.survey_sigma >= 0.0) || !std::isfinite(anchor.survey_sigma)) {
    throw ConfigError(Complaint{"anchor has a bad survey sigma",
                                {},
                                key + ".survey_sigma_m",
                                std::to_string(anchor.survey_sigma),
                                ">= 0 m",
                                ""});
  }
}

void check(const OccupancyGrid& grid) {
  const bool sized =
      grid.columns > 0 && grid.rows > 0 && grid.resolution > 0.0 &&
      grid.occupancy.size() == static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  if (!sized) throw ConfigError(Complaint{"the grid's cells do not match its size", {}, "grid", "", "", ""});
}

}  // namespace

const Anchor* TunnelMap::findAnchor(AnchorId id) const {
  for (const Anchor& anchor : anchors) {
    if (anchor.id == id) return &anchor;
  }
  return nullptr;
}

TunnelMap validated(TunnelMap map) {
  std::set<AnchorId> seen;
  for (const Anchor& anchor : map.anchors) {
    check(anchor);
    if (!seen.insert(anchor.id).second) {
      throw ConfigError(Complaint{"two anchors have the same id",
                                  {},
                                  "anchors",
                                  "id " + std::to_string(anchor.id),
                                  "every id once",
                                  "give one of the two its own id"});
    }
  }
  if (map.grid) check(*map.grid);
  return map;
}

}  // namespace pos::map
