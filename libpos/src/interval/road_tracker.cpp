#include "pos/interval/road_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"
#include "pos/core/square.hpp"

namespace pos::interval {
namespace {

using map::Direction;

constexpr double kSpeedMemory = 1.0;    // s
constexpr double kSideways = 0.3;       // |cos| below which a vehicle does not tell which way it faces
constexpr double kBehind = 10.0;        // m more than the reach before what is behind is forgotten
constexpr double kOutsideMargin = 1.0;  // m beyond the wall and the reach before it counts as outside

Direction opposite(Direction d) {
  return d == Direction::Forward ? Direction::Backward : Direction::Forward;
}

/// Legs that lead away from a node, but not back over the edge `from`.
std::vector<PathLeg> legsFrom(const map::RoadGraph& graph, std::size_t node, std::size_t from) {
  std::vector<PathLeg> legs;
  for (const std::size_t edge : graph.edgesOf(node)) {
    if (edge == from) continue;
    const map::GraphEdge& e = graph.edges()[edge];
    legs.push_back({edge, e.node_from == node ? Direction::Forward : Direction::Backward});
  }
  return legs;
}

}  // namespace

MatchRules validated(MatchRules rules) {
  requirePositive(rules.heading_sigma, "heading_sigma", "rad");
  require(rules.commit > 0.5 && rules.commit < 1.0, "commit", "a probability above 0.5 and below 1");
  requirePositive(rules.sigmas, "sigmas");
  requireNotNegative(rules.look_ahead, "look_ahead", "m");
  requireNotNegative(rules.lost_after, "lost_after", "s");
  requireNotNegative(rules.reacquire_slack, "reacquire_slack", "m");
  requireConfidence(rules.passage_wrong, "passage_wrong");
  require(rules.hypotheses_at_most >= 2, "hypotheses_at_most", "2 or more");
  return rules;
}

RoadTracker::RoadTracker(const map::Network& network, const map::RoadGraph& graph, const MatchRules& rules)
    : network_(network), graph_(&graph), rules_(validated(rules)) {}

const RoadHypothesis* RoadTracker::best() const {
  const auto best =
      std::max_element(hypotheses_.begin(), hypotheses_.end(),
                       [](const auto& a, const auto& b) { return a.probability < b.probability; });
  return best != hypotheses_.end() ? &*best : nullptr;
}

void RoadTracker::take(const Estimate& estimate) {
  moved(estimate);
  if (hypotheses_.empty()) begin(estimate);
  for (RoadHypothesis& h : hypotheses_) match(estimate, h);
  trim();
  extend(estimate);
  merge();
  weigh();
  commit();
  last_ = estimate;
  const RoadHypothesis* top = best();
  if (top == nullptr) return;
  if (inside(*top)) outside_since_.reset();
  if (!inside(*top)) {
    if (!outside_since_) outside_since_ = estimate.stamp;
    if (seconds(estimate.stamp - *outside_since_) >= rules_.lost_after) restart(estimate);
  }
}

/// Speed and way from the differences of positions, since an estimate carries no velocity.
void RoadTracker::moved(const Estimate& estimate) {
  if (!last_) return;
  const double dt = seconds(estimate.stamp - last_->stamp);
  if (dt <= 0.0) return;
  const Pose2 before = last_->T_map_body.planar();
  const Pose2 now = estimate.T_map_body.planar();
  const Eigen::Vector2d step = now.translation() - before.translation();
  const double along = step.dot(Eigen::Vector2d(std::cos(now.yaw), std::sin(now.yaw)));
  const double gain = 1.0 - std::exp(-dt / kSpeedMemory);
  speed_ += gain * (along / dt - speed_);
  travelled_ += std::abs(speed_) * dt;
  since_confirmed_ += std::abs(speed_) * dt;
}

/// One hypothesis for each edge near the estimate.
void RoadTracker::begin(const Estimate& estimate) {
  const double sigma = std::sqrt(estimate.planarCovariance().topLeftCorner<2, 2>().trace());
  const auto near = network_.candidates(estimate.T_map_body.translation, rules_.sigmas * sigma + 2.0);
  for (const map::Projection& projection : near) {
    if (confirmed_ && !reachable(projection.point, sigma)) continue;
    const auto edge = graph_->edgeAt(projection.point.roadway, projection.point.chainage);
    if (!edge) continue;
    RoadHypothesis h{.path = RoadPath(*graph_, {*edge, Direction::Forward})};
    match(estimate, h);
    if (!h.facing) {
      h.path = RoadPath(*graph_, {*edge, Direction::Backward});
      h.facing = true;
    }
    hypotheses_.push_back(h);
  }
}

void RoadTracker::restart(const Estimate& estimate) {
  hypotheses_.clear();
  outside_since_.reset();
  state_ = MatchState::Lost;
  begin(estimate);
  if (hypotheses_.empty() && confirmed_) {  // it is not where it can be: take what there is
    confirmed_.reset();
    begin(estimate);
  }
  for (RoadHypothesis& h : hypotheses_) match(estimate, h);
  weigh();
}

bool RoadTracker::reachable(const map::TunnelPoint& point, double sigma) const {
  const auto way = graph_->shortestRoute(*confirmed_, point);
  return way && way->length() <= since_confirmed_ + 2.0 * rules_.sigmas * sigma + rules_.reacquire_slack;
}

/// Spec A section 6.3: log-likelihood of the estimate on the hypothesis's road.
void RoadTracker::match(const Estimate& estimate, RoadHypothesis& h) const {
  const Pose2 pose = estimate.T_map_body.planar();
  const Matrix<3, 3> P = estimate.planarCovariance();
  h.foot = h.path.foot(network_, estimate.T_map_body.translation);
  const double turned = wrapAngle(pose.yaw - h.foot.heading);
  if (std::abs(std::cos(turned)) > kSideways) h.facing = std::cos(turned) > 0.0;
  const Eigen::Vector2d t(std::cos(h.foot.heading), std::sin(h.foot.heading));
  const Eigen::Vector2d n(-t.y(), t.x());
  h.along_sigma = std::sqrt(std::max(0.0, t.dot(P.topLeftCorner<2, 2>() * t)));
  h.across_sigma = std::sqrt(std::max(0.0, n.dot(P.topLeftCorner<2, 2>() * n)));
  const double width = network_.map().roadways[h.foot.roadway].width;
  const double across = square(h.foot.offset) / (square(h.across_sigma) + square(width) / 12.0);
  const double heading =
      square(wrapAngle(turned + (h.facing ? 0.0 : kPi))) / (P(2, 2) + square(rules_.heading_sigma));
  const double along = square(h.foot.beyond) / (square(h.along_sigma) + 1.0);  // 1 m: where a road ends
  h.log_likelihood = -0.5 * (across + heading + along);
}

/// A branch within reach becomes a hypothesis, in front and behind.
void RoadTracker::extend(const Estimate& estimate) {
  for (std::size_t i = 0; i < hypotheses_.size() && hypotheses_.size() < rules_.hypotheses_at_most; ++i) {
    const double reach = rules_.sigmas * hypotheses_[i].along_sigma + rules_.look_ahead;
    const RoadPath path = hypotheses_[i].path;
    const double at = hypotheses_[i].foot.distance;
    std::vector<PathLeg> more;
    if (path.end() - at < reach) more = legsFrom(*graph_, path.endNode(), path.legs().back().edge);
    const bool front = !more.empty();
    if (!front && at - path.start() < reach)
      more = legsFrom(*graph_, path.startNode(), path.legs().front().edge);
    if (more.empty()) continue;
    hypotheses_[i].prior /= static_cast<double>(more.size());
    for (std::size_t k = 0; k < more.size(); ++k) {
      RoadHypothesis child = hypotheses_[i];
      child.path = path;
      if (front) child.path.append(more[k]);
      if (!front) child.path.prepend({more[k].edge, opposite(more[k].direction)});
      match(estimate, child);
      if (k == 0) {
        hypotheses_[i] = child;
      } else {
        hypotheses_.push_back(child);
      }
    }
    --i;  // the first child may need more yet
  }
}

void RoadTracker::trim() {
  for (RoadHypothesis& h : hypotheses_) {
    const double reach = rules_.sigmas * h.along_sigma + rules_.look_ahead + kBehind;
    while (h.path.legs().size() > 1 && h.foot.leg > 0 && h.foot.distance - h.path.legStart(1) > reach) {
      h.path.dropFirst();
      --h.foot.leg;
    }
    while (h.path.legs().size() > 1 && h.foot.leg + 1 < h.path.legs().size() &&
           h.path.legStart(h.path.legs().size() - 1) - h.foot.distance > reach)
      h.path.dropLast();
  }
}

/// Hypotheses whose paths have become the same are one.
void RoadTracker::merge() {
  std::vector<RoadHypothesis> kept;
  for (const RoadHypothesis& h : hypotheses_) {
    const auto same =
        std::find_if(kept.begin(), kept.end(), [&](const RoadHypothesis& k) { return k.path == h.path; });
    if (same == kept.end()) {
      kept.push_back(h);
    } else {
      same->prior += h.prior;
    }
  }
  hypotheses_ = std::move(kept);
}

/// The estimate is itself the sum of all that was measured: only the newest one counts, against the prior of
/// each branch.
void RoadTracker::weigh() {
  if (hypotheses_.empty()) return;
  double top = hypotheses_.front().log_likelihood;
  for (const RoadHypothesis& h : hypotheses_) top = std::max(top, h.log_likelihood);
  double sum = 0.0;
  for (RoadHypothesis& h : hypotheses_) {
    h.probability = h.prior * std::exp(h.log_likelihood - top);
    sum += h.probability;
  }
  for (RoadHypothesis& h : hypotheses_) h.probability /= sum;
}

void RoadTracker::commit() {
  if (hypotheses_.empty()) return;
  std::map<std::size_t, double> by_edge;
  for (const RoadHypothesis& h : hypotheses_) by_edge[edgeOf(h)] += h.probability;
  const auto top = std::max_element(by_edge.begin(), by_edge.end(),
                                    [](const auto& a, const auto& b) { return a.second < b.second; });
  if (top->second <= rules_.commit) {
    state_ = MatchState::Branching;
    return;
  }
  state_ = MatchState::Decided;
  std::erase_if(hypotheses_, [&](const RoadHypothesis& h) { return edgeOf(h) != top->first; });
  double sum = 0.0;
  for (const RoadHypothesis& h : hypotheses_) sum += h.prior;
  for (RoadHypothesis& h : hypotheses_) h.prior /= sum;
  weigh();
  const PathFoot& foot = best()->foot;
  confirmed_ = map::TunnelPoint{foot.roadway, foot.chainage, 0.0, 0.0};
  since_confirmed_ = 0.0;
}

void RoadTracker::witness(map::RoadwayIndex roadway, double chainage, double sigma, double ahead) {
  for (RoadHypothesis& h : hypotheses_) {
    const auto at = h.path.distanceOf(roadway, chainage);
    const bool agrees =
        at && std::abs(*at - h.distanceOf(ahead)) <= rules_.sigmas * std::hypot(h.along_sigma, sigma);
    h.prior *= agrees ? 1.0 - rules_.passage_wrong : rules_.passage_wrong;
  }
  double sum = 0.0;
  for (const RoadHypothesis& h : hypotheses_) sum += h.prior;
  for (RoadHypothesis& h : hypotheses_) h.prior /= sum;
  weigh();
  commit();
}

bool RoadTracker::inside(const RoadHypothesis& h) const {
  const double half = 0.5 * network_.map().roadways[h.foot.roadway].width;
  return std::abs(h.foot.offset) <= half + rules_.sigmas * h.across_sigma + kOutsideMargin &&
         std::abs(h.foot.beyond) <= rules_.sigmas * h.along_sigma + rules_.look_ahead;
}

}  // namespace pos::interval
