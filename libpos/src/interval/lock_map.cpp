#include "pos/interval/lock_map.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/config_checks.hpp"

namespace pos::interval {
namespace {

using map::Direction;

constexpr double kShortest = 0.5;  // m, no section is shorter: cuts this near to each other are one

std::string metres(double chainage) {
  return std::to_string(std::llround(chainage));
}

/// Cuts inside (from, to) with both ends, ascending, none nearer to another than kShortest.
std::vector<double> tidy(std::vector<double> cuts, double from, double to) {
  std::sort(cuts.begin(), cuts.end());
  std::vector<double> kept{from};
  for (const double cut : cuts) {
    if (cut > kept.back() + kShortest && cut < to - kShortest) kept.push_back(cut);
  }
  kept.push_back(to);
  return kept;
}

bool overlaps(const map::IntervalSpan& span, map::RoadwayIndex roadway, double from, double to) {
  const auto [low, high] = std::minmax(span.from, span.to);
  return span.roadway == roadway && low < to - 1e-6 && high > from + 1e-6;
}

bool sharesLane(map::Lane a, map::Lane b) {
  return a == b || a == map::Lane::Both || b == map::Lane::Both;
}

}  // namespace

LockMapRules validated(LockMapRules rules) {
  requireNotNegative(rules.bay_margin, "bay_margin", "m");
  requireNotNegative(rules.junction_reach, "junction_reach", "m");
  requireNotNegative(rules.stop_line, "stop_line", "m");
  requireNotNegative(rules.queue_length, "queue_length", "m");
  requireNotNegative(rules.queue_margin, "queue_margin", "m");
  return rules;
}

LockMap::LockMap(const map::Network& network, const map::RoadGraph& graph,
                 const std::vector<map::LockInterval>& intervals, const LockMapRules& rules)
    : rules_(validated(rules)), graph_(graph), intervals_(intervals), edges_(graph.edges().size()) {
  addJunctions(network);
  for (std::size_t i = 0; i < edges_.size(); ++i) addEdge(network, i);
  findIntervals(network);
}

std::size_t LockMap::addSection(LockSection section) {
  site_->sections.push_back(std::move(section));
  return site_->sections.size() - 1;
}

/// A section for every junction, a depot for every other node.
void LockMap::addJunctions(const map::Network&) {
  for (const map::GraphNode& node : graph_.nodes()) {
    const bool junction = node.kind == map::GraphNode::Kind::Junction;
    node_section_.push_back(junction ? addSection({.id = "junction " + node.id}) : 0);
    node_depot_.push_back(junction ? 0 : site_->stops.size());
    if (!junction) site_->stops.push_back({.id = node.id, .kind = StopPlace::Kind::Depot});
  }
}

void LockMap::addEdge(const map::Network& network, std::size_t index) {
  const map::GraphEdge& edge = graph_.edges()[index];
  const map::Roadway& roadway = network.map().roadways[edge.roadway];
  const double reach = std::min(rules_.junction_reach, (edge.to - edge.from) / 3.0);
  const auto part = [&](std::size_t node) {
    return graph_.nodes()[node].kind == map::GraphNode::Kind::Junction ? reach : 0.0;
  };
  edges_[index].from = edge.from + part(edge.node_from);
  edges_[index].to = edge.to - part(edge.node_to);
  std::vector<double> cuts;
  if (roadway.lanes == 1) cuts = addChambers(network, index);
  if (roadway.lanes == 2) addQueues(index);
  for (const map::LockInterval& interval : intervals_) {
    for (const map::IntervalSpan& span : interval.spans) {
      if (span.roadway == edge.roadway) cuts.insert(cuts.end(), {span.from, span.to});
    }
  }
  addPieces(roadway, index, std::move(cuts));
}

void LockMap::addPieces(const map::Roadway& roadway, std::size_t index, std::vector<double> cuts) {
  Edge& edge = edges_[index];
  const std::vector<double> ends = tidy(std::move(cuts), edge.from, edge.to);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const std::string id = roadway.id + " " + metres(ends[i]) + "-" + metres(ends[i + 1]);
    Piece piece{ends[i], ends[i + 1], 0, 0};
    if (roadway.lanes == 1) {
      piece.forward = piece.backward = addSection({.id = id});
    } else {
      piece.forward = addSection({.id = id + " forward", .single_lane = false});
      piece.backward = addSection({.id = id + " backward", .single_lane = false});
    }
    edge.pieces.push_back(piece);
  }
}

