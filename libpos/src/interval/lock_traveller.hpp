#pragma once
/// What the engine keeps of one vehicle.

#include <optional>
#include <vector>

#include "pos/interval/lock_engine.hpp"
#include "pos/interval/position_trust.hpp"

namespace pos::interval {

struct Traveller {
  Traveller(const Enrol& enrol, const LockRules& rules) : shape(enrol), trust(rules, enrol.max_speed) {}

  Enrol shape;
  PositionTrust trust;
  Way way = {};
  std::size_t stop = 0;               ///< index into way.stops it may drive to
  std::vector<char> held = {};        ///< of each section of the way
  double rear_limit = 0.0;            ///< m, nothing of it is behind
  double authority = 0.0;             ///< m, the end of what it holds in front
  std::optional<TrackPoint> last;     ///< newest report of this way, believed or not
  std::optional<Stamp> strayed = {};  ///< when it was last where it must not be, or may have been
  Stamp heard = {};
  Stamp waiting_since = {};
  bool on_road = false;
  bool waiting = false;
  bool alarmed = false;
  bool stale = false;
  bool accounted = true;  ///< has told where it is since the last restart

  bool hasWay() const { return !way.stops.empty(); }
  double length() const { return shape.front + shape.rear; }
  bool believed() const { return !on_road || (trust.trusted() && trust.believed() && !alarmed && !stale); }
  /// m to its stop, from the newest believed report.
  double stillToGo() const {
    const double at = trust.believed() ? trust.believed()->distance : rear_limit;
    return way.stops[stop].at - at;
  }
  /// m, its one-sigma uncertainty.
  double placeSigma() const { return trust.believed() ? trust.believed()->sigma : 0.0; }
  LockHolder holder(std::size_t index) const { return {shape.vehicle, way.sections[index].movement}; }
};

/// Indices of a way's sections that [from, to] touches, first and one past the last.
struct SectionRange {
  std::size_t first = 0;
  std::size_t last = 0;
};
SectionRange touched(const Way& way, double from, double to);

}  // namespace pos::interval
