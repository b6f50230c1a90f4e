#include "pos/interval/road_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pos/core/angle.hpp"

namespace pos::interval {

using map::Direction;

std::size_t startNode(const map::RoadGraph& graph, const PathLeg& leg) {
  const map::GraphEdge& edge = graph.edges()[leg.edge];
  return leg.direction == Direction::Forward ? edge.node_from : edge.node_to;
}

std::size_t endNode(const map::RoadGraph& graph, const PathLeg& leg) {
  const map::GraphEdge& edge = graph.edges()[leg.edge];
  return leg.direction == Direction::Forward ? edge.node_to : edge.node_from;
}

RoadPath::RoadPath(const map::RoadGraph& graph, PathLeg first) : graph_(&graph), legs_{first} {}

double RoadPath::legLength(std::size_t leg) const {
  const map::GraphEdge& edge = graph_->edges()[legs_[leg].edge];
  return edge.to - edge.from;
}

double RoadPath::legStart(std::size_t leg) const {
  double at = start_;
  for (std::size_t i = 0; i < leg; ++i) at += legLength(i);
  return at;
}

double RoadPath::end() const {
  return legStart(legs_.size());
}

std::size_t RoadPath::startNode() const {
  return interval::startNode(*graph_, legs_.front());
}
std::size_t RoadPath::endNode() const {
  return interval::endNode(*graph_, legs_.back());
}

void RoadPath::append(PathLeg leg) {
  legs_.push_back(leg);
}
void RoadPath::prepend(PathLeg leg) {
  legs_.insert(legs_.begin(), leg);
  start_ -= legLength(0);
}
void RoadPath::dropFirst() {
  start_ += legLength(0);
  legs_.erase(legs_.begin());
}
void RoadPath::dropLast() {
  legs_.pop_back();
}

PathFoot RoadPath::footOnLeg(const map::Network& network, std::size_t leg,
                             const Eigen::Vector3d& p_map) const {
  const map::GraphEdge& edge = graph_->edges()[legs_[leg].edge];
  const map::Centreline& line = network.centreline(edge.roadway);
  double best = std::numeric_limits<double>::infinity();
  double chainage = edge.from;
  const std::vector<map::CentrelineSegment>& segments = line.segments();
  for (std::size_t i = line.segmentAt(edge.from); i < segments.size() && segments[i].chainage <= edge.to;
       ++i) {
    const double stretch = segments[i].length / segments[i].plan_length;
    const double free = segments[i].chainage + stretch * map::footOn(segments[i], p_map).u;
    const double here = std::clamp(free, edge.from, edge.to);
    const double apart = (line.at(here).p_map - p_map).head<2>().norm();
    if (apart < best) std::tie(best, chainage) = std::pair(apart, here);
  }
  const map::CentrelineState state = line.at(chainage);
  const bool forward = legs_[leg].direction == Direction::Forward;
  PathFoot foot{.leg = leg, .roadway = edge.roadway, .chainage = chainage, .p_map = state.p_map};
  foot.distance = legStart(leg) + (forward ? chainage - edge.from : edge.to - chainage);
  foot.heading = wrapAngle(state.heading + (forward ? 0.0 : kPi));
  foot.curvature = forward ? state.curvature : -state.curvature;
  const Eigen::Vector2d apart = (p_map - state.p_map).head<2>();
  const double across = apart.dot(Eigen::Vector2d(-std::sin(foot.heading), std::cos(foot.heading)));
  const double along = apart.dot(Eigen::Vector2d(std::cos(foot.heading), std::sin(foot.heading)));
  const bool at_end = foot.distance <= start_ + 1e-9 || foot.distance >= end() - 1e-9;
  // Inside the path a foot at a kink is as far away as it is; past its ends the two directions are apart.
  foot.offset = at_end ? across : std::copysign(apart.norm(), across);
  foot.beyond = at_end ? along : 0.0;
  return foot;
}

PathFoot RoadPath::foot(const map::Network& network, const Eigen::Vector3d& p_map) const {
  PathFoot best = footOnLeg(network, 0, p_map);
  const auto apart = [&](const PathFoot& f) { return (f.p_map - p_map).head<2>().norm(); };
  for (std::size_t leg = 1; leg < legs_.size(); ++leg) {
    const PathFoot here = footOnLeg(network, leg, p_map);
    if (apart(here) < apart(best)) best = here;
  }
  return best;
}

std::optional<double> RoadPath::distanceOf(map::RoadwayIndex roadway, double chainage) const {
  for (std::size_t leg = 0; leg < legs_.size(); ++leg) {
    const map::GraphEdge& edge = graph_->edges()[legs_[leg].edge];
    if (edge.roadway != roadway || chainage < edge.from || chainage > edge.to) continue;
    const bool forward = legs_[leg].direction == Direction::Forward;
    return legStart(leg) + (forward ? chainage - edge.from : edge.to - chainage);
  }
  return std::nullopt;
}

}  // namespace pos::interval
