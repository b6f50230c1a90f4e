/// Ways over a LockMap.

#include <algorithm>

#include "pos/core/error.hpp"
#include "pos/interval/lock_map.hpp"

namespace pos::interval {

using map::Direction;

std::size_t LockMap::startNode(const DrivenEdge& e) const {
  const map::GraphEdge& edge = graph_.edges()[e.edge];
  return e.direction == Direction::Forward ? edge.node_from : edge.node_to;
}

std::size_t LockMap::endNode(const DrivenEdge& e) const {
  const map::GraphEdge& edge = graph_.edges()[e.edge];
  return e.direction == Direction::Forward ? edge.node_to : edge.node_from;
}

std::vector<LockMap::DrivenEdge> LockMap::driven(const map::RouteLine& route) const {
  std::vector<DrivenEdge> edges;
  for (const map::DrivenStretch& leg : route.legs()) {
    const auto [low, high] = std::minmax(leg.from, leg.to);
    std::vector<std::size_t> on_leg;
    for (std::size_t i = 0; i < graph_.edges().size(); ++i) {
      const map::GraphEdge& edge = graph_.edges()[i];
      if (edge.roadway == leg.roadway && edge.from > low - 0.5 && edge.to < high + 0.5) on_leg.push_back(i);
    }
    std::sort(on_leg.begin(), on_leg.end(), [&](std::size_t a, std::size_t b) {
      return (graph_.edges()[a].from < graph_.edges()[b].from) == (leg.direction() == Direction::Forward);
    });
    for (const std::size_t edge : on_leg) edges.push_back({edge, leg.direction()});
  }
  return edges;
}

std::size_t LockMap::depot(std::size_t node) const {
  if (graph_.nodes()[node].kind == map::GraphNode::Kind::Junction) {
    throw DataError(Complaint{.what = "a way for locks begins and ends at an open end or a portal",
                              .got = "junction " + graph_.nodes()[node].id});
  }
  return node_depot_[node];
}

/// Sections and stops of one edge between its junctions; `at` is the distance where it begins, the distance
/// where it ends is returned.
double LockMap::drive(Way& way, const DrivenEdge& e, double at) const {
  const Edge& edge = edges_[e.edge];
  const bool forward = e.direction == Direction::Forward;
  const auto distance = [&](double chainage) {
    return at + (forward ? chainage - edge.from : edge.to - chainage);
  };
  std::vector<Piece> pieces = edge.pieces;
  std::vector<Place> places = edge.places;
  if (!forward) {
    std::reverse(pieces.begin(), pieces.end());
    std::reverse(places.begin(), places.end());
  }
  for (const Piece& p : pieces) {
    way.sections.push_back({forward ? p.forward : p.backward, forward ? 1 : -1,
                            distance(forward ? p.from : p.to), distance(forward ? p.to : p.from)});
  }
  for (const Place& p : places) {
    if (p.only && *p.only != e.direction) continue;
    way.stops.push_back(
        {p.stop, distance(p.at), distance(forward ? p.from : p.to), distance(forward ? p.to : p.from)});
  }
  return at + edge.to - edge.from;
}

/// The junction between two edges, as one section; its movement is the turn.
double LockMap::cross(Way& way, const DrivenEdge& in, const DrivenEdge& out, double at) const {
  const auto part = [&](std::size_t edge, Direction end) {  // of the junction at that end of the edge
    return end == Direction::Forward ? graph_.edges()[edge].to - edges_[edge].to
                                     : edges_[edge].from - graph_.edges()[edge].from;
  };
  const auto opposite = [](Direction d) {
    return d == Direction::Forward ? Direction::Backward : Direction::Forward;
  };
  const auto code = [](const DrivenEdge& e) {
    return 2 * static_cast<int>(e.edge) + (e.direction == Direction::Forward ? 0 : 1);
  };
  const double end = at + part(in.edge, in.direction) + part(out.edge, opposite(out.direction));
  const int turn = 2 + code(in) * 2 * static_cast<int>(edges_.size()) + code(out);
  way.sections.push_back({node_section_[endNode(in)], turn, at, end});
  return end;
}

Way LockMap::way(const map::RouteLine& route) const {
  const std::vector<DrivenEdge> edges = driven(route);
  if (edges.empty())
    throw DataError(Complaint{.what = "the route does not cover any road between two nodes"});
  Way way;
  way.stops.push_back({depot(startNode(edges.front())), 0.0, 0.0, 0.0});
  double at = 0.0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i > 0 && endNode(edges[i - 1]) != startNode(edges[i])) {
      throw DataError(
          Complaint{.what = "the route has a gap", .got = "after edge " + std::to_string(edges[i - 1].edge)});
    }
    if (i > 0) at = cross(way, edges[i - 1], edges[i], at);
    at = drive(way, edges[i], at);
  }
  way.stops.push_back({depot(endNode(edges.back())), at, at, at});
  return validated(std::move(way), *site_);
}

}  // namespace pos::interval
