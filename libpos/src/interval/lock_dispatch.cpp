#include "lock_dispatch.hpp"

#include <algorithm>
#include <cmath>

#include "pos/interval/lock_safety.hpp"

namespace pos::interval {

SectionRange touched(const Way& way, double from, double to) {
  constexpr double kTouch = 1e-6;  // m, what rounding may make of a common end
  const auto first = std::find_if(way.sections.begin(), way.sections.end(),
                                  [&](const WaySection& s) { return s.to > from + kTouch; });
  const auto last =
      std::find_if(first, way.sections.end(), [&](const WaySection& s) { return s.from >= to - kTouch; });
  return {static_cast<std::size_t>(first - way.sections.begin()),
          static_cast<std::size_t>(last - way.sections.begin())};
}

int LockDispatch::rank(const Traveller& v, Stamp now) const {
  return v.shape.priority - static_cast<int>(std::floor(seconds(now - v.waiting_since) / rules_->aging));
}

SectionRange LockDispatch::sectionsTo(const Traveller& v, std::size_t k) const {
  const double from = v.on_road ? v.authority : v.way.stops[v.stop].from;
  return touched(v.way, from, v.way.stops[k].to);
}

/// A vehicle in doubt may also be where its reports say.
std::optional<VehicleId> LockDispatch::shadow(const Traveller& v, std::size_t section, int movement) const {
  for (const auto& [id, other] : *all_) {
    if (&other == &v || !other.on_road || other.trust.trusted() || !other.last) continue;
    const double spread = rules_->footprint_sigmas * other.last->sigma;
    const SectionRange range = touched(other.way, other.last->distance - other.shape.rear - spread,
                                       other.last->distance + other.shape.front + spread);
    for (std::size_t i = range.first; i < range.last; ++i) {
      if (other.way.sections[i].section == section && other.way.sections[i].movement != movement) return id;
    }
  }
  return std::nullopt;
}

std::optional<Obstacle> LockDispatch::onTheRoad(const Traveller& v, std::size_t k,
                                                const std::vector<Claim>& claims) const {
  const SectionRange range = sectionsTo(v, k);
  for (std::size_t i = range.first; i < range.last; ++i) {
    const std::size_t section = v.way.sections[i].section;
    if (const auto other = book_->opponent(section, v.holder(i)))
      return Obstacle{Obstacle::Kind::Road, *other, "the road is held for another movement"};
    if (const auto other = shadow(v, section, v.way.sections[i].movement))
      return Obstacle{Obstacle::Kind::Road, *other, "a vehicle in doubt may be on the road"};
  }
  return againstClaims(v, range, claims);
}

/// Whether `v` itself holds what the owner of the claim waits for.
bool LockDispatch::blocks(const Traveller& v, const Claim& claim) const {
  return std::any_of(claim.sections.begin(), claim.sections.end(), [&](const auto& wanted) {
    const auto& holders = book_->holders(wanted.first);
    return std::any_of(holders.begin(), holders.end(), [&](const LockHolder& h) {
      return h.vehicle == v.shape.vehicle && h.movement != wanted.second;
    });
  });
}

std::optional<Obstacle> LockDispatch::againstClaims(const Traveller& v, SectionRange range,
                                                    const std::vector<Claim>& claims) const {
  for (const Claim& claim : claims) {
    if (!claim.patient && claim.rank >= v.shape.priority) continue;
    if (blocks(v, claim)) continue;  // v has to get out of the way first
    for (std::size_t i = range.first; i < range.last; ++i) {
      const WaySection& mine = v.way.sections[i];
      const bool opposed = std::any_of(claim.sections.begin(), claim.sections.end(), [&](const auto& wanted) {
        return wanted.first == mine.section && wanted.second != mine.movement;
      });
      if (opposed)
        return Obstacle{Obstacle::Kind::Road, claim.owner, "it yields to a vehicle that goes first"};
    }
  }
  return std::nullopt;
}

/// Another vehicle whose leave to drive ends at this place on the road.
std::optional<VehicleId> LockDispatch::waiterAt(const Traveller& v, std::size_t place) const {
  for (const auto& [id, other] : *all_) {
    if (&other != &v && other.on_road && other.way.stops[other.stop].stop == place) return id;
  }
  return std::nullopt;
}

std::optional<VehicleId> LockDispatch::inFrontInQueue(const Traveller& v) const {
  if (!v.on_road || kindOf(v, v.stop) != StopPlace::Kind::OnRoad) return std::nullopt;
  const std::size_t place = v.way.stops[v.stop].stop;
  for (const auto& [id, other] : *all_) {
    if (&other == &v || !other.on_road || other.way.stops[other.stop].stop != place) continue;
    const double spread = rules_->footprint_sigmas * std::hypot(v.placeSigma(), other.placeSigma());
    if (!other.believed() || other.stillToGo() < v.stillToGo() + spread)
      return id;  // it is, or may be, in front
  }
  return std::nullopt;
}

/// Another vehicle that may drive on beyond this place on the road and has not passed it yet.
std::optional<VehicleId> LockDispatch::passingThrough(const Traveller& v, std::size_t place) const {
  for (const auto& [id, other] : *all_) {
    if (&other == &v || !other.on_road) continue;
    for (std::size_t j = 0; j < other.stop; ++j) {
      if (other.way.stops[j].stop == place && other.rear_limit < other.way.stops[j].to) return id;
    }
  }
  return std::nullopt;
}

std::optional<Obstacle> LockDispatch::atTheStops(const Traveller& v, std::size_t k) const {
  using Kind = StopPlace::Kind;
  if (const auto other = inFrontInQueue(v))
    return Obstacle{Obstacle::Kind::Place, *other, "another vehicle waits in front of it"};
  for (std::size_t j = v.stop + 1; j < k; ++j) {
    if (kindOf(v, j) != Kind::OnRoad) continue;
    if (const auto other = waiterAt(v, v.way.stops[j].stop))
      return Obstacle{Obstacle::Kind::Place, *other, "another vehicle waits on the road"};
  }
  const std::size_t place = v.way.stops[k].stop;
  if (!book_->room(place, v.length(), rules_->gap_between))
    return Obstacle{Obstacle::Kind::Place, -1, "no room at the next stop"};
  if (kindOf(v, k) == Kind::OnRoad) {
    if (const auto other = passingThrough(v, place))
      return Obstacle{Obstacle::Kind::Place, *other, "another vehicle is to pass the stop first"};
  }
  return std::nullopt;
}

/// Only a stop on the road can make things worse: from a niche or depot a vehicle is in nobody's way, and
/// what is left of its own way has become shorter.
std::optional<Obstacle> LockDispatch::safety(const Traveller& v, std::size_t k) const {
  if (kindOf(v, k) != StopPlace::Kind::OnRoad) return std::nullopt;
  std::vector<Settled> settled;
  for (const auto& [id, other] : *all_) {
    if (!other.hasWay() || (&other != &v && !other.on_road)) continue;
    if (&other != &v && !other.believed() && waiterAt(other, other.way.stops[other.stop].stop))
      return Obstacle{Obstacle::Kind::Deadlock, id, "the order of a queue is not known"};
    const double shift = &other == &v ? v.way.stops[k].at - v.way.stops[v.stop].at : 0.0;
    settled.push_back({&other.way, &other == &v ? k : other.stop, other.stillToGo() + shift,
                       rules_->footprint_sigmas * other.placeSigma()});
  }
  if (everybodyCanFinish(*site_, settled)) return std::nullopt;
  return Obstacle{Obstacle::Kind::Deadlock, -1, "afterwards some could not go on"};
}

std::variant<std::size_t, Obstacle> LockDispatch::decided(const Traveller& v,
                                                          const std::vector<Claim>& claims) const {
  if (!v.believed()) return Obstacle{Obstacle::Kind::Place, v.shape.vehicle, "its own position is not known"};
  std::optional<Obstacle> first;
  for (std::size_t k = v.stop + 1; k < v.way.stops.size(); ++k) {
    std::optional<Obstacle> obstacle = onTheRoad(v, k, claims);
    const bool road = obstacle.has_value();
    if (!obstacle) obstacle = atTheStops(v, k);
    if (!obstacle) obstacle = safety(v, k);
    if (!obstacle) return k;
    if (!first) first = std::move(obstacle);
    if (road) break;  // what blocks the road to this stop blocks it to the next
  }
  return *first;
}

std::optional<Claim> LockDispatch::claimOf(const Traveller& v, Stamp now) const {
  if (!v.believed()) return std::nullopt;
  for (std::size_t k = v.stop + 1; k < v.way.stops.size(); ++k) {
    if (atTheStops(v, k) || safety(v, k)) continue;
    Claim claim{.owner = v.shape.vehicle,
                .rank = rank(v, now),
                .patient = seconds(now - v.waiting_since) >= rules_->patience};
    const SectionRange range = sectionsTo(v, k);
    for (std::size_t i = range.first; i < range.last; ++i)
      claim.sections.emplace_back(v.way.sections[i].section, v.way.sections[i].movement);
    return claim;
  }
  return std::nullopt;
}

}  // namespace pos::interval
