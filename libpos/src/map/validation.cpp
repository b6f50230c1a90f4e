#include <cmath>
#include <initializer_list>
#include <set>

#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::map {
namespace {

/// Points nearer in plan than this have no direction between them, m.
constexpr double kShortestSegment = 1e-4;
/// An arc that goes farther round is two arcs.
constexpr double kLongestArc = radians(355.0);

bool isDate(const std::string& text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return false;
  for (const std::size_t i : {0U, 1U, 2U, 3U, 5U, 6U, 8U, 9U}) {
    if (text[i] < '0' || text[i] > '9') return false;
  }
  const int month = std::stoi(text.substr(5, 2));
  const int day = std::stoi(text.substr(8, 2));
  return month >= 1 && month <= 12 && day >= 1 && day <= 31;
}

void check(const Anchor& anchor, const std::string& key) {
  const std::string owner = "anchor " + std::to_string(anchor.id);
  if (!anchor.p_map.allFinite()) {
    refuse("anchor has a coordinate that is no number", key, "", "x_m, y_m, z_m in metres",
           "look up the anchor in the survey");
  }
  requireNotNegative(anchor.survey_sigma, key + ".survey_sigma_m", "m", owner);
  requireFinite(anchor.range_bias, key + ".range_bias_m", "m", owner);
  requireNotNegative(anchor.antenna_delay, key + ".antenna_delay_s", "s", owner);
  if (!anchor.survey_date.empty() && !isDate(anchor.survey_date)) {
    refuse("anchor has a survey date that is none", key + ".survey_date", anchor.survey_date, "YYYY-MM-DD");
  }
}

void checkAnchors(const TunnelMap& map) {
  std::set<AnchorId> seen;
  for (std::size_t i = 0; i < map.anchors.size(); ++i) {
    const Anchor& anchor = map.anchors[i];
    check(anchor, indexed("anchors", i));
    if (!seen.insert(anchor.id).second) {
      refuse("two anchors have the same id", indexed("anchors", i) + ".id", "id " + std::to_string(anchor.id),
             "every id once", "give one of the two its own id");
    }
  }
}

void check(const OccupancyGrid& grid) {
  const auto cells = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  if (grid.columns <= 0 || grid.rows <= 0 || !(grid.resolution > 0.0) || grid.occupancy.size() != cells) {
    refuse("the grid's cells do not match its size", "grid", "", "");
  }
}

template <class Object>
void requireIds(const std::vector<Object>& objects, const char* list) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const std::string key = indexed(list, i) + ".id";
    if (objects[i].id.empty()) refuse("an id is missing", key, "", "a word that stays the same");
    if (seen.insert(objects[i].id).second) continue;
    refuse("two objects of one kind have the same id", key, objects[i].id, "every id once",
           "give one of the two its own id");
  }
}

void checkCentreline(const Roadway& roadway, const std::string& key) {
  const std::string owner = "roadway " + roadway.id;
  if (roadway.centreline.size() < 2) {
    refuse(owner + " has no centreline", key, std::to_string(roadway.centreline.size()) + " points",
           "at least two points");
  }
  for (std::size_t i = 0; i < roadway.centreline.size(); ++i) {
    const CentrelinePoint& point = roadway.centreline[i];
    const std::string point_key = indexed(key, i);
    if (!point.p_map.allFinite()) refuse(owner + " has a coordinate that is no number", point_key, "", "m");
    if (!(std::abs(point.arc) <= kLongestArc)) {
      refuse(owner + " has an arc that goes too far round", point_key + ".arc_deg",
             std::to_string(degrees(point.arc)), "-355 to 355 deg", "make two arcs of it");
    }
    if (i > 0 && !((point.p_map - roadway.centreline[i - 1].p_map).head<2>().norm() >= kShortestSegment)) {
      refuse(owner + " has two points at the same place in plan", point_key,
             std::to_string(point.p_map.x()) + ", " + std::to_string(point.p_map.y()),
             "points with some way between them", "remove one of the two; a vertical shaft is no roadway");
    }
  }
}

