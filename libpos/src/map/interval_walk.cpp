#include "interval_walk.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "pos/core/angle.hpp"

namespace pos::map {
namespace {

/// A route may begin or end this far from a node and still be said to begin there, m.
constexpr double kAtNode = 0.5;

/// Heading of driving, rad.
double drivenHeading(const Network& network, const DrivenStretch& leg, double chainage) {
  const double heading = network.centreline(leg.roadway).at(chainage).heading;
  return leg.direction() == Direction::Forward ? heading : heading + kPi;
}

double distanceAlong(const DrivenStretch& leg, double chainage) {
  return std::abs(chainage - leg.from);
}

bool passes(const DrivenStretch& leg, double chainage) {
  const auto [low, high] = std::minmax(leg.from, leg.to);
  return low - kSamePlace <= chainage && chainage <= high + kSamePlace;
}

template <class Mark>
void sortByDistance(std::vector<Mark>& marks) {
  std::stable_sort(marks.begin(), marks.end(),
                   [](const Mark& a, const Mark& b) { return a.distance < b.distance; });
}

std::string placeName(const std::string& roadway, double chainage) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "@%.1f", chainage);
  return roadway + text.data();
}

}  // namespace

bool isForLane(const Roadway& roadway, Side chamber_side, Direction driven, Side driving_side) {
  if (roadway.lanes == 1) return true;
  const bool own_side = driven == Direction::Forward;
  return (chamber_side == driving_side) == own_side;
}

Lane laneOf(const Roadway& roadway, Direction driven) {
  if (roadway.lanes == 1) return Lane::Both;
  return driven == Direction::Forward ? Lane::Forward : Lane::Backward;
}

std::string legLetter(int leg) {
  constexpr int kLetters = 'z' - 'i' + 1;
  const std::string last(1, static_cast<char>('i' + leg % kLetters));
  return leg < kLetters ? last : legLetter(leg / kLetters - 1) + last;
}

Way::Way(const RoadGraph& graph, const Network& network, RouteLine route, double straight_within)
    : network_(network), route_(std::move(route)) {
  start_id_ = nameOfEnd(graph, 0.0);
  end_id_ = nameOfEnd(graph, route_.length());
  addNodes(graph);
  addTurns(graph, straight_within);
  addBends();
  addChambers();
  sortByDistance(events_);
  sortByDistance(chambers_);
}

/// Nodes passed within a leg: straight on.
void Way::addNodes(const RoadGraph& graph) {
  double start = 0.0;
  for (const DrivenStretch& leg : route_.legs()) {
    const auto [low, high] = std::minmax(leg.from, leg.to);
    for (const GraphEdge& edge : graph.edgesOn(leg.roadway)) {
      if (edge.from <= low + kSamePlace || edge.from >= high - kSamePlace) continue;
      events_.push_back({start + distanceAlong(leg, edge.from), graph.nodes()[edge.node_from].id, false});
    }
    start += leg.length();
  }
}

/// Nodes where one leg goes over into the next.
void Way::addTurns(const RoadGraph& graph, double straight_within) {
  double end = 0.0;
  for (std::size_t i = 0; i + 1 < route_.legs().size(); ++i) {
    const DrivenStretch& leg = route_.legs()[i];
    const DrivenStretch& next = route_.legs()[i + 1];
    end += leg.length();
    const double turn =
        wrapAngle(drivenHeading(network_, next, next.from) - drivenHeading(network_, leg, leg.to));
    events_.push_back({end, nameOfEnd(graph, end), std::abs(turn) > straight_within});
  }
}

void Way::addBends() {
  for (const Bend& bend : network_.map().bends) {
    const RoadwayIndex roadway = network_.indexOf(bend.stretch.roadway);
    const double middle = 0.5 * (bend.stretch.from + bend.stretch.to);
    double start = 0.0;
    for (const DrivenStretch& leg : route_.legs()) {
      if (leg.roadway == roadway && passes(leg, middle))
        events_.push_back({start + distanceAlong(leg, middle), bend.id, true});
      start += leg.length();
    }
  }
}

