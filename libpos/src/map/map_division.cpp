#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "interval_walk.hpp"

namespace pos::map {
namespace {

/// Every way from one boundary to the next: chambers that count for the lane, ends of the roadways, and nodes
/// where a way would come back to itself or pass too many turn-offs.
class MapDivision {
 public:
  MapDivision(const RoadGraph& graph, const Network& network, const DivisionRules& rules)
      : graph_(graph), network_(network), rules_(rules) {
    chooseBoundaries();
  }

  std::vector<LockInterval> intervals() {
    for (std::size_t e = 0; e < graph_.edges().size(); ++e) {
      for (const Direction way : {Direction::Forward, Direction::Backward}) {
        if (graph_.allows(e, way)) walkFrom(e, way);
      }
    }
    coverTheRest();
    std::stable_sort(found_.begin(), found_.end(), [](const LockInterval& a, const LockInterval& b) {
      return std::tie(a.spans[0].roadway, a.spans[0].from) < std::tie(b.spans[0].roadway, b.spans[0].from);
    });
    number();
    return std::move(found_);
  }

 private:
  struct Mark {
    double chainage = 0.0;
    std::string id = {};
  };
  struct WayBehind {
    std::string begin = {};
    std::vector<DrivenStretch> stretches = {};
    std::vector<std::size_t> nodes = {};
  };

  /// The straight leg of a roadway that holds the chainage: its bends divide it.
  std::size_t legOf(RoadwayIndex roadway, double chainage) const {
    std::size_t leg = 0;
    for (const Bend& bend : network_.map().bends) {
      const double middle = 0.5 * (bend.stretch.from + bend.stretch.to);
      if (bend.stretch.roadway == network_.map().roadways[roadway].id && middle <= chainage) ++leg;
    }
    return leg;
  }

  /// Every merge-th chamber of each leg and lane, with the first and the last.
  void chooseBoundaries() {
    const TunnelMap& map = network_.map();
    std::map<std::tuple<RoadwayIndex, std::size_t, int>, std::vector<Mark>> of_leg;
    for (const Chamber& chamber : map.chambers) {
      const RoadwayIndex r = network_.indexOf(chamber.place.roadway);
      const int side = map.roadways[r].lanes == 1 ? 0 : chamber.side == Side::Left ? 1 : 2;
      of_leg[{r, legOf(r, chamber.place.chainage), side}].push_back({chamber.place.chainage, chamber.id});
    }
    for (auto& [leg, marks] : of_leg) {
      std::stable_sort(marks.begin(), marks.end(),
                       [](const Mark& a, const Mark& b) { return a.chainage < b.chainage; });
      const auto g = static_cast<std::size_t>(rules_.merge);
      for (std::size_t i = 0; i < marks.size(); ++i) {
        if (i % g == 0 || i + 1 == marks.size()) boundaries_.insert(marks[i].id);
      }
    }
  }

  /// Boundary chambers on an edge in driving order, one a place.
  std::vector<Mark> marksOn(std::size_t e, Direction way) const {
    const GraphEdge& edge = graph_.edges()[e];
    const Roadway& roadway = network_.map().roadways[edge.roadway];
    std::vector<Mark> marks;
    for (const std::size_t each : network_.chambersOn(edge.roadway)) {
      const Chamber& chamber = network_.map().chambers[each];
      const double c = chamber.place.chainage;
      const bool counts = boundaries_.count(chamber.id) > 0 &&
                          isForLane(roadway, chamber.side, way, network_.map().driving_side);
      if (counts && c >= edge.from && c <= edge.to) marks.push_back({c, chamber.id});
    }
    std::stable_sort(marks.begin(), marks.end(),
                     [](const Mark& a, const Mark& b) { return a.chainage < b.chainage; });
    const auto again = std::unique(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) {
      return b.chainage - a.chainage < kSamePlace;
    });
    marks.erase(again, marks.end());
    if (way == Direction::Backward) std::reverse(marks.begin(), marks.end());
    return marks;
  }

  double beginOf(std::size_t e, Direction way) const {
    return way == Direction::Forward ? graph_.edges()[e].from : graph_.edges()[e].to;
  }
  double endOf(std::size_t e, Direction way) const {
    return way == Direction::Forward ? graph_.edges()[e].to : graph_.edges()[e].from;
  }
  std::size_t firstNode(std::size_t e, Direction way) const {
    return way == Direction::Forward ? graph_.edges()[e].node_from : graph_.edges()[e].node_to;
  }
  std::size_t lastNode(std::size_t e, Direction way) const {
    return way == Direction::Forward ? graph_.edges()[e].node_to : graph_.edges()[e].node_from;
  }
  bool isTerminal(std::size_t node) const { return graph_.edgesOf(node).size() == 1; }

  /// All intervals that begin on this edge.
  void walkFrom(std::size_t e, Direction way) {
    std::vector<Mark> marks = marksOn(e, way);
    const std::size_t first = firstNode(e, way);
    const bool at_chamber = !marks.empty() && std::abs(marks[0].chainage - beginOf(e, way)) < kSamePlace;
    if (isTerminal(first) && !at_chamber)
      marks.insert(marks.begin(), {beginOf(e, way), graph_.nodes()[first].id});
    const RoadwayIndex r = graph_.edges()[e].roadway;
    for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
      emit({marks[i].id, {{r, marks[i].chainage, marks[i + 1].chainage}}}, marks[i + 1].id);
    }
    if (!marks.empty()) walkOn({marks.back().id, {{r, marks.back().chainage, endOf(e, way)}}}, e, way);
  }

