#pragma once
/// Driving along roadways: the graph of junctions, shortest ways, and distance along a route.

#include <optional>
#include <span>
#include <vector>

#include "pos/map/network.hpp"

namespace pos::map {

/// A stretch as it is driven; `from` > `to` is against the chainage.
struct DrivenStretch {
  RoadwayIndex roadway = 0;
  double from = 0.0;  ///< m, chainage
  double to = 0.0;    ///< m, chainage

  double length() const { return from < to ? to - from : from - to; }
  Direction direction() const { return from <= to ? Direction::Forward : Direction::Backward; }
  bool operator==(const DrivenStretch&) const = default;
};

/// A place on the way and which way it is driven there.
struct PlaceOnRoute {
  RoadwayIndex roadway = 0;
  double chainage = 0.0;
  Direction direction = Direction::Forward;
};

/// A way through the mine without gaps.
class RouteLine {
 public:
  /// Legs that follow each other on one roadway become one. Throws ConfigError when there is none.
  explicit RouteLine(const std::vector<DrivenStretch>& legs);
  /// Throws ConfigError for a roadway that is unknown.
  RouteLine(const Network& network, const Route& route);

  const std::vector<DrivenStretch>& legs() const { return legs_; }
  double length() const;
  /// Clamped to the route's ends.
  PlaceOnRoute at(double distance) const;
  /// Every distance from the start at which the route passes the place; more than one where it comes back.
  std::vector<double> distancesOf(RoadwayIndex roadway, double chainage) const;
  RouteLine reversed() const;

 private:
  std::vector<DrivenStretch> legs_;
  std::vector<double> starts_;  ///< m, distance at the start of each leg
};

/// A junction, a portal or an open end.
struct GraphNode {
  enum class Kind { Junction, Portal, End };
  Kind kind = Kind::End;
  std::string id = {};  ///< of the junction or portal; "<roadway>:start" or "<roadway>:end" for an open end
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
};
/// A piece of a roadway between two nodes, from < to.
struct GraphEdge {
  RoadwayIndex roadway = 0;
  double from = 0.0;
  double to = 0.0;
  std::size_t node_from = 0;
  std::size_t node_to = 0;
};

/// A junction or portal that the map puts past the end of a roadway stands at that end here; `findings`
/// reports it.
class RoadGraph {
 public:
  explicit RoadGraph(const Network& network);

  const std::vector<GraphNode>& nodes() const { return nodes_; }
  const std::vector<GraphEdge>& edges() const { return edges_; }
  /// Edges of one roadway in the order of chainage.
  std::span<const GraphEdge> edgesOn(RoadwayIndex roadway) const;
  /// Edges that touch a node.
  const std::vector<std::size_t>& edgesOf(std::size_t node) const { return edges_of_[node]; }
  /// The edge that holds the place; nothing off the roadway's ends.
  std::optional<std::size_t> edgeAt(RoadwayIndex roadway, double chainage) const;
  bool allows(std::size_t edge, Direction direction) const;
  /// Whether no zone of kind NoEntry touches the stretch.
  bool isOpen(const DrivenStretch& stretch) const;

  /// Shortest way that keeps to the one-way rules (restricted zones of kind NoEntry are closed); nothing when
  /// there is none. A vehicle may start either way and does not turn round on the way. O(edges log edges).
  std::optional<RouteLine> shortestRoute(const TunnelPoint& start, const TunnelPoint& goal) const;

 private:
  struct NodePlace {
    double chainage = 0.0;
    std::size_t node = 0;
  };
  using NodePlaces = std::vector<std::vector<NodePlace>>;  ///< of each roadway
  NodePlaces withJunctionsAndPortals(const Network& network);
  void addEdges(const Network& network, RoadwayIndex roadway, std::vector<NodePlace> places);

  std::vector<GraphNode> nodes_;
  std::vector<GraphEdge> edges_;                     ///< roadway after roadway
  std::vector<std::size_t> first_edge_;              ///< of each roadway, and one past the last
  std::vector<std::vector<std::size_t>> edges_of_;   ///< of each node
  std::vector<Traffic> traffic_;                     ///< of each roadway
  std::vector<std::vector<RoadwayStretch>> closed_;  ///< of each roadway
};

}  // namespace pos::map
