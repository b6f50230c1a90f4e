#include <algorithm>
#include <cmath>

#include "blend.hpp"
#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"
#include "pos/sim/motion_plan.hpp"
#include "quadrature.hpp"

namespace pos::sim {
namespace {

/// A stretch of the plan, seen from above: a straight (turn 0) or a bend.
struct PlanPiece {
  double length = 0.0;
  double turn = 0.0;
};

/// A change of grade on [from, to] of chainage, with the grade (rad) after it.
struct VerticalArc {
  double from = 0.0;
  double to = 0.0;
  double radius = 0.0;
  double grade_after = 0.0;
};

/// Distance from the corner to the ends of a bend of unit length: half its chord over cos(turn / 2), for the
/// shape is symmetric.
double unitTangent(double turn, double transition) {
  const auto heading = [&](double u) {
    const double angle = turn * (blendAt(Blend::Trapezoid, transition, u).value - 0.5);
    return std::cos(angle);
  };
  const double chord =
      2.0 * (integral10(heading, 0.0, 0.5 * transition) + integral10(heading, 0.5 * transition, transition) +
             integral10(heading, transition, 0.5));
  return 0.5 * chord / std::cos(0.5 * turn);
}

struct Bend {
  double turn = 0.0;
  double length = 0.0;
  double tangent = 0.0;  ///< m taken from the straight on either side
};

Bend bendAt(const Route& route, std::size_t i) {
  const RoutePoint& before = route.plan[i - 1];
  const RoutePoint& corner = route.plan[i];
  const RoutePoint& after = route.plan[i + 1];
  const double turn = wrapAngle(std::atan2(after.y - corner.y, after.x - corner.x) -
                                std::atan2(corner.y - before.y, corner.x - before.x));
  if (std::abs(turn) < 1e-12) return {};
  const std::string key = indexed("route.plan", i);
  if (std::abs(turn) > radians(170.0)) {
    refuse("the route turns back on itself", key, std::to_string(degrees(turn)) + " deg", "within 170 deg",
           "use two corners");
  }
  requirePositive(corner.radius, key + ".radius");
  const double length = corner.radius * std::abs(turn) / (1.0 - route.transition);
  return {turn, length, length * unitTangent(turn, route.transition)};
}

double legLength(const Route& route, std::size_t i) {
  return std::hypot(route.plan[i + 1].x - route.plan[i].x, route.plan[i + 1].y - route.plan[i].y);
}

std::vector<PlanPiece> planOf(const Route& route) {
  if (route.plan.size() < 2) {
    refuse("a route needs two points", "route.plan", std::to_string(route.plan.size()), "two or more");
  }
  if (!(route.transition >= 0.0 && route.transition <= 0.5)) {
    refuse("the transition is no share of a bend", "route.transition", std::to_string(route.transition),
           "0 to 0.5");
  }
  std::vector<PlanPiece> pieces;
  double taken = 0.0;  // of the leg, by the bend at its start
  for (std::size_t i = 0; i + 1 < route.plan.size(); ++i) {
    const Bend bend = i + 2 < route.plan.size() ? bendAt(route, i + 1) : Bend{};
    const double straight = legLength(route, i) - taken - bend.tangent;
    if (!(straight >= -1e-9)) {
      refuse("the bends at both ends of a leg overlap", indexed("route.plan", i),
             std::to_string(legLength(route, i)) + " m to the next corner",
             "at least " + std::to_string(taken + bend.tangent) + " m", "make the radii smaller");
    }
    const bool goes_on = !pieces.empty() && pieces.back().turn == 0.0;
    if (goes_on) {
      pieces.back().length += straight;
    } else if (straight > 1e-9) {
      pieces.push_back({straight, 0.0});
    }
    if (bend.turn != 0.0) pieces.push_back({bend.length, bend.turn});
    taken = bend.tangent;
  }
  return pieces;
}

double gradeAfter(const std::vector<GradePoint>& profile, std::size_t i) {
  if (profile.size() < 2) return 0.0;
  const std::size_t leg = std::min(i, profile.size() - 2);
  const double run = profile[leg + 1].chainage - profile[leg].chainage;
  if (!(run > 0.0)) {
    refuse("the profile does not ascend", indexed("route.profile", leg + 1) + ".chainage",
           std::to_string(profile[leg + 1].chainage), "more than " + std::to_string(profile[leg].chainage));
  }
  return std::atan2(profile[leg + 1].z - profile[leg].z, run);
}

std::vector<VerticalArc> verticalArcs(const std::vector<GradePoint>& profile) {
  std::vector<VerticalArc> arcs;
  double free_from = 0.0;
  for (std::size_t i = 1; i + 1 < profile.size(); ++i) {
    const double before = gradeAfter(profile, i - 1);
    const double after = gradeAfter(profile, i);
    if (std::abs(after - before) < 1e-12) continue;
    const std::string key = indexed("route.profile", i);
    requirePositive(profile[i].radius, key + ".radius");
    const double tangent = profile[i].radius * std::tan(0.5 * std::abs(after - before));
    const VerticalArc arc{.from = profile[i].chainage - tangent * std::cos(before),
                          .to = profile[i].chainage + tangent * std::cos(after),
                          .radius = profile[i].radius,
                          .grade_after = after};
    if (arc.from < free_from - 1e-9) {
      refuse("two changes of grade overlap", key, std::to_string(arc.from) + " m",
             "after " + std::to_string(free_from) + " m", "make the radii smaller");
    }
    free_from = arc.to;
    arcs.push_back(arc);
  }
  return arcs;
}

/// Walks along the plan and lays the changes of grade into its straights.
class Router {
 public:
  Router(const Route& route, double grade)
      : transition_(route.transition), arcs_(verticalArcs(route.profile)), grade_(grade) {}

