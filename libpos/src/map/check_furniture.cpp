#include <algorithm>
#include <cmath>

#include "check_parts.hpp"

namespace pos::map {
namespace {

std::string named(const Anchor& anchor) {
  return "anchor " + std::to_string(anchor.id) + (anchor.name.empty() ? "" : " (" + anchor.name + ")");
}

Findings judged(const Network& network, const Anchor& anchor, const CheckRules& rules) {
  const auto projection = network.project(anchor.p_map);
  if (!projection) return {};
  const Roadway& roadway = network.map().roadways[projection->point.roadway];
  Finding finding{.objects = {"anchor " + std::to_string(anchor.id)}, .p_map = anchor.p_map};
  const std::string place =
      " of roadway " + roadway.id + " at chainage " + metres(projection->point.chainage);
  if (!network.isInside(anchor.p_map, rules.anchor_slack)) {
    finding.check = Check::AnchorOutside;
    finding.what = named(anchor) + " is " + metres(projection->excess) + " outside the cross-section" + place;
    finding.remedy = "look up the survey; check grid, height and sign of the coordinates";
    return {finding};
  }
  const double to_roof = roofHeight(roadway, projection->point.offset) - projection->point.height;
  const double nearest =
      std::min({network.wallDistance(projection->point), to_roof, projection->point.height});
  if (nearest > rules.wall_distance && anchor.wall != Wall::Post) {
    finding.check = Check::AnchorFarFromWall;
    finding.severity = Severity::Warning;
    finding.what =
        named(anchor) + " hangs " + metres(nearest) + " from the nearest wall, roof or floor" + place;
    finding.remedy = "look up the survey, or say wall: post if it stands free";
    return {finding};
  }
  return {};
}

/// A run of samples that see too few anchors.
struct Blind {
  double from = 0.0;
  double to = 0.0;
  std::size_t fewest = 0;
};

Finding blindFinding(const Network& network, RoadwayIndex r, const Blind& blind, int needed) {
  const std::string& id = network.map().roadways[r].id;
  return {.check = Check::FewAnchors,
          .severity = Severity::Warning,
          .what = "from chainage " + metres(blind.from) + " to " + metres(blind.to) + " of roadway " + id +
                  (blind.fewest == 0 ? " no anchor is"
                                     : " only " + std::to_string(blind.fewest) + " anchors are") +
                  " seen, " + std::to_string(needed) + " are asked for",
          .remedy = "add anchors there (pos map plan-anchors proposes places)",
          .objects = {"roadway " + id},
          .p_map = network.centreline(r).at(0.5 * (blind.from + blind.to)).p_map};
}

bool isPassingPlace(const Chamber& chamber) {
  return chamber.kind == Chamber::Kind::Passing && chamber.capacity > 0;
}

/// Of a section, in the order of chainage.
enum class SectionEnd { First, Last };

/// A light at this end of a section for those who enter, or one on a roadway that leads there.
bool hasLight(const Network& network, const GraphEdge& edge, SectionEnd end, double reach) {
  const bool at_start = end == SectionEnd::First;
  const std::string& id = network.map().roadways[edge.roadway].id;
  const double chainage = at_start ? edge.from : edge.to;
  const Eigen::Vector3d p = network.centreline(edge.roadway).at(chainage).p_map;
  const Direction entering = at_start ? Direction::Forward : Direction::Backward;
  const auto& lights = network.map().lights;
  return std::any_of(lights.begin(), lights.end(), [&](const Light& light) {
    if (light.place.roadway == id)
      return light.controls == entering && std::abs(light.place.chainage - chainage) <= reach;
    const Centreline& line = network.centreline(network.indexOf(light.place.roadway));
    return (line.at(light.place.chainage).p_map - p).norm() <= reach;
  });
}

Findings judgedSection(const Network& network, const RoadGraph& graph, const GraphEdge& edge,
                       const CheckRules& rules) {
  Findings found;
  const Roadway& roadway = network.map().roadways[edge.roadway];
  const std::string section = "the locked single lane of roadway " + roadway.id + " from chainage " +
                              metres(edge.from) + " to " + metres(edge.to);
  const auto& chambers = network.map().chambers;
  const bool has_chamber = std::any_of(chambers.begin(), chambers.end(), [&](const Chamber& chamber) {
    return chamber.place.roadway == roadway.id && chamber.place.chainage >= edge.from &&
           chamber.place.chainage <= edge.to && isPassingPlace(chamber);
  });
  const Centreline& line = network.centreline(edge.roadway);
  if (!has_chamber && edge.to - edge.from > rules.section_without_chamber) {
    found.push_back({.check = Check::SectionWithoutChamber,
                     .severity = Severity::Warning,
                     .what = section + " has no passing chamber",
                     .remedy = "add a chamber, or remove locked: true",
                     .objects = {"roadway " + roadway.id},
                     .p_map = line.at(0.5 * (edge.from + edge.to)).p_map});
  }
  for (const SectionEnd end : {SectionEnd::First, SectionEnd::Last}) {
    const GraphNode& node = graph.nodes()[end == SectionEnd::First ? edge.node_from : edge.node_to];
    if (node.kind == GraphNode::Kind::End || hasLight(network, edge, end, rules.light_reach)) continue;
    found.push_back({.check = Check::SectionWithoutLights,
                     .severity = Severity::Warning,
                     .what = section + " has no light for those who enter at " + node.id,
                     .remedy = "add a light within " + metres(rules.light_reach) + " of it",
                     .objects = {"roadway " + roadway.id, node.id},
                     .p_map = node.p_map});
  }
  return found;
}

}  // namespace

Findings anchors(const Network& network, const CheckRules& rules) {
  Findings found;
  const std::vector<Anchor>& all = network.map().anchors;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Findings here = judged(network, all[i], rules);
    found.insert(found.end(), here.begin(), here.end());
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = (all[i].p_map - all[j].p_map).norm();
      if (distance >= rules.coincident) continue;
      found.push_back(
          {.check = Check::AnchorsCoincide,
           .severity = Severity::Error,
           .what = named(all[j]) + " and " + named(all[i]) + " are only " + metres(distance) + " apart",
           .remedy = "look up the survey: two ids for one anchor, or a copied row",
           .objects = {"anchor " + std::to_string(all[j].id), "anchor " + std::to_string(all[i].id)},
           .p_map = all[i].p_map});
    }
  }
  return found;
}

