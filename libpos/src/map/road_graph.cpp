#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "pos/map/routes.hpp"

namespace pos::map {
namespace {

/// A node this near to a roadway's end stands at the end, m.
constexpr double kAtEnd = 0.5;

/// An edge with the way it is driven: 2 * edge, plus one against the chainage.
using DirectedEdge = std::size_t;
std::size_t edgeOf(DirectedEdge directed) {
  return directed / 2;
}
Direction directionOf(DirectedEdge directed) {
  return directed % 2 == 0 ? Direction::Forward : Direction::Backward;
}
DirectedEdge directed(std::size_t edge, Direction direction) {
  return 2 * edge + (direction == Direction::Forward ? 0 : 1);
}

DrivenStretch wholeEdge(const GraphEdge& edge, Direction direction) {
  return direction == Direction::Forward ? DrivenStretch{edge.roadway, edge.from, edge.to}
                                         : DrivenStretch{edge.roadway, edge.to, edge.from};
}

/// Dijkstra's search over edges with a direction, so that nobody turns round at a junction.
class RouteSearch {
 public:
  RouteSearch(const RoadGraph& graph, const TunnelPoint& start, std::size_t start_edge,
              const TunnelPoint& goal, std::size_t goal_edge)
      : graph_(graph),
        start_(start),
        start_edge_(start_edge),
        goal_(goal),
        goal_edge_(goal_edge),
        reached_(2 * graph.edges().size()) {}

  /// Stretches from start to goal; empty when there is no way.
  std::vector<DrivenStretch> shortest() {
    offerDirectWay();
    offerFirstParts();
    while (!open_.empty()) {
      const auto [cost, here] = open_.top();
      open_.pop();
      if (cost >= best_cost_) break;
      if (!std::exchange(reached_[here].done, true)) driveOnFrom(here);
    }
    return best_;
  }

 private:
  struct Reached {
    double cost = std::numeric_limits<double>::infinity();  ///< m, to the far end of the edge
    std::optional<DirectedEdge> from = {};
    bool done = false;
  };

  DrivenStretch whole(DirectedEdge e) const { return wholeEdge(graph_.edges()[edgeOf(e)], directionOf(e)); }
  DrivenStretch firstPart(DirectedEdge e) const { return {start_.roadway, start_.chainage, whole(e).to}; }

  void offerDirectWay() {
    const DrivenStretch direct{start_.roadway, start_.chainage, goal_.chainage};
    if (start_edge_ != goal_edge_ || !graph_.isOpen(direct)) return;
    if (!graph_.allows(start_edge_, direct.direction())) return;
    best_cost_ = direct.length();
    best_ = {direct};
  }

  void offerFirstParts() {
    for (const Direction way : {Direction::Forward, Direction::Backward}) {
      const DirectedEdge e = directed(start_edge_, way);
      if (graph_.allows(start_edge_, way) && graph_.isOpen(firstPart(e)))
        offer(e, firstPart(e).length(), std::nullopt);
    }
  }

  void offer(DirectedEdge edge, double cost, std::optional<DirectedEdge> from) {
    if (cost >= reached_[edge].cost) return;
    reached_[edge] = {cost, from, false};
    open_.push({cost, edge});
  }

  void driveOnFrom(DirectedEdge here) {
    const GraphEdge& edge = graph_.edges()[edgeOf(here)];
    const std::size_t node = directionOf(here) == Direction::Forward ? edge.node_to : edge.node_from;
    for (const std::size_t next : graph_.edgesOf(node)) {
      for (const Direction way : {Direction::Forward, Direction::Backward}) {
        const GraphEdge& candidate = graph_.edges()[next];
        const std::size_t begins = way == Direction::Forward ? candidate.node_from : candidate.node_to;
        const bool turns_round = next == edgeOf(here) && way != directionOf(here);
        if (begins == node && !turns_round && graph_.allows(next, way)) enter(directed(next, way), here);
      }
    }
  }

  void enter(DirectedEdge next, DirectedEdge here) {
    const double cost = reached_[here].cost;
    const DrivenStretch last{whole(next).roadway, whole(next).from, goal_.chainage};
    if (edgeOf(next) == goal_edge_ && graph_.isOpen(last) && cost + last.length() < best_cost_) {
      best_cost_ = cost + last.length();
      best_ = wayTo(here);
      best_.push_back(last);
    }
    if (graph_.isOpen(whole(next))) offer(next, cost + whole(next).length(), here);
  }

  std::vector<DrivenStretch> wayTo(DirectedEdge last) const {
    std::vector<DrivenStretch> way;
    for (std::optional<DirectedEdge> e = last; e; e = reached_[*e].from) {
      way.push_back(reached_[*e].from ? whole(*e) : firstPart(*e));
    }
    std::reverse(way.begin(), way.end());
    return way;
  }

