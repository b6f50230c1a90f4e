#include "pos/map/tunnel_map.hpp"

#include <cmath>
#include <set>

#include "pos/core/error.hpp"

namespace pos::map {
namespace {

void check(const Anchor& anchor) {
  const std::string key = "anchors[id " + std::to_string(anchor.id) + "]";
  if (!anchor.p_map.allFinite()) {
    throw ConfigError(Complaint{.what = "anchor has a coordinate that is no number",
                                .key = key,
                                .expected = "x_m, y_m, z_m in metres",
                                .suggestion = "look up the anchor in the survey"});
  }
  if (!(anchor.survey_sigma >= 0.0) || !std::isfinite(anchor.survey_sigma)) {
    throw ConfigError(Complaint{.what = "anchor has a bad survey sigma",
                                .key = key + ".survey_sigma_m",
                                .got = std::to_string(anchor.survey_sigma),
                                .expected = ">= 0 m"});
  }
}

void check(const OccupancyGrid& grid) {
  const auto cells = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  if (grid.columns <= 0 || grid.rows <= 0 || !(grid.resolution > 0.0) || grid.occupancy.size() != cells) {
    throw ConfigError(Complaint{.what = "the grid's cells do not match its size", .key = "grid"});
  }
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
      throw ConfigError(Complaint{.what = "two anchors have the same id",
                                  .key = "anchors",
                                  .got = "id " + std::to_string(anchor.id),
                                  .expected = "every id once",
                                  .suggestion = "give one of the two its own id"});
    }
  }
  if (map.grid) check(*map.grid);
  return map;
}

}  // namespace pos::map