void Way::addChambers() {
  std::set<std::size_t> passed;
  for (const DrivenStretch& leg : route_.legs()) {
    const auto& here = network_.chambersOn(leg.roadway);
    passed.insert(here.begin(), here.end());
  }
  for (const std::size_t c : passed) {
    const Chamber& chamber = network_.map().chambers[c];
    const RoadwayIndex roadway = network_.indexOf(chamber.place.roadway);
    double start = 0.0;
    for (const DrivenStretch& leg : route_.legs()) {
      const bool counts = leg.roadway == roadway && passes(leg, chamber.place.chainage) &&
                          isForLane(network_.map().roadways[roadway], chamber.side, leg.direction(),
                                    network_.map().driving_side);
      if (counts) chambers_.push_back({start + distanceAlong(leg, chamber.place.chainage), chamber.id});
      start += leg.length();
    }
  }
}

std::string Way::nameOfEnd(const RoadGraph& graph, double distance) const {
  const PlaceOnRoute place = route_.at(distance);
  for (const GraphEdge& edge : graph.edgesOn(place.roadway)) {
    if (std::abs(edge.from - place.chainage) < kAtNode) return graph.nodes()[edge.node_from].id;
    if (std::abs(edge.to - place.chainage) < kAtNode) return graph.nodes()[edge.node_to].id;
  }
  return placeName(network_.map().roadways[place.roadway].id, place.chainage);
}

std::vector<WayMark> Way::boundaries() const {
  std::vector<WayMark> marks;
  const auto add = [&marks](const WayMark& mark) {
    if (marks.empty() || mark.distance > marks.back().distance + kSamePlace) marks.push_back(mark);
  };
  const bool starts_at_chamber = !chambers_.empty() && chambers_.front().distance < kSamePlace;
  if (!starts_at_chamber) add({0.0, start_id_});
  for (const WayMark& chamber : chambers_) add(chamber);
  add({route_.length(), end_id_});
  return marks;
}

LockInterval Way::between(const WayMark& begin, const WayMark& end) const {
  LockInterval interval{.from = begin.id, .to = end.id};
  double start = 0.0;
  for (const DrivenStretch& leg : route_.legs()) {
    const double low = std::max(begin.distance - start, 0.0);
    const double high = std::min(end.distance - start, leg.length());
    start += leg.length();
    if (high <= low) continue;
    const double way = leg.direction() == Direction::Forward ? 1.0 : -1.0;
    interval.spans.push_back({leg.roadway, leg.from + way * low, leg.from + way * high,
                              laneOf(network_.map().roadways[leg.roadway], leg.direction())});
  }
  const auto inside = [&](double distance) {
    return distance > begin.distance + kSamePlace && distance < end.distance - kSamePlace;
  };
  for (const WayEvent& event : events_) {
    if (inside(event.distance)) interval.nodes.push_back(event.id);
  }
  for (const WayMark& chamber : chambers_) {
    if (inside(chamber.distance)) interval.inner_chambers.push_back(chamber.id);
  }
  interval.id = idOf(interval, begin, end);
  return interval;
}

/// Ends, nodes and roadways in driving order; on one lane from the end whose text comes first.
std::string Way::idOf(const LockInterval& interval, const WayMark& begin, const WayMark& end) const {
  const auto text = [&](const std::string& from, const std::string& to, bool against) {
    std::vector<std::string> parts;
    for (const IntervalSpan& span : interval.spans) parts.push_back(network_.map().roadways[span.roadway].id);
    parts.insert(parts.end(), interval.nodes.begin(), interval.nodes.end());
    if (against) {
      const auto middle = parts.begin() + static_cast<std::ptrdiff_t>(interval.spans.size());
      std::reverse(parts.begin(), middle);
      std::reverse(middle, parts.end());
    }
    std::string joined = from;
    for (const std::string& part : parts) joined += ">" + part;
    return joined + ">" + to;
  };
  const bool either_way =
      std::all_of(interval.spans.begin(), interval.spans.end(),
                  [&](const IntervalSpan& s) { return network_.map().roadways[s.roadway].lanes == 1; });
  const std::string driven = text(begin.id, end.id, false);
  return either_way ? std::min(driven, text(end.id, begin.id, true)) : driven;
}

}  // namespace pos::map