Findings anchorCounts(const Network& network, const CheckRules& rules) {
  Findings found;
  if (!network.map().requirements || network.map().requirements->anchors_visible == 0) return found;
  const Requirements& needed = *network.map().requirements;
  for (RoadwayIndex r = 0; r < network.map().roadways.size(); ++r) {
    const Centreline& line = network.centreline(r);
    const auto steps = static_cast<int>(std::ceil(line.length() / rules.sample_step));
    std::optional<Blind> blind;
    for (int i = 0; i <= steps; ++i) {
      const double chainage = line.chainageStart() + line.length() * i / steps;
      const Eigen::Vector3d tag = network.toMap({r, chainage, 0.0, needed.tag_height});
      const std::size_t seen = network.visibleAnchors(tag, needed.range_limit).size();
      if (seen < static_cast<std::size_t>(needed.anchors_visible)) {
        if (!blind) blind = Blind{chainage, chainage, seen};
        blind->to = chainage;
        blind->fewest = std::min(blind->fewest, seen);
      } else if (blind) {
        found.push_back(blindFinding(network, r, *blind, needed.anchors_visible));
        blind.reset();
      }
    }
    if (blind) found.push_back(blindFinding(network, r, *blind, needed.anchors_visible));
  }
  return found;
}

Findings chambers(const Network& network) {
  Findings found;
  double longest = 0.0;
  if (network.map().requirements) {
    for (const SiteVehicle& vehicle : network.map().requirements->vehicles)
      longest = std::max(longest, vehicle.length);
  }
  for (const Chamber& chamber : network.map().chambers) {
    const Centreline& line = network.centreline(network.indexOf(chamber.place.roadway));
    Finding finding{.objects = {"chamber " + chamber.id}, .p_map = line.at(chamber.place.chainage).p_map};
    if (chamber.capacity == 0) {
      finding.check = Check::NoCapacity;
      finding.what = "chamber " + chamber.id + " has room for no vehicle";
      finding.remedy = "give its capacity, or remove the chamber";
      found.push_back(finding);
    } else if (isPassingPlace(chamber) && chamber.length < longest * chamber.capacity) {
      finding.check = Check::ChamberTooShort;
      finding.severity = Severity::Warning;
      finding.what = "chamber " + chamber.id + " is " + metres(chamber.length) + " long, " +
                     std::to_string(chamber.capacity) + " of the longest vehicle need " +
                     metres(longest * chamber.capacity);
      finding.remedy = "lower its capacity or correct its length";
      found.push_back(finding);
    }
  }
  return found;
}

Findings sections(const Network& network, const RoadGraph& graph, const CheckRules& rules) {
  Findings found;
  for (const GraphEdge& edge : graph.edges()) {
    const Roadway& roadway = network.map().roadways[edge.roadway];
    if (!roadway.locked || roadway.lanes != 1 || roadway.traffic != Traffic::BothWays) continue;
    const Findings here = judgedSection(network, graph, edge, rules);
    found.insert(found.end(), here.begin(), here.end());
  }
  return found;
}

}  // namespace pos::map
