#include "pos/interval/interval_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pos/core/config_checks.hpp"

namespace pos::interval {
namespace {

using map::Direction;

constexpr double kHalf = 0.5;

/// Phi, the normal distribution.
double normal(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

/// Whether a vehicle that faces this way along the chainage drives in the lane.
bool inLane(map::Lane lane, Direction facing) {
  return lane == map::Lane::Both || (lane == map::Lane::Forward) == (facing == Direction::Forward);
}

}  // namespace

IntervalRules validated(IntervalRules rules) {
  require(rules.listed >= 0.0 && rules.listed < 1.0, "listed", "a probability, below 1");
  require(rules.certain > kHalf && rules.certain < 1.0, "certain", "a probability above 0.5 and below 1");
  requireNotNegative(rules.speed_sigma, "speed_sigma", "m/s");
  requirePositive(rules.slowest, "slowest", "m/s");
  return rules;
}

std::string_view name(IntervalEvent::Kind kind) {
  using Kind = IntervalEvent::Kind;
  switch (kind) {
    case Kind::Entry:
      return "interval_entry";
    case Kind::Exit:
      return "interval_exit";
    case Kind::BranchOpen:
      return "branch_open";
    case Kind::BranchDecided:
      return "branch_decided";
    case Kind::Lost:
      return "off_the_map";
    case Kind::Found:
      return "on_the_map";
  }
  return "?";
}

std::vector<std::size_t> IntervalBelief::atLeast(double probability) const {
  std::vector<std::size_t> set;
  for (const IntervalProbability& i : intervals) {
    if (i.probability >= probability) set.push_back(i.interval);
  }
  std::sort(set.begin(), set.end());
  return set;
}

IntervalTracker::IntervalTracker(const map::Network& network, const map::RoadGraph& graph,
                                 std::vector<map::LockInterval> intervals, const MatchRules& match,
                                 const IntervalRules& rules)
    : network_(network),
      graph_(&graph),
      intervals_(std::move(intervals)),
      rules_(validated(rules)),
      road_(network, graph, match),
      presence_(intervals_.size()) {}

/// The interval's spans laid out along the path; spans that follow each other are one stretch. At a dead end
/// the interval reaches as far as the belief does.
std::vector<IntervalTracker::Stretch> IntervalTracker::stretches(const RoadHypothesis& h,
                                                                 std::size_t interval) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<Stretch> found;
  for (std::size_t leg = 0; leg < h.path.legs().size(); ++leg) {
    const PathLeg& on = h.path.legs()[leg];
    const map::GraphEdge& edge = graph_->edges()[on.edge];
    const bool forward = on.direction == Direction::Forward;
    const Direction facing = forward == h.facing ? Direction::Forward : Direction::Backward;
    for (const map::IntervalSpan& span : intervals_[interval].spans) {
      if (span.roadway != edge.roadway || !inLane(span.lane, facing)) continue;
      const double low = std::max(std::min(span.from, span.to), edge.from);
      const double high = std::min(std::max(span.from, span.to), edge.to);
      if (high <= low) continue;
      const double at = h.path.legStart(leg);
      Stretch stretch{at + (forward ? low - edge.from : edge.to - high),
                      at + (forward ? high - edge.from : edge.to - low)};
      if (stretch.from <= h.path.start() + 1e-6) stretch.from = -kInfinity;
      if (stretch.to >= h.path.end() - 1e-6) stretch.to = kInfinity;
      found.push_back(stretch);
    }
  }
  std::sort(found.begin(), found.end(), [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
  std::vector<Stretch> joined;
  for (const Stretch& s : found) {
    if (!joined.empty() && s.from <= joined.back().to + 1e-6) {
      joined.back().to = std::max(joined.back().to, s.to);
    } else {
      joined.push_back(s);
    }
  }
  return joined;
}

/// P(I) = sum over branches of weight * (Phi((s1 - s) / sigma) - Phi((s0 - s) / sigma)), spec A section 6.2.
std::vector<double> IntervalTracker::probabilities() const {
  std::vector<double> sum(intervals_.size(), 0.0);
  for (const RoadHypothesis& h : road_.hypotheses()) {
    const double sigma = std::max(h.along_sigma, 1e-6);
    for (std::size_t i = 0; i < intervals_.size(); ++i) {
      for (const Stretch& s : stretches(h, i)) {
        sum[i] += h.probability *
                  (normal((s.to - h.foot.distance) / sigma) - normal((s.from - h.foot.distance) / sigma));
      }
    }
  }
  return sum;
}

std::optional<BoundaryAhead> IntervalTracker::nextBoundary(const RoadHypothesis& h) const {
  const double speed = road_.speed();
  if (std::abs(speed) < rules_.slowest) return std::nullopt;
  const double sign = h.facing == (speed > 0.0) ? 1.0 : -1.0;  // of the motion along the path
  std::optional<BoundaryAhead> next;
  for (std::size_t i = 0; i < intervals_.size(); ++i) {
    for (const Stretch& s : stretches(h, i)) {
      for (const double end : {s.from, s.to}) {
        const double ahead = sign * (end - h.foot.distance);
        if (!std::isfinite(end) || ahead < 0.0 || (next && ahead >= next->distance)) continue;
        next = BoundaryAhead{.interval = i, .entry = (end == s.from) == (sign > 0.0), .distance = ahead};
      }
    }
  }
  if (!next) return next;
  const double v = std::abs(speed);
  next->seconds = next->distance / v;
  next->seconds_sigma = std::hypot(h.along_sigma / v, next->distance * rules_.speed_sigma / (v * v));
  return next;
}

IntervalBelief IntervalTracker::take(const Estimate& estimate) {
  road_.take(estimate);
  events_.clear();
  IntervalBelief belief{.stamp = estimate.stamp, .state = road_.state(), .speed = road_.speed()};
  const RoadHypothesis* best = road_.best();
  if (best != nullptr) {
    const bool forward = (best->path.legs()[best->foot.leg].direction == Direction::Forward);
    belief.point = {best->foot.roadway, best->foot.chainage, forward ? best->foot.offset : -best->foot.offset,
                    estimate.T_map_body.translation.z() - best->foot.p_map.z()};
    belief.along_sigma = best->along_sigma;
    belief.across_sigma = best->across_sigma;
    belief.against_chainage = forward != best->facing;
    for (const RoadHypothesis& h : road_.hypotheses()) {
      const bool same = h.path.legs()[h.foot.leg].edge == best->path.legs()[best->foot.leg].edge;
      belief.branch_probability += same ? h.probability : 0.0;
    }
    belief.next = nextBoundary(*best);
  }
  const std::vector<double> now = probabilities();
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i] >= rules_.listed) belief.intervals.push_back({i, now[i]});
  }
  std::stable_sort(belief.intervals.begin(), belief.intervals.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  noteState(belief);
  noteEdges(belief, now);
  last_ = estimate.stamp;
  return belief;
}

/// Entries and exits: they happened when the probability passed one half, and are told once it is certain.
void IntervalTracker::noteEdges(const IntervalBelief& belief, const std::vector<double>& now) {
  const double speed = std::max(std::abs(belief.speed), rules_.slowest);
  for (std::size_t i = 0; i < now.size(); ++i) {
    Presence& p = presence_[i];
    if (last_ && (p.probability < kHalf) != (now[i] < kHalf)) {
      const double share = (kHalf - p.probability) / (now[i] - p.probability);
      p.crossed = *last_ + durationFromSeconds(share * seconds(belief.stamp - *last_));
    }
    if (!last_) p.crossed = belief.stamp;
    p.probability = now[i];
    const bool enters = !p.inside && now[i] >= rules_.certain;
    const bool leaves = p.inside && now[i] <= 1.0 - rules_.certain;
    if (!enters && !leaves) continue;
    p.inside = enters;
    events_.push_back({.stamp = belief.stamp,
                       .kind = enters ? IntervalEvent::Kind::Entry : IntervalEvent::Kind::Exit,
                       .interval = i,
                       .at = p.crossed,
                       .at_sigma = belief.along_sigma / speed,
                       .confidence = enters ? now[i] : 1.0 - now[i]});
  }
}

void IntervalTracker::noteState(const IntervalBelief& belief) {
  const auto tell = [&](IntervalEvent::Kind kind) -> IntervalEvent& {
    return events_.emplace_back(IntervalEvent{
        .stamp = belief.stamp, .kind = kind, .at = belief.stamp, .confidence = belief.branch_probability});
  };
  const MatchState now = belief.state;
  const RoadHypothesis* best = road_.best();
  if (now == MatchState::Branching && last_state_ != MatchState::Branching) {
    branch_node_ = best->foot.distance;
    tell(IntervalEvent::Kind::BranchOpen);
  }
  if (now == MatchState::Decided && last_state_ == MatchState::Branching) {
    const double past = best->foot.leg > 0 ? best->foot.distance - best->path.legStart(best->foot.leg) : 0.0;
    tell(IntervalEvent::Kind::BranchDecided).past_node = past;
  }
  if (now == MatchState::Lost && last_state_ != MatchState::Lost) tell(IntervalEvent::Kind::Lost);
  if (last_state_ == MatchState::Lost && now != MatchState::Lost) tell(IntervalEvent::Kind::Found);
  last_state_ = now;
}

}  // namespace pos::interval