/// Stops in the passing chambers of an edge with one lane; returns where the roads at them begin and end.
std::vector<double> LockMap::addChambers(const map::Network& network, std::size_t index) {
  Edge& edge = edges_[index];
  const map::GraphEdge& of = graph_.edges()[index];
  const std::string& roadway = network.map().roadways[of.roadway].id;
  std::vector<double> cuts;
  for (const map::Chamber& chamber : network.map().chambers) {
    const double at = chamber.place.chainage;
    const double from = at - 0.5 * chamber.length;
    const double to = at + 0.5 * chamber.length;
    if (chamber.kind != map::Chamber::Kind::Passing || chamber.place.roadway != roadway) continue;
    if (from < edge.from || to > edge.to) continue;  // vehicles cannot wait within a junction
    edge.places.push_back({site_->stops.size(), from, at, to, {}});
    site_->stops.push_back({chamber.id, StopPlace::Kind::Niche, chamber.length, chamber.capacity});
    cuts.insert(cuts.end(), {from - rules_.bay_margin, to + rules_.bay_margin});
  }
  std::sort(edge.places.begin(), edge.places.end(),
            [](const Place& a, const Place& b) { return a.at < b.at; });
  return cuts;
}

/// On two lanes vehicles wait in their own lane before a junction.
void LockMap::addQueues(std::size_t index) {
  Edge& edge = edges_[index];
  const map::GraphEdge& of = graph_.edges()[index];
  const double length = std::min(rules_.queue_length, edge.to - edge.from);
  const double room = length - rules_.queue_margin;
  if (room <= rules_.stop_line) return;
  const auto add = [&](std::size_t node, Direction direction) {
    if (graph_.nodes()[node].kind != map::GraphNode::Kind::Junction) return;
    const bool forward = direction == Direction::Forward;
    const double line = forward ? edge.to - rules_.stop_line : edge.from + rules_.stop_line;
    edge.places.push_back({site_->stops.size(), forward ? edge.to - length : edge.from, line,
                           forward ? edge.to : edge.from + length, direction});
    site_->stops.push_back({graph_.nodes()[node].id + " from edge " + std::to_string(index),
                            StopPlace::Kind::OnRoad, room, 1000});
  };
  add(of.node_from, Direction::Backward);
  add(of.node_to, Direction::Forward);
}

void LockMap::findIntervals(const map::Network& network) {
  const auto mark = [&](std::size_t section, map::RoadwayIndex roadway, double from, double to,
                        map::Lane lane) {
    for (std::size_t i = 0; i < intervals_.size(); ++i) {
      const auto& spans = intervals_[i].spans;
      const bool shares = std::any_of(spans.begin(), spans.end(), [&](const map::IntervalSpan& span) {
        return overlaps(span, roadway, from, to) && sharesLane(span.lane, lane);
      });
      auto& marked = site_->sections[section].intervals;
      if (shares && std::find(marked.begin(), marked.end(), i) == marked.end()) marked.push_back(i);
    }
  };
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const map::GraphEdge& of = graph_.edges()[e];
    const bool one = network.map().roadways[of.roadway].lanes == 1;
    for (const Piece& piece : edges_[e].pieces) {
      mark(piece.forward, of.roadway, piece.from, piece.to, one ? map::Lane::Both : map::Lane::Forward);
      if (!one) mark(piece.backward, of.roadway, piece.from, piece.to, map::Lane::Backward);
    }
    if (edges_[e].from > of.from)
      mark(node_section_[of.node_from], of.roadway, of.from, edges_[e].from, map::Lane::Both);
    if (edges_[e].to < of.to)
      mark(node_section_[of.node_to], of.roadway, edges_[e].to, of.to, map::Lane::Both);
  }
}

}  // namespace pos::interval