  /// From the end of an edge to the next boundary on every way.
  void walkOn(WayBehind behind, std::size_t e, Direction way) {
    const std::size_t node = lastNode(e, way);
    const bool been_here = std::count(behind.nodes.begin(), behind.nodes.end(), node) > 0;
    const bool far = behind.nodes.size() >= static_cast<std::size_t>(rules_.nodes_at_most);
    behind.nodes.push_back(node);
    bool goes_on = false;
    if (!been_here && !far && !isTerminal(node)) {
      for (const std::size_t next : graph_.edgesOf(node)) {
        for (const Direction next_way : {Direction::Forward, Direction::Backward}) {
          const bool turns_round = next == e && next_way != way;
          if (firstNode(next, next_way) != node || turns_round || !graph_.allows(next, next_way)) continue;
          goes_on = true;
          walkInto(behind, next, next_way);
        }
      }
    }
    if (!goes_on) emit(behind, graph_.nodes()[node].id);
  }

  void walkInto(WayBehind behind, std::size_t e, Direction way) {
    const std::vector<Mark> marks = marksOn(e, way);
    const double end = marks.empty() ? endOf(e, way) : marks.front().chainage;
    behind.stretches.push_back({graph_.edges()[e].roadway, beginOf(e, way), end});
    if (marks.empty()) {
      walkOn(std::move(behind), e, way);
    } else {
      emit(behind, marks.front().id);
    }
  }

  void emit(const WayBehind& behind, const std::string& end) {
    const Way way(graph_, network_, RouteLine(behind.stretches), rules_.straight_within);
    if (way.route().length() < kSamePlace) return;
    LockInterval interval = way.between({0.0, behind.begin}, {way.route().length(), end});
    if (!ids_.insert(interval.id).second) return;
    const IntervalSpan& last = interval.spans.back();
    const bool turns = std::any_of(way.events().begin(), way.events().end(),
                                   [](const WayEvent& event) { return event.ends_leg; });
    leg_of_[interval.id] = {last.roadway, legOf(last.roadway, last.to)};
    interval.index = turns || interval.spans.size() > 1 ? 0 : 1;
    found_.push_back(std::move(interval));
  }

  /// Where one-way rules let nobody in from a boundary, pieces may still be without an interval.
  void coverTheRest() {
    for (std::size_t e = 0; e < graph_.edges().size(); ++e) {
      for (const Direction way : {Direction::Forward, Direction::Backward}) {
        if (!graph_.allows(e, way)) continue;
        std::vector<Mark> marks = marksOn(e, way);
        marks.insert(marks.begin(), {beginOf(e, way), graph_.nodes()[firstNode(e, way)].id});
        marks.push_back({endOf(e, way), graph_.nodes()[lastNode(e, way)].id});
        for (std::size_t i = 0; i + 1 < marks.size(); ++i) cover(e, way, marks[i], marks[i + 1]);
      }
    }
  }

  void cover(std::size_t e, Direction way, const Mark& begin, const Mark& end) {
    const RoadwayIndex r = graph_.edges()[e].roadway;
    const Lane lane = laneOf(network_.map().roadways[r], way);
    const double middle = 0.5 * (begin.chainage + end.chainage);
    const bool covered = std::any_of(found_.begin(), found_.end(), [&](const LockInterval& interval) {
      return std::any_of(interval.spans.begin(), interval.spans.end(), [&](const IntervalSpan& span) {
        return span.lane == lane && span.holds(r, middle);
      });
    });
    if (!covered) emit({begin.id, {{r, begin.chainage, end.chainage}}}, end.id);
  }

  /// Letters go with the straight legs in map order, indices with the driving order on a leg and lane.
  void number() {
    std::map<std::pair<RoadwayIndex, std::size_t>, int> letters;
    for (RoadwayIndex r = 0; r < network_.map().roadways.size(); ++r) {
      const std::size_t legs = legOf(r, network_.centreline(r).chainageEnd()) + 1;
      for (std::size_t leg = 0; leg < legs; ++leg) letters.emplace(std::pair{r, leg}, letters.size());
    }
    std::map<std::pair<int, Lane>, std::vector<LockInterval*>> straight;
    for (LockInterval& interval : found_) {
      const int letter = letters.at(leg_of_.at(interval.id));
      interval.leg = legLetter(letter);
      if (interval.index > 0) straight[{letter, interval.spans[0].lane}].push_back(&interval);
    }
    for (auto& [key, intervals] : straight) {
      if (key.second == Lane::Backward) std::reverse(intervals.begin(), intervals.end());
      for (std::size_t i = 0; i < intervals.size(); ++i) intervals[i]->index = static_cast<int>(i) + 1;
    }
  }

  const RoadGraph& graph_;
  const Network& network_;
  DivisionRules rules_;
  std::set<std::string> boundaries_;  ///< ids of the chambers that end intervals
  std::set<std::string> ids_;
  std::map<std::string, std::pair<RoadwayIndex, std::size_t>> leg_of_;  ///< of each interval, where it ends
  std::vector<LockInterval> found_;
};

}  // namespace

std::vector<LockInterval> divided(const RoadGraph& graph, const Network& network,
                                  const DivisionRules& rules) {
  return MapDivision(graph, network, validated(rules)).intervals();
}

}  // namespace pos::map