void check(const Roadway& roadway, const std::string& key) {
  const std::string owner = "roadway " + roadway.id;
  checkCentreline(roadway, key + ".centreline");
  requireFinite(roadway.chainage_start, key + ".chainage_start_m", "m", owner);
  requirePositive(roadway.width, key + ".width_m", "m", owner);
  requirePositive(roadway.height, key + ".height_m", "m", owner);
  if (roadway.speed_limit) requirePositive(*roadway.speed_limit, key + ".speed_limit_m_per_s", "m/s", owner);
  if (roadway.section == Section::Arch && roadway.height < 0.5 * roadway.width) {
    refuse(owner + " is an arch lower than its semicircle", key + ".height_m", std::to_string(roadway.height),
           "at least half the width", "make it a rectangle, or correct width and height");
  }
  if (roadway.lanes != 1 && roadway.lanes != 2) {
    refuse(owner + " has a number of lanes that cannot be", key + ".lanes", std::to_string(roadway.lanes),
           "1 or 2");
  }
  if (roadway.lanes == 2 && roadway.traffic != Traffic::BothWays) {
    refuse(owner + " has two lanes and goes one way", key + ".traffic", "one way", "both_ways",
           "a one-way roadway has one lane here");
  }
}

/// Checks that need to know which roadways there are.
class References {
 public:
  explicit References(const TunnelMap& map) {
    for (const Roadway& roadway : map.roadways) known_.insert(roadway.id);
  }

  void check(const RoadwayPlace& place, const std::string& key, const char* chainage = ".chainage_m") const {
    requireKnown(place.roadway, key);
    requireFinite(place.chainage, key + chainage, "m", "the object");
  }
  void check(const RoadwayStretch& stretch, const std::string& key) const {
    requireKnown(stretch.roadway, key);
    requireFinite(stretch.from, key + ".from_m", "m", "the stretch");
    requireFinite(stretch.to, key + ".to_m", "m", "the stretch");
  }
  void checkOrdered(const RoadwayStretch& stretch, const std::string& key) const {
    check(stretch, key);
    if (stretch.from <= stretch.to) return;
    refuse("the stretch ends before it begins", key + ".to_m", std::to_string(stretch.to),
           ">= " + std::to_string(stretch.from));
  }

 private:
  void requireKnown(const std::string& roadway, const std::string& key) const {
    if (known_.count(roadway) > 0) return;
    std::string ids;
    for (const std::string& id : known_) ids += (ids.empty() ? "one of: " : ", ") + id;
    refuse("there is no such roadway", key + ".roadway", roadway, ids.size() < 300 ? ids : "a roadway's id");
  }
  std::set<std::string> known_;
};

void check(const Chamber& chamber, const std::string& key) {
  const std::string owner = "chamber " + chamber.id;
  requireNotNegative(chamber.length, key + ".length_m", "m", owner);
  requireNotNegative(chamber.depth, key + ".depth_m", "m", owner);
  requirePositive(chamber.detection_sigma, key + ".detection_sigma_m", "m", owner);
  if (chamber.capacity < 0) {
    refuse(owner + " has a negative capacity", key + ".capacity", std::to_string(chamber.capacity), ">= 0");
  }
}

void check(const Portal& portal, const std::string& key) {
  requireFinite(portal.handover_from, key + ".handover_from_m", "m", "portal " + portal.id);
  requireFinite(portal.handover_to, key + ".handover_to_m", "m", "portal " + portal.id);
  if (portal.handover_from <= portal.handover_to) return;
  refuse("portal " + portal.id + ": the hand-over zone ends before it begins", key + ".handover_to_m",
         std::to_string(portal.handover_to), ">= " + std::to_string(portal.handover_from));
}

void check(const StopLine& line, const TunnelMap& map, const std::string& key) {
  if (line.light.empty()) return;
  for (const Light& light : map.lights) {
    if (light.id == line.light) return;
  }
  refuse("there is no such light", key + ".light", line.light, "a light's id");
}

