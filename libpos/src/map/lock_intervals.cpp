#include "pos/map/lock_intervals.hpp"

#include <algorithm>

#include "interval_walk.hpp"
#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"

namespace pos::map {
namespace {

/// Every merge-th boundary of a run of intervals on one straight leg.
std::vector<std::size_t> keptBoundaries(const std::vector<int>& index, int merge) {
  std::vector<std::size_t> kept = {0};
  int run = 0;
  for (std::size_t i = 0; i < index.size(); ++i) {
    const bool last_of_run = i + 1 == index.size() || index[i + 1] <= 1;
    run = index[i] == 0 ? 0 : run + 1;
    if (!last_of_run && (index[i] == 0 || run % merge == 0)) kept.push_back(i + 1);
    if (last_of_run) {
      kept.push_back(i + 1);
      run = 0;
    }
  }
  return kept;
}

/// Which straight leg each interval belongs to (counted from the start) and its index on it.
struct Numbering {
  std::vector<int> leg;
  std::vector<int> index;
};
Numbering numbered(const std::vector<WayEvent>& events, const std::vector<WayMark>& boundaries) {
  Numbering numbering;
  int leg = 0;
  int index = 0;
  for (std::size_t i = 0; i + 1 < boundaries.size(); ++i) {
    const auto breaks = std::count_if(events.begin(), events.end(), [&](const WayEvent& event) {
      return event.ends_leg && event.distance >= boundaries[i].distance - kSamePlace &&
             event.distance < boundaries[i + 1].distance - kSamePlace;
    });
    leg += static_cast<int>(breaks);
    index = breaks > 0 ? 0 : index + 1;
    numbering.leg.push_back(leg);
    numbering.index.push_back(index);
  }
  return numbering;
}

}  // namespace

bool IntervalSpan::holds(RoadwayIndex of_roadway, double chainage) const {
  const auto [low, high] = std::minmax(from, to);
  return roadway == of_roadway && low <= chainage && chainage <= high;
}

double LockInterval::length() const {
  double sum = 0.0;
  for (const IntervalSpan& span : spans) sum += span.length();
  return sum;
}

DivisionRules validated(DivisionRules rules) {
  requirePositive(rules.merge, "merge");
  if (!(rules.straight_within > 0.0 && rules.straight_within < 1.6)) {
    refuse("this is no angle at which roadways go straight on", "straight_within_deg",
           std::to_string(degrees(rules.straight_within)), "0 to 90 deg");
  }
  requirePositive(rules.nodes_at_most, "nodes_at_most");
  return rules;
}

std::vector<LockInterval> divided(const RoadGraph& graph, const Network& network, const RouteLine& route,
                                  const DivisionRules& rules) {
  (void)validated(rules);
  const Way way(graph, network, route, rules.straight_within);
  const std::vector<WayMark> boundaries = way.boundaries();
  const Numbering all = numbered(way.events(), boundaries);
  const std::vector<std::size_t> kept = keptBoundaries(all.index, rules.merge);
  std::vector<LockInterval> intervals;
  int index = 0;
  for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
    const std::size_t first = kept[k];
    const bool same_leg = k > 0 && all.leg[first] == all.leg[kept[k - 1]];
    index = all.index[first] == 0 ? 0 : same_leg ? index + 1 : 1;
    LockInterval interval = way.between(boundaries[first], boundaries[kept[k + 1]]);
    interval.leg = legLetter(all.leg[first]);
    interval.index = index;
    intervals.push_back(std::move(interval));
  }
  return intervals;
}

std::vector<std::size_t> intervalsAt(const std::vector<LockInterval>& intervals, RoadwayIndex roadway,
                                     double chainage, Lane lane) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const auto& spans = intervals[i].spans;
    const bool holds = std::any_of(spans.begin(), spans.end(), [&](const IntervalSpan& span) {
      const bool same_lane = lane == Lane::Both || span.lane == Lane::Both || span.lane == lane;
      return same_lane && span.holds(roadway, chainage);
    });
    if (holds) found.push_back(i);
  }
  return found;
}

}  // namespace pos::map
