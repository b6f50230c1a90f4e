#include "pos/interval/lock_site.hpp"

#include <cmath>

#include "pos/core/error.hpp"
#include "pos/interval/lock_events.hpp"

namespace pos::interval {
namespace {

constexpr double kGap = 1e-6;  // m, what rounding may leave between two sections

[[noreturn]] void refuse(const char* what, std::size_t index) {
  throw DataError(Complaint{.what = what, .got = "item " + std::to_string(index) + " of the way"});
}

void checkSections(const Way& way, const LockSite& site) {
  for (std::size_t i = 0; i < way.sections.size(); ++i) {
    const WaySection& s = way.sections[i];
    if (s.section >= site.sections.size()) refuse("the way names a section that the site does not have", i);
    if (!(s.from < s.to)) refuse("a section of the way has no length", i);
    if (i > 0 && std::abs(s.from - way.sections[i - 1].to) > kGap) refuse("the way has a gap", i);
  }
}

void checkStops(const Way& way, const LockSite& site) {
  for (std::size_t k = 0; k < way.stops.size(); ++k) {
    const WayStop& stop = way.stops[k];
    if (stop.stop >= site.stops.size()) refuse("the way names a stop that the site does not have", k);
    if (!(stop.from <= stop.at && stop.at <= stop.to)) refuse("a stop does not hold its own place", k);
    if (k > 0 && stop.at <= way.stops[k - 1].at) refuse("the way's stops are not in driving order", k);
    const bool end = k == 0 || k + 1 == way.stops.size();
    if (end && site.stops[stop.stop].kind != StopPlace::Kind::Depot)
      refuse("the way does not end in a depot", k);
  }
}

}  // namespace

Way validated(Way way, const LockSite& site) {
  if (way.sections.empty()) throw DataError(Complaint{.what = "the way has no sections"});
  if (way.stops.size() < 2) throw DataError(Complaint{.what = "a way begins and ends at a stop"});
  checkSections(way, site);
  checkStops(way, site);
  return way;
}

std::string_view name(LockRecord::Kind kind) {
  using Kind = LockRecord::Kind;
  switch (kind) {
    case Kind::Granted:
      return "granted";
    case Kind::Refused:
      return "refused";
    case Kind::Locked:
      return "locked";
    case Kind::Released:
      return "released";
    case Kind::SlotTaken:
      return "slot_taken";
    case Kind::SlotFreed:
      return "slot_freed";
    case Kind::Stale:
      return "stale";
    case Kind::Doubted:
      return "doubted";
    case Kind::Trusted:
      return "trusted";
    case Kind::Alarmed:
      return "alarmed";
    case Kind::AlarmOver:
      return "alarm_over";
    case Kind::Trespass:
      return "trespass";
    case Kind::Proven:
      return "proven";
    case Kind::Restarted:
      return "restarted";
    case Kind::Overridden:
      return "overridden";
    case Kind::Rejected:
      return "rejected";
  }
  return "?";
}

}  // namespace pos::interval