void check(const RestrictedZone& zone, const std::string& key) {
  const bool limits = zone.kind == RestrictedZone::Kind::SpeedLimit;
  if (limits != zone.speed_limit.has_value()) {
    refuse("zone " + zone.id + (limits ? " limits the speed to nothing" : " has a speed limit it cannot use"),
           key + ".speed_limit_m_per_s", "", limits ? "a speed" : "no speed, or kind: speed_limit");
  }
  if (zone.speed_limit)
    requirePositive(*zone.speed_limit, key + ".speed_limit_m_per_s", "m/s", "zone " + zone.id);
}

template <class Object, class Check>
void checkEach(const std::vector<Object>& objects, const char* list, Check check) {
  requireIds(objects, list);
  for (std::size_t i = 0; i < objects.size(); ++i) check(objects[i], indexed(list, i));
}

void checkJunctions(const TunnelMap& map, const References& references) {
  checkEach(map.junctions, "junctions", [&](const Junction& junction, const std::string& key) {
    if (junction.places.size() < 2) {
      refuse("junction " + junction.id + " joins nothing", key + ".places",
             std::to_string(junction.places.size()) + " places", "at least two");
    }
    for (std::size_t i = 0; i < junction.places.size(); ++i) {
      references.check(junction.places[i], indexed(key + ".places", i));
    }
  });
}

void checkFurniture(const TunnelMap& map, const References& references) {
  checkEach(map.crossings, "crossings", [&](const Crossing& crossing, const std::string& key) {
    references.check(crossing.upper, key + ".upper");
    references.check(crossing.lower, key + ".lower");
  });
  checkEach(map.bends, "bends",
            [&](const Bend& bend, const std::string& key) { references.checkOrdered(bend.stretch, key); });
  checkEach(map.chambers, "chambers", [&](const Chamber& chamber, const std::string& key) {
    references.check(chamber.place, key);
    check(chamber, key);
  });
  checkEach(map.portals, "portals", [&](const Portal& portal, const std::string& key) {
    references.check(portal.place, key);
    check(portal, key);
  });
  checkEach(map.lights, "lights",
            [&](const Light& light, const std::string& key) { references.check(light.place, key); });
  checkEach(map.stop_lines, "stop_lines", [&](const StopLine& line, const std::string& key) {
    references.check(line.place, key);
    check(line, map, key);
  });
  checkEach(map.zones, "zones", [&](const RestrictedZone& zone, const std::string& key) {
    references.checkOrdered(zone.stretch, key);
    check(zone, key);
  });
  checkEach(map.routes, "routes", [&](const Route& route, const std::string& key) {
    if (route.legs.empty()) refuse("route " + route.id + " goes nowhere", key + ".legs", "", "legs");
    for (std::size_t i = 0; i < route.legs.size(); ++i) {
      references.check(route.legs[i], indexed(key + ".legs", i));
    }
  });
}

void check(const Requirements& requirements) {
  const std::string key = "requirements";
  if (requirements.anchors_visible < 0) {
    refuse("a negative number of anchors is asked for", key + ".anchors_visible",
           std::to_string(requirements.anchors_visible), ">= 0");
  }
  requirePositive(requirements.range_limit, key + ".range_limit_m", "m", "the radio");
  requireNotNegative(requirements.tag_height, key + ".tag_height_m", "m", "the tag");
  checkEach(requirements.vehicles, "requirements.vehicles",
            [](const SiteVehicle& vehicle, const std::string& at) {
              requirePositive(vehicle.width, at + ".width_m", "m", "vehicle " + vehicle.id);
              requirePositive(vehicle.height, at + ".height_m", "m", "vehicle " + vehicle.id);
              requirePositive(vehicle.length, at + ".length_m", "m", "vehicle " + vehicle.id);
            });
}

}  // namespace

TunnelMap validated(TunnelMap map) {
  checkAnchors(map);
  if (map.grid) check(*map.grid);
  checkEach(map.roadways, "roadways",
            [](const Roadway& roadway, const std::string& key) { check(roadway, key); });
  const References references(map);
  checkJunctions(map, references);
  checkFurniture(map, references);
  if (map.requirements) check(*map.requirements);
  if (map.background && map.background->control_points.size() < 3) {
    refuse("the background has too few control points", "background.control_points",
           std::to_string(map.background->control_points.size()), "at least three, not on one line");
  }
  return map;
}

}  // namespace pos::map
