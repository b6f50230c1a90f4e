#pragma once
/// In which lock intervals the vehicle is, with what probability, since when and for how long still.

#include <string>
#include <vector>

#include "pos/interval/road_tracker.hpp"
#include "pos/map/lock_intervals.hpp"

namespace pos::interval {

struct IntervalRules {
  double listed = 1e-4;      ///< probability below which an interval is not listed
  double certain = 0.9;      ///< probability from which an entry counts; an exit counts below 1 - certain
  double speed_sigma = 0.3;  ///< m/s, of the speed that predicts the time to a boundary
  double slowest = 0.1;      ///< m/s, slower vehicles reach no boundary
};
IntervalRules validated(IntervalRules rules);

struct IntervalProbability {
  std::size_t interval = 0;  ///< index into the division
  double probability = 0.0;
};

/// The next end of an interval in the direction of travel.
struct BoundaryAhead {
  std::size_t interval = 0;
  bool entry = false;     ///< it begins there, for this vehicle
  double distance = 0.0;  ///< m
  double seconds = 0.0;
  double seconds_sigma = 0.0;
};

/// The answer for one moment. Intervals cover the roads and overlap near junctions: the answer is a set.
struct IntervalBelief {
  Stamp stamp = {};
  MatchState state = MatchState::Waiting;
  map::TunnelPoint point = {};    ///< most probable place; offset and height of the estimate
  double along_sigma = 0.0;       ///< m
  double across_sigma = 0.0;      ///< m
  bool against_chainage = false;  ///< the vehicle's front points to falling chainage
  double speed = 0.0;             ///< m/s along its nose
  double branch_probability = 0.0;
  std::vector<IntervalProbability> intervals = {};  ///< most probable first
  std::optional<BoundaryAhead> next = {};

  /// Intervals at least this probable, ascending.
  std::vector<std::size_t> atLeast(double probability) const;
};

struct IntervalEvent {
  enum class Kind { Entry, Exit, BranchOpen, BranchDecided, Lost, Found };
  Stamp stamp = {};  ///< when it was known
  Kind kind = Kind::Entry;
  std::size_t interval = 0;  ///< for Entry and Exit
  Stamp at = {};             ///< when it happened, as far as is known
  double at_sigma = 0.0;     ///< s
  double confidence = 0.0;   ///< probability that it has happened
  double past_node = 0.0;    ///< m, for BranchDecided: how far past the junction
};
std::string_view name(IntervalEvent::Kind kind);

class IntervalTracker {
 public:
  /// Keeps references to `graph`.
  IntervalTracker(const map::Network& network, const map::RoadGraph& graph,
                  std::vector<map::LockInterval> intervals, const MatchRules& match,
                  const IntervalRules& rules);

  /// Stamps must not decrease.
  IntervalBelief take(const Estimate& estimate);
  /// What happened at the last `take`.
  const std::vector<IntervalEvent>& events() const { return events_; }
  const std::vector<map::LockInterval>& intervals() const { return intervals_; }
  const RoadTracker& road() const { return road_; }
  RoadTracker& road() { return road_; }

 private:
  /// A stretch of a path that lies in an interval, in path coordinates.
  struct Stretch {
    double from = 0.0;
    double to = 0.0;
  };
  std::vector<Stretch> stretches(const RoadHypothesis& h, std::size_t interval) const;
  std::vector<double> probabilities() const;
  std::optional<BoundaryAhead> nextBoundary(const RoadHypothesis& h) const;
  void noteEdges(const IntervalBelief& belief, const std::vector<double>& now);
  void noteState(const IntervalBelief& belief);

  map::Network network_;
  const map::RoadGraph* graph_;
  std::vector<map::LockInterval> intervals_;
  IntervalRules rules_;
  RoadTracker road_;
  struct Presence {
    double probability = 0.0;
    bool inside = false;
    Stamp crossed = {};  ///< when the probability last passed one half
  };
  std::vector<Presence> presence_;
  std::vector<IntervalEvent> events_;
  std::optional<Stamp> last_;
  MatchState last_state_ = MatchState::Waiting;
  double branch_node_ = 0.0;  // path coordinate
};

}  // namespace pos::interval
