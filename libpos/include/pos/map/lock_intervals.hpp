#pragma once
/// Division of roadways into lock intervals at refuge and passing chambers (Jiang et al. 2024, section 3.2).
///
/// On a straight leg the intervals lie between consecutive chambers. On two lanes only the chambers on the
/// lane's own side count, so the lanes have different intervals; on one lane the chambers of both sides
/// count. Each straight leg has a letter (i, j, k, ...); an interval that contains a junction where the way
/// turns off, or a bend, has index 0 and the letter of the leg behind it. Intervals cover the roadways; near
/// a junction they overlap, one for each way to go.

#include <optional>
#include <string>
#include <vector>

#include "pos/map/routes.hpp"

namespace pos::map {

/// Which lane of a roadway: Both where there is only one.
enum class Lane { Forward, Backward, Both };

/// A part of one roadway, `from` > `to` when the interval runs against the chainage.
struct IntervalSpan {
  RoadwayIndex roadway = 0;
  double from = 0.0;  ///< m, chainage
  double to = 0.0;    ///< m, chainage
  Lane lane = Lane::Both;

  double length() const { return from < to ? to - from : from - to; }
  bool holds(RoadwayIndex of_roadway, double chainage) const;
  bool operator==(const IntervalSpan&) const = default;
};

struct LockInterval {
  /// Stable as long as its own ends, lane and the nodes in it keep their ids; not to be taken apart. An
  /// interval on one lane has the same id whichever way it is driven.
  std::string id = {};
  std::string leg = {};                          ///< "i", "j", "k", ...
  int index = 0;                                 ///< 0 at a junction or bend
  std::string from = {};                         ///< id of the chamber or graph node where it begins
  std::string to = {};                           ///< id of the chamber or graph node where it ends
  std::vector<IntervalSpan> spans = {};          ///< in driving order
  std::vector<std::string> inner_chambers = {};  ///< passed inside; they remain places of a fix
  std::vector<std::string> nodes = {};           ///< junctions and bends inside

  /// "i_1", as in the paper.
  std::string label() const { return leg + "_" + std::to_string(index); }
  double length() const;
  bool operator==(const LockInterval&) const = default;
};

struct DivisionRules {
  int merge = 1;                  ///< g >= 1: every g-th chamber of a leg is a boundary
  double straight_within = 0.35;  ///< rad, a change of heading at a junction that still counts as going on
  int nodes_at_most = 3;          ///< turn-offs inside one interval before it is ended at a node (whole map)
};
DivisionRules validated(DivisionRules rules);

/// Intervals along a route, in driving order. The first begins and the last ends with the route.
std::vector<LockInterval> divided(const RoadGraph& graph, const Network& network, const RouteLine& route,
                                  const DivisionRules& rules);

/// Intervals of all roadways and all ways to go at junctions, ordered by roadway and chainage.
std::vector<LockInterval> divided(const RoadGraph& graph, const Network& network, const DivisionRules& rules);

/// Indices of the intervals that hold the place. `lane` Both: any lane.
std::vector<std::size_t> intervalsAt(const std::vector<LockInterval>& intervals, RoadwayIndex roadway,
                                     double chainage, Lane lane);

}  // namespace pos::map
