#pragma once
/// Which roadway the vehicle is on and where: map matching with one hypothesis per branch (spec A
/// section 6.3; docs/math/intervals.md).

#include <optional>
#include <vector>

#include "pos/core/estimate.hpp"
#include "pos/interval/road_path.hpp"

namespace pos::interval {

struct MatchRules {
  double heading_sigma = 0.0873;  ///< rad (5 degrees), between a vehicle and its roadway while it drives
  double commit = 0.99;           ///< probability at which a branch counts as decided
  double sigmas = 3.0;            ///< reach of a position
  double look_ahead = 20.0;       ///< m, branches nearer than this are considered before they are reached
  double lost_after = 2.0;        ///< s outside every roadway considered before it starts over
  double reacquire_slack = 30.0;  ///< m that a new start may be farther than the vehicle can have come
  double passage_wrong = 0.005;   ///< share of chamber passages that name a wrong chamber
  std::size_t hypotheses_at_most = 64;
};
MatchRules validated(MatchRules rules);

/// One way the vehicle may be going.
struct RoadHypothesis {
  RoadPath path;
  double prior = 1.0;  ///< before the present estimate
  PathFoot foot = {};
  bool facing = true;         ///< the vehicle's front points along the path
  double along_sigma = 0.0;   ///< m
  double across_sigma = 0.0;  ///< m
  double log_likelihood = 0.0;
  double probability = 1.0;

  /// m, path coordinate of the vehicle's point that lies `ahead` (m) of its origin.
  double distanceOf(double ahead) const { return foot.distance + (facing ? ahead : -ahead); }
};

/// What became of the match.
enum class MatchState {
  Waiting,    ///< no roadway near the estimate yet
  Decided,    ///< one roadway
  Branching,  ///< several
  Lost        ///< outside every roadway considered
};

class RoadTracker {
 public:
  RoadTracker(const map::Network& network, const map::RoadGraph& graph, const MatchRules& rules);

  /// Stamps must not decrease.
  void take(const Estimate& estimate);
  /// A sign that the vehicle's point `ahead` (m) of its origin is at this place (a chamber passage):
  /// hypotheses that agree gain.
  void witness(map::RoadwayIndex roadway, double chainage, double sigma, double ahead = 0.0);

  MatchState state() const { return state_; }
  /// Sum of probabilities is one; empty while Waiting.
  const std::vector<RoadHypothesis>& hypotheses() const { return hypotheses_; }
  /// The most probable one, or null.
  const RoadHypothesis* best() const;
  /// m/s along the vehicle's nose, smoothed over about a second; negative when it reverses.
  double speed() const { return speed_; }
  /// m, sum of all moves so far, smoothed; never falls.
  double travelled() const { return travelled_; }

 private:
  void moved(const Estimate& estimate);
  void begin(const Estimate& estimate);
  void restart(const Estimate& estimate);
  bool reachable(const map::TunnelPoint& point, double sigma) const;
  void match(const Estimate& estimate, RoadHypothesis& h) const;
  void extend(const Estimate& estimate);
  void trim();
  void merge();
  void weigh();
  void commit();
  bool inside(const RoadHypothesis& h) const;
  std::size_t edgeOf(const RoadHypothesis& h) const { return h.path.legs()[h.foot.leg].edge; }

  map::Network network_;
  const map::RoadGraph* graph_;
  MatchRules rules_;
  std::vector<RoadHypothesis> hypotheses_;
  MatchState state_ = MatchState::Waiting;
  std::optional<Estimate> last_;
  std::optional<Stamp> outside_since_;
  std::optional<map::TunnelPoint> confirmed_;  // last place where it was decided
  double since_confirmed_ = 0.0;               // m travelled since
  double speed_ = 0.0;
  double travelled_ = 0.0;
};

}  // namespace pos::interval