  const RoadGraph& graph_;
  TunnelPoint start_;
  std::size_t start_edge_;
  TunnelPoint goal_;
  std::size_t goal_edge_;
  double best_cost_ = std::numeric_limits<double>::infinity();
  std::vector<DrivenStretch> best_;
  std::vector<Reached> reached_;
  using Entry = std::pair<double, DirectedEdge>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

}  // namespace

RoadGraph::RoadGraph(const Network& network) {
  const TunnelMap& map = network.map();
  NodePlaces places = withJunctionsAndPortals(network);
  for (RoadwayIndex r = 0; r < map.roadways.size(); ++r) {
    traffic_.push_back(map.roadways[r].traffic);
    first_edge_.push_back(edges_.size());
    addEdges(network, r, std::move(places[r]));
  }
  first_edge_.push_back(edges_.size());
  closed_.resize(map.roadways.size());
  for (const RestrictedZone& zone : map.zones) {
    if (zone.kind == RestrictedZone::Kind::NoEntry)
      closed_[network.indexOf(zone.stretch.roadway)].push_back(zone.stretch);
  }
  edges_of_.resize(nodes_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    edges_of_[edges_[e].node_from].push_back(e);
    if (edges_[e].node_to != edges_[e].node_from) edges_of_[edges_[e].node_to].push_back(e);
  }
}

RoadGraph::NodePlaces RoadGraph::withJunctionsAndPortals(const Network& network) {
  NodePlaces places(network.map().roadways.size());
  const auto add = [&](const RoadwayPlace& place) {
    const RoadwayIndex r = network.indexOf(place.roadway);
    const Centreline& line = network.centreline(r);
    const double chainage = std::clamp(place.chainage, line.chainageStart(), line.chainageEnd());
    places[r].push_back({chainage, nodes_.size()});
    return line.at(chainage).p_map;
  };
  for (const Junction& junction : network.map().junctions) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const RoadwayPlace& place : junction.places) sum += add(place);
    const auto count = static_cast<double>(junction.places.size());
    nodes_.push_back({.kind = GraphNode::Kind::Junction, .id = junction.id, .p_map = sum / count});
  }
  for (const Portal& portal : network.map().portals) {
    const Eigen::Vector3d p = add(portal.place);
    nodes_.push_back({.kind = GraphNode::Kind::Portal, .id = portal.id, .p_map = p});
  }
  return places;
}

void RoadGraph::addEdges(const Network& network, RoadwayIndex roadway, std::vector<NodePlace> places) {
  const Centreline& line = network.centreline(roadway);
  const std::string& id = network.map().roadways[roadway].id;
  std::stable_sort(places.begin(), places.end(),
                   [](const NodePlace& a, const NodePlace& b) { return a.chainage < b.chainage; });
  const auto openEnd = [&](double chainage, const char* which) {
    nodes_.push_back({.kind = GraphNode::Kind::End, .id = id + which, .p_map = line.at(chainage).p_map});
    return NodePlace{chainage, nodes_.size() - 1};
  };
  if (places.empty() || places.front().chainage > line.chainageStart() + kAtEnd)
    places.insert(places.begin(), openEnd(line.chainageStart(), ":start"));
  if (places.size() == 1 || places.back().chainage < line.chainageEnd() - kAtEnd)
    places.push_back(openEnd(line.chainageEnd(), ":end"));
  places.front().chainage = line.chainageStart();
  places.back().chainage = line.chainageEnd();
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    edges_.push_back(
        {roadway, places[i].chainage, places[i + 1].chainage, places[i].node, places[i + 1].node});
  }
}

std::span<const GraphEdge> RoadGraph::edgesOn(RoadwayIndex roadway) const {
  const std::size_t first = first_edge_[roadway];
  return std::span(edges_).subspan(first, first_edge_[roadway + 1] - first);
}

std::optional<std::size_t> RoadGraph::edgeAt(RoadwayIndex roadway, double chainage) const {
  for (std::size_t e = first_edge_[roadway]; e < first_edge_[roadway + 1]; ++e) {
    if (edges_[e].from <= chainage && chainage <= edges_[e].to) return e;
  }
  return std::nullopt;
}

bool RoadGraph::allows(std::size_t edge, Direction direction) const {
  const Traffic traffic = traffic_[edges_[edge].roadway];
  return traffic == Traffic::BothWays ||
         (traffic == Traffic::ForwardOnly) == (direction == Direction::Forward);
}

bool RoadGraph::isOpen(const DrivenStretch& stretch) const {
  const auto [low, high] = std::minmax(stretch.from, stretch.to);
  return std::none_of(
      closed_[stretch.roadway].begin(), closed_[stretch.roadway].end(),
      [low = low, high = high](const RoadwayStretch& zone) { return zone.from <= high && zone.to >= low; });
}

std::optional<RouteLine> RoadGraph::shortestRoute(const TunnelPoint& start, const TunnelPoint& goal) const {
  const auto start_edge = edgeAt(start.roadway, start.chainage);
  const auto goal_edge = edgeAt(goal.roadway, goal.chainage);
  if (!start_edge || !goal_edge) return std::nullopt;
  const auto way = RouteSearch(*this, start, *start_edge, goal, *goal_edge).shortest();
  if (way.empty()) return std::nullopt;
  return RouteLine(way);
}

}  // namespace pos::map
