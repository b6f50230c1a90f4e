#include <algorithm>
#include <cmath>
#include <limits>

#include "check_parts.hpp"

namespace pos::map {
namespace {

Eigen::Vector3d floorAt(const Network& network, const RoadwayPlace& place) {
  return network.centreline(network.indexOf(place.roadway)).at(place.chainage).p_map;
}

/// Every chainage that some object names, with the object's name.
struct NamedPlace {
  std::string object;
  RoadwayPlace place;
};
std::vector<NamedPlace> namedPlaces(const TunnelMap& map) {
  std::vector<NamedPlace> all;
  const auto stretch = [&all](const std::string& object, const RoadwayStretch& s) {
    all.push_back({object, {s.roadway, s.from}});
    all.push_back({object, {s.roadway, s.to}});
  };
  for (const Junction& junction : map.junctions) {
    for (const RoadwayPlace& place : junction.places) all.push_back({"junction " + junction.id, place});
  }
  for (const Crossing& crossing : map.crossings) {
    all.push_back({"crossing " + crossing.id, crossing.upper});
    all.push_back({"crossing " + crossing.id, crossing.lower});
  }
  for (const Bend& bend : map.bends) stretch("bend " + bend.id, bend.stretch);
  for (const Chamber& chamber : map.chambers) all.push_back({"chamber " + chamber.id, chamber.place});
  for (const Portal& portal : map.portals) {
    all.push_back({"portal " + portal.id, portal.place});
    stretch("portal " + portal.id, {portal.place.roadway, portal.handover_from, portal.handover_to});
  }
  for (const Light& light : map.lights) all.push_back({"light " + light.id, light.place});
  for (const StopLine& line : map.stop_lines) all.push_back({"stop line " + line.id, line.place});
  for (const RestrictedZone& zone : map.zones) stretch("zone " + zone.id, zone.stretch);
  for (const Route& route : map.routes) {
    for (const RoadwayStretch& leg : route.legs) stretch("route " + route.id, leg);
  }
  return all;
}

/// Whether a junction joins the two roadways near this place.
bool areJoinedNear(const Network& network, const std::string& a, const std::string& b,
                   const Eigen::Vector3d& p_map, double reach) {
  const auto at = [&](const Junction& junction, const std::string& roadway) {
    return std::any_of(junction.places.begin(), junction.places.end(), [&](const RoadwayPlace& place) {
      return place.roadway == roadway && (floorAt(network, place) - p_map).norm() <= reach;
    });
  };
  const auto& junctions = network.map().junctions;
  return std::any_of(junctions.begin(), junctions.end(),
                     [&](const Junction& junction) { return at(junction, a) && at(junction, b); });
}

enum class Follow { Traffic, AgainstTraffic };

/// Nodes reached from the starts along edges that may be driven, or from which the starts are reached.
std::vector<bool> reachedFrom(const RoadGraph& graph, const std::vector<std::size_t>& starts, Follow follow) {
  std::vector<bool> reached(graph.nodes().size(), false);
  std::vector<std::size_t> open = starts;
  for (const std::size_t node : starts) reached[node] = true;
  while (!open.empty()) {
    const std::size_t node = open.back();
    open.pop_back();
    for (const std::size_t e : graph.edgesOf(node)) {
      const GraphEdge& edge = graph.edges()[e];
      const Direction away = edge.node_from == node ? Direction::Forward : Direction::Backward;
      const Direction back = away == Direction::Forward ? Direction::Backward : Direction::Forward;
      const std::size_t other = edge.node_from == node ? edge.node_to : edge.node_from;
      if (reached[other] || !graph.allows(e, follow == Follow::Traffic ? away : back)) continue;
      reached[other] = true;
      open.push_back(other);
    }
  }
  return reached;
}

/// Portals; without any, the node that reaches most.
std::vector<std::size_t> entrances(const RoadGraph& graph) {
  std::vector<std::size_t> portals;
  for (std::size_t n = 0; n < graph.nodes().size(); ++n) {
    if (graph.nodes()[n].kind == GraphNode::Kind::Portal) portals.push_back(n);
  }
  if (!portals.empty() || graph.nodes().empty()) return portals;
  std::size_t best = 0;
  std::ptrdiff_t most = -1;
  for (std::size_t n = 0; n < graph.nodes().size(); ++n) {
    const std::vector<bool> reached = reachedFrom(graph, {n}, Follow::Traffic);
    const auto count = std::count(reached.begin(), reached.end(), true);
    if (count <= most) continue;
    most = count;
    best = n;
  }
  return {best};
}

}  // namespace

Findings chainagesOutside(const Network& network) {
  Findings found;
  for (const auto& [object, place] : namedPlaces(network.map())) {
    const Centreline& line = network.centreline(network.indexOf(place.roadway));
    const double inside = std::clamp(place.chainage, line.chainageStart(), line.chainageEnd());
    if (std::abs(inside - place.chainage) <= 1e-3) continue;
    found.push_back({.check = Check::ChainageOutside,
                     .severity = Severity::Error,
                     .what = object + " is at chainage " + metres(place.chainage) + ", but roadway " +
                             place.roadway + " goes from " + metres(line.chainageStart()) + " to " +
                             metres(line.chainageEnd()),
                     .remedy = "correct the chainage or name the roadway that it belongs to",
                     .objects = {object, "roadway " + place.roadway},
                     .p_map = line.at(inside).p_map});
  }
  return found;
}

Findings nodes(const RoadGraph& graph, const CheckRules& rules) {
  Findings found;
  const auto isNamed = [](const GraphNode& node) { return node.kind != GraphNode::Kind::End; };
  for (std::size_t i = 0; i < graph.nodes().size(); ++i) {
    for (std::size_t j = i + 1; j < graph.nodes().size(); ++j) {
      const GraphNode& a = graph.nodes()[i];
      const GraphNode& b = graph.nodes()[j];
      const double distance = (a.p_map - b.p_map).norm();
      if (distance >= rules.coincident || !isNamed(a) || !isNamed(b)) continue;
      found.push_back({.check = Check::NearCoincidentNodes,
                       .severity = Severity::Error,
                       .what = a.id + " and " + b.id + " are only " + metres(distance) + " apart",
                       .remedy = "make one junction of the two",
                       .objects = {a.id, b.id},
                       .p_map = b.p_map});
    }
  }
  return found;
}

Findings junctionGaps(const Network& network, const CheckRules& rules) {
  Findings found;
  for (const Junction& junction : network.map().junctions) {
    const Eigen::Vector3d first = floorAt(network, junction.places[0]);
    for (std::size_t i = 1; i < junction.places.size(); ++i) {
      const Eigen::Vector3d p = floorAt(network, junction.places[i]);
      if ((p - first).norm() <= rules.gap) continue;
      found.push_back({.check = Check::Gap,
                       .severity = Severity::Error,
                       .what = "junction " + junction.id + " joins roadways " + junction.places[0].roadway +
                               " and " + junction.places[i].roadway + ", which are " +
                               metres((p - first).norm()) + " apart there",
                       .remedy = "correct the chainages, or lengthen the centreline to the other one",
                       .objects = {"junction " + junction.id, "roadway " + junction.places[0].roadway,
                                   "roadway " + junction.places[i].roadway},
                       .p_map = p});
    }
  }
  return found;
}

Findings openEnds(const Network& network, const RoadGraph& graph, const CheckRules& rules) {
  Findings found;
  for (const GraphEdge& edge : graph.edges()) {
    for (const std::size_t n : {edge.node_from, edge.node_to}) {
      const GraphNode& node = graph.nodes()[n];
      if (node.kind != GraphNode::Kind::End) continue;
      const Roadway& own = network.map().roadways[edge.roadway];
      const Eigen::Vector3d middle = node.p_map + Eigen::Vector3d(0, 0, 0.5 * own.height);
      for (const Projection& near : network.candidates(middle, rules.open_end_reach)) {
        const Roadway& other = network.map().roadways[near.point.roadway];
        const double reach = own.width + other.width + rules.open_end_reach;
        if (near.point.roadway == edge.roadway) continue;
        if (areJoinedNear(network, own.id, other.id, node.p_map, reach)) continue;
        found.push_back({.check = Check::Gap,
                         .severity = Severity::Warning,
                         .what = "roadway " + own.id + " ends " + metres(near.excess) +
                                 " from the space of roadway " + other.id + " and no junction joins them",
                         .remedy = "add a junction at chainage " + metres(near.point.chainage) + " of " +
                                   other.id + ", or shorten the roadway",
                         .objects = {"roadway " + own.id, "roadway " + other.id},
                         .p_map = node.p_map});
      }
    }
  }
  return found;
}

Findings unreachable(const RoadGraph& graph) {
  Findings found;
  const std::vector<std::size_t> starts = entrances(graph);
  const std::vector<bool> in = reachedFrom(graph, starts, Follow::Traffic);
  const std::vector<bool> out = reachedFrom(graph, starts, Follow::AgainstTraffic);
  for (std::size_t n = 0; n < graph.nodes().size(); ++n) {
    if (in[n] && out[n]) continue;
    const GraphNode& node = graph.nodes()[n];
    found.push_back(
        {.check = Check::UnreachableNode,
         .severity = Severity::Error,
         .what = in[n] ? "nobody can drive back from " + node.id : "nobody can drive to " + node.id,
         .remedy = "add the junction that is missing, or correct the one-way rules",
         .objects = {node.id},
         .p_map = node.p_map});
  }
  return found;
}

Findings routes(const Network& network, const CheckRules& rules) {
  Findings found;
  const auto complain = [&](const Route& route, const RoadwayPlace& place, const std::string& what) {
    found.push_back({.check = Check::RouteBroken,
                     .severity = Severity::Error,
                     .what = "route " + route.id + " " + what,
                     .remedy = "end one leg and begin the next where the roadways join",
                     .objects = {"route " + route.id, "roadway " + place.roadway},
                     .p_map = floorAt(network, place)});
  };
  for (const Route& route : network.map().routes) {
    for (std::size_t i = 0; i < route.legs.size(); ++i) {
      const RoadwayStretch& leg = route.legs[i];
      const Traffic traffic = network.map().roadways[network.indexOf(leg.roadway)].traffic;
      const bool against = (traffic == Traffic::ForwardOnly && leg.from > leg.to) ||
                           (traffic == Traffic::BackwardOnly && leg.from < leg.to);
      const RoadwayPlace begin{leg.roadway, leg.from};
      if (against) complain(route, begin, "drives roadway " + leg.roadway + " against its one-way rule");
      if (i == 0) continue;
      const RoadwayPlace end{route.legs[i - 1].roadway, route.legs[i - 1].to};
      const double gap = (floorAt(network, begin) - floorAt(network, end)).norm();
      if (gap > rules.gap)
        complain(route, begin, "has a gap of " + metres(gap) + " before leg " + std::to_string(i + 1));
      if (gap <= rules.gap && begin.roadway != end.roadway &&
          !areJoinedNear(network, begin.roadway, end.roadway, floorAt(network, begin), rules.gap)) {
        complain(route, begin,
                 "goes over from roadway " + end.roadway + " to " + begin.roadway +
                     " where no junction joins them");
      }
    }
  }
  return found;
}

}  // namespace pos::map
