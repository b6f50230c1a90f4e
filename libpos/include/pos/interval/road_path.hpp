#pragma once
/// A way through the road graph that a vehicle may be on, with one coordinate along it.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pos/map/network.hpp"
#include "pos/map/routes.hpp"

namespace pos::interval {

/// An edge of the graph and which way the path runs along it.
struct PathLeg {
  std::size_t edge = 0;
  map::Direction direction = map::Direction::Forward;

  bool operator==(const PathLeg&) const = default;
};

/// The point of a path nearest to a position.
struct PathFoot {
  std::size_t leg = 0;
  double distance = 0.0;  ///< m, path coordinate
  map::RoadwayIndex roadway = 0;
  double chainage = 0.0;                            ///< m
  double heading = 0.0;                             ///< rad, of the path (not of the chainage)
  double curvature = 0.0;                           ///< 1/m in plan, to the left of the path positive
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< m, on the centreline
  double offset = 0.0;                              ///< m, of the position, to the left of the path positive
  double beyond = 0.0;  ///< m, the position lies past this end of the path; 0 beside it
};

/// Copying is cheap enough for a few legs. The coordinate of a place does not change when legs are added or
/// taken away at either end.
class RoadPath {
 public:
  RoadPath(const map::RoadGraph& graph, PathLeg first);

  const std::vector<PathLeg>& legs() const { return legs_; }
  double start() const { return start_; }
  double end() const;
  double legStart(std::size_t leg) const;
  double legLength(std::size_t leg) const;
  std::size_t startNode() const;
  std::size_t endNode() const;

  void append(PathLeg leg);
  void prepend(PathLeg leg);
  void dropFirst();
  void dropLast();

  /// Plan distance decides; height does not (a path knows its level).
  PathFoot foot(const map::Network& network, const Eigen::Vector3d& p_map) const;
  /// Path coordinate of a place; nothing where the path does not pass it.
  std::optional<double> distanceOf(map::RoadwayIndex roadway, double chainage) const;

  bool operator==(const RoadPath& other) const { return legs_ == other.legs_; }

 private:
  PathFoot footOnLeg(const map::Network& network, std::size_t leg, const Eigen::Vector3d& p_map) const;

  const map::RoadGraph* graph_;
  std::vector<PathLeg> legs_;
  double start_ = 0.0;
};

/// The node a leg begins and ends at.
std::size_t startNode(const map::RoadGraph& graph, const PathLeg& leg);
std::size_t endNode(const map::RoadGraph& graph, const PathLeg& leg);

}  // namespace pos::interval
