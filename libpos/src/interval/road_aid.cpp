#include "pos/interval/road_aid.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"
#include "road_fix.hpp"

namespace pos::interval {

RoadAidRules validated(RoadAidRules rules) {
  requirePositive(rules.rate, "rate", "Hz");
  requirePositive(rules.min_move, "min_move", "m");
  requirePositive(rules.heading_sigma, "heading_sigma", "rad");
  requirePositive(rules.loose, "loose", "m");
  requirePositive(rules.vertical_sigma, "vertical_sigma", "m");
  requireNotNegative(rules.correlation, "correlation", "m");
  requirePositive(rules.gate_sigmas, "gate_sigmas");
  requireNotNegative(rules.straight, "straight", "1/m");
  return rules;
}

RoadAid::RoadAid(const map::Network& network, const RoadAidRules& rules)
    : network_(network), rules_(validated(rules)) {}

std::optional<Measurement> RoadAid::offered(const Estimate& estimate, const RoadTracker& road) {
  if (road.state() != MatchState::Decided) return std::nullopt;
  const RoadHypothesis& on = *road.best();
  const double moved = road.travelled() - last_travelled_;
  if (last_ && (seconds(estimate.stamp - *last_) < 1.0 / rules_.rate || moved < rules_.min_move))
    return std::nullopt;
  if (std::abs(on.foot.curvature) > rules_.straight || on.foot.beyond != 0.0) return std::nullopt;
  const map::Roadway& roadway = network_.map().roadways[on.foot.roadway];
  PlaceAcross across = placeInLane(roadway, network_.map().driving_side, on.facing);
  if (std::abs(on.foot.offset - across.offset) >
      rules_.gate_sigmas * std::hypot(across.sigma, on.across_sigma))
    return std::nullopt;
  const double alike = last_ ? std::max(1.0, rules_.correlation / moved) : 1.0;
  const double raised = std::sqrt(alike);
  last_ = estimate.stamp;
  last_travelled_ = road.travelled();
  across.sigma *= raised;
  PassageFix fix = roadFix(on, rules_.loose, across, rules_.vertical_sigma);
  fix.place = "roadway " + roadway.id;
  fix.yaw = wrapAngle(on.foot.heading + (on.facing ? 0.0 : kPi));
  fix.yaw_sigma = raised * rules_.heading_sigma;
  return Measurement{estimate.stamp, kRoadSensor, fix};
}

}  // namespace pos::interval
