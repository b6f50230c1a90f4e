#include "pos/interval/lock_safety.hpp"

#include <algorithm>
#include <cmath>

namespace pos::interval {
namespace {

bool waitsOnRoad(const LockSite& site, const Settled& v) {
  return site.stops[v.way->stops[v.stop].stop].kind == StopPlace::Kind::OnRoad;
}

/// Whether `other` stands in the way of `v` between v's stop and the end of v's way.
bool inTheWay(const LockSite& site, const Settled& v, const Settled& other) {
  if (!waitsOnRoad(site, other)) return false;
  const std::size_t place = other.way->stops[other.stop].stop;
  if (v.way->stops[v.stop].stop == place)
    return other.still_to_go < v.still_to_go + std::hypot(v.spread, other.spread);
  return std::any_of(v.way->stops.begin() + static_cast<std::ptrdiff_t>(v.stop) + 1, v.way->stops.end(),
                     [&](const WayStop& ahead) { return ahead.stop == place; });
}

}  // namespace

bool everybodyCanFinish(const LockSite& site, const std::vector<Settled>& vehicles) {
  std::vector<const Settled*> left;
  for (const Settled& v : vehicles) left.push_back(&v);
  while (!left.empty()) {
    const auto free = std::find_if(left.begin(), left.end(), [&](const Settled* v) {
      return std::none_of(left.begin(), left.end(),
                          [&](const Settled* other) { return other != v && inTheWay(site, *v, *other); });
    });
    if (free == left.end()) return false;
    left.erase(free);
  }
  return true;
}

}  // namespace pos::interval