  void addStraight(double length) {
    const double end = chainage_ + length;
    while (next_ < arcs_.size() && arcs_[next_].to <= end + 1e-9) {
      const VerticalArc& arc = arcs_[next_++];
      if (arc.from < chainage_ - 1e-9) refuseArc(arc);
      goTo(arc.from);
      const double climb = arc.grade_after - grade_;
      path_.push_back({.length = arc.radius * std::abs(climb), .climb = {.by = climb}});
      grade_ = arc.grade_after;
      chainage_ = arc.to;
    }
    goTo(end);
  }

  void addBend(const PlanPiece& bend) {
    const double length = bend.length / std::cos(grade_);
    chainage_ += bend.length;
    if (next_ < arcs_.size() && arcs_[next_].from < chainage_ - 1e-9) refuseArc(arcs_[next_]);
    Change turn{.by = bend.turn};
    if (transition_ > 0.0) turn = {.by = bend.turn, .blend = Blend::Trapezoid, .ramp = transition_ * length};
    path_.push_back({.length = length, .turn = turn});
  }

  std::vector<PathElement> path() const { return path_; }
  /// Throws when a change of grade has found no straight.
  void requireAllLaid() const {
    if (next_ < arcs_.size()) refuseArc(arcs_[next_]);
  }

 private:
  [[noreturn]] static void refuseArc(const VerticalArc& arc) {
    refuse("a change of grade lies in a bend, or beyond the ends", "route.profile",
           std::to_string(arc.from) + " to " + std::to_string(arc.to) + " m of chainage",
           "a straight that holds the whole vertical arc", "move the grade point or make its radius smaller");
  }

  void goTo(double chainage) {
    const double length = (chainage - chainage_) / std::cos(grade_);
    if (length > 1e-9) path_.push_back({.length = length});
    chainage_ = chainage;
  }

  double transition_;
  std::vector<VerticalArc> arcs_;
  double grade_;
  double chainage_ = 0.0;
  std::size_t next_ = 0;
  std::vector<PathElement> path_;
};

}  // namespace

RoutedPath routed(const Route& route) {
  const std::vector<PlanPiece> plan = planOf(route);
  if (!route.profile.empty() && route.profile.front().chainage != 0.0) {
    refuse("the profile does not start with the route", "route.profile[0].chainage",
           std::to_string(route.profile.front().chainage), "0");
  }
  RoutedPath result;
  const double z = route.profile.empty() ? 0.0 : route.profile.front().z;
  result.start.p_map = {route.plan[0].x, route.plan[0].y, z};
  result.start.heading = std::atan2(route.plan[1].y - route.plan[0].y, route.plan[1].x - route.plan[0].x);
  result.start.pitch = gradeAfter(route.profile, 0);
  Router router(route, result.start.pitch);
  for (const PlanPiece& piece : plan) {
    if (piece.turn == 0.0) {
      router.addStraight(piece.length);
    } else {
      router.addBend(piece);
    }
  }
  router.requireAllLaid();
  result.path = router.path();
  for (const PathElement& element : result.path) result.length += *element.length;
  return result;
}

std::unique_ptr<Motion> makeRouteMotion(const RouteMotionConfig& config) {
  const RoutedPath path = routed(config.route);
  return makePathMotion({.start = path.start, .path = path.path, .drive = config.drive});
}

std::unique_ptr<Motion> makeMotion(const MotionConfig& config) {
  struct Maker {
    std::unique_ptr<Motion> operator()(const SegmentMotionConfig& c) const { return makeSegmentMotion(c); }
    std::unique_ptr<Motion> operator()(const PathMotionConfig& c) const { return makePathMotion(c); }
    std::unique_ptr<Motion> operator()(const RouteMotionConfig& c) const { return makeRouteMotion(c); }
    std::unique_ptr<Motion> operator()(const ShearerConfig& c) const { return makeShearerMotion(c); }
  };
  return std::visit(Maker{}, config);
}

}  // namespace pos::sim
