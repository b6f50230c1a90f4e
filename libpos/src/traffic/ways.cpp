#include "pos/traffic/ways.hpp"

#include "pos/core/error.hpp"

namespace pos::traffic {

std::vector<interval::Way> waysBetweenEnds(const map::RoadGraph& graph, const interval::LockMap& locks) {
  std::vector<map::TunnelPoint> ends;
  for (const map::GraphEdge& edge : graph.edges()) {
    if (graph.nodes()[edge.node_from].kind != map::GraphNode::Kind::Junction)
      ends.push_back({edge.roadway, edge.from, 0.0, 0.0});
    if (graph.nodes()[edge.node_to].kind != map::GraphNode::Kind::Junction)
      ends.push_back({edge.roadway, edge.to, 0.0, 0.0});
  }
  std::vector<interval::Way> ways;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = 0; j < ends.size(); ++j) {
      if (i == j) continue;
      if (const auto route = graph.shortestRoute(ends[i], ends[j])) ways.push_back(locks.way(*route));
    }
  }
  return ways;
}

std::vector<interval::Way> waysOfRoutes(const map::Network& network, const interval::LockMap& locks) {
  std::vector<interval::Way> ways;
  for (const map::Route& route : network.map().routes) {
    try {
      const map::RouteLine line(network, route);
      ways.push_back(locks.way(line));
      ways.push_back(locks.way(line.reversed()));
    } catch (const DataError& error) {
      Complaint complaint = error.complaint();
      complaint.key = "routes." + route.id;
      throw DataError(complaint);
    }
  }
  return ways;
}

}  // namespace pos::traffic
