#include "pos/interval/passages.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"
#include "road_fix.hpp"

namespace pos::interval {
namespace {

constexpr double kSamePlace = 1.0;  // m, chambers nearer to each other (on the two sides) give the same fix

}  // namespace

PassageRules validated(PassageRules rules) {
  requirePositive(rules.gate_sigmas, "gate_sigmas");
  requireNotNegative(rules.stamp_sigma, "stamp_sigma", "s");
  requireNotNegative(rules.missed_margin, "missed_margin", "m");
  requireNotNegative(rules.repeat_within, "repeat_within", "m");
  requireNotNegative(rules.odometer_scale, "odometer_scale");
  requirePositive(rules.vertical_sigma, "vertical_sigma", "m");
  return rules;
}

std::string_view name(PassageVerdict verdict) {
  switch (verdict) {
    case PassageVerdict::Accepted:
      return "accepted";
    case PassageVerdict::UnknownChamber:
      return "unknown_chamber";
    case PassageVerdict::NoPosition:
      return "no_position";
    case PassageVerdict::NotOnTheWay:
      return "not_on_the_way";
    case PassageVerdict::OutOfReach:
      return "out_of_reach";
    case PassageVerdict::Ambiguous:
      return "ambiguous";
    case PassageVerdict::Repeated:
      return "repeated";
  }
  return "?";
}

PassageCheck::PassageCheck(const map::Network& network, const PassageRules& rules)
    : network_(network), rules_(validated(rules)) {
  for (const map::Chamber& chamber : network_.map().chambers)
    places_.push_back({&chamber, network_.indexOf(chamber.place.roadway)});
}

const PassageCheck::Place* PassageCheck::find(const std::string& chamber) const {
  const auto found =
      std::find_if(places_.begin(), places_.end(), [&](const Place& p) { return p.chamber->id == chamber; });
  return found != places_.end() ? &*found : nullptr;
}

/// sigma_c + v sigma_t, spec A section 6.4.
double PassageCheck::sigmaOf(const Place& place, const RoadTracker& road) const {
  return place.chamber->detection_sigma + std::abs(road.speed()) * rules_.stamp_sigma;
}

/// Whether some other chamber could be meant as well.
bool PassageCheck::ambiguous(const Remembered& now, double reader, const RoadHypothesis& on,
                             double reach) const {
  return std::any_of(places_.begin(), places_.end(), [&](const Place& other) {
    if (other.chamber == now.place.chamber) return false;
    const auto there = on.path.distanceOf(other.roadway, other.chamber->place.chainage);
    return there && std::abs(*there - reader) <= reach && std::abs(*there - now.at) > kSamePlace;
  });
}

/// Whether a remembered doubtful sighting and this one are as far apart as the vehicle has driven.
bool PassageCheck::confirmed(const Remembered& now) const {
  if (!doubtful_ || doubtful_->place.chamber == now.place.chamber) return false;
  const double driven = now.travelled - doubtful_->travelled;
  const double sigma = std::hypot(rules_.odometer_scale * driven, std::hypot(now.sigma, doubtful_->sigma));
  return std::abs(std::abs(now.at - doubtful_->at) - driven) <= rules_.gate_sigmas * sigma;
}

/// On two lanes the chambers of the other side belong to the other lane.
bool PassageCheck::ownSide(const Place& place, const RoadHypothesis& on) const {
  if (network_.map().roadways[place.roadway].lanes == 1) return true;
  const double turned =
      wrapAngle(on.foot.heading - network_.centreline(on.foot.roadway).at(on.foot.chainage).heading);
  const bool forward = (std::abs(turned) < 0.5 * kPi) == on.facing;
  return (place.chamber->side == network_.map().driving_side) == forward;
}

Measurement PassageCheck::fixFor(const Remembered& now, const RoadHypothesis& on,
                                 const ChamberSighting& sighting) const {
  const Place& place = now.place;
  RoadHypothesis there = on;
  const map::CentrelineState state = network_.centreline(place.roadway).at(place.chamber->place.chainage);
  there.foot.p_map = state.p_map;
  there.foot.heading = state.heading;
  there.foot.distance = now.at;
  PassageFix fix = roadFix(there, now.sigma, anywhereBetweenTheWalls(network_.map().roadways[place.roadway]),
                           rules_.vertical_sigma);
  fix.place = place.chamber->id;
  fix.p_body = sighting.p_body;
  return {sighting.stamp, kPassageSensor, fix};
}

Passage PassageCheck::judged(const ChamberSighting& sighting, RoadTracker& road) {
  const Place* place = find(sighting.chamber);
  if (place == nullptr) return {.verdict = PassageVerdict::UnknownChamber};
  if (road.best() == nullptr) return {.verdict = PassageVerdict::NoPosition};
  const RoadHypothesis* on = nullptr;  // the most probable one that passes the chamber
  for (const RoadHypothesis& h : road.hypotheses()) {
    if (h.path.distanceOf(place->roadway, place->chamber->place.chainage) &&
        (on == nullptr || h.probability > on->probability))
      on = &h;
  }
  if (on == nullptr) return {.verdict = PassageVerdict::NotOnTheWay};

  const double at = *on->path.distanceOf(place->roadway, place->chamber->place.chainage);
  const double sigma = sigmaOf(*place, road);
  const double ahead = sighting.p_body.x();
  const double reader = on->distanceOf(ahead);
  Passage passage{.off = at - reader, .off_sigma = std::hypot(on->along_sigma, sigma)};
  const Remembered now{*place, road.travelled(), at, sigma};
  const double reach = rules_.gate_sigmas * passage.off_sigma;
  if (accepted_ && accepted_->place.chamber == place->chamber &&
      now.travelled - accepted_->travelled < rules_.repeat_within) {
    passage.verdict = PassageVerdict::Repeated;
    return passage;
  }
  if (std::abs(passage.off) > reach) {
    passage.verdict = PassageVerdict::OutOfReach;
    return passage;
  }
  if (ambiguous(now, reader, *on, reach) && !confirmed(now)) {
    passage.verdict = PassageVerdict::Ambiguous;
    doubtful_ = now;
    return passage;
  }
  passage.verdict = PassageVerdict::Accepted;
  passage.fix = fixFor(now, *on, sighting);
  accepted_ = now;
  doubtful_.reset();
  seen_.push_back(place->chamber->id);
  road.witness(place->roadway, place->chamber->place.chainage, sigma, ahead);
  return passage;
}

std::vector<std::string> PassageCheck::missed(const RoadTracker& road) {
  if (road.state() != MatchState::Decided) {
    watched_to_.reset();
    return {};
  }
  const RoadHypothesis& on = *road.best();
  const double behind = rules_.gate_sigmas * on.along_sigma + rules_.missed_margin;
  const double sign = on.facing == (road.speed() >= 0.0) ? 1.0 : -1.0;
  const double to = on.foot.distance - sign * behind;
  const double from = watched_to_.value_or(to);
  if (watched_to_ && sign * (to - from) <= 0.0) return {};
  watched_to_ = to;
  std::vector<std::string> missed;
  const auto [low, high] = std::minmax(from, to);
  for (const Place& place : places_) {
    const auto at = on.path.distanceOf(place.roadway, place.chamber->place.chainage);
    if (!at || *at <= low || *at > high || !ownSide(place, on)) continue;
    if (std::erase(seen_, place.chamber->id) == 0) missed.push_back(place.chamber->id);
  }
  return missed;
}

}  // namespace pos::interval
