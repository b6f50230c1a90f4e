#include "pos/interval/lock_audit.hpp"

#include <algorithm>
#include <cmath>

namespace pos::interval {
namespace {
using Kind = LockRecord::Kind;

constexpr double kRounding = 1e-6;  // m
}  // namespace

LockAudit::LockAudit(std::shared_ptr<const LockSite> site, const LockRules& rules)
    : site_(std::move(site)), rules_(validated(rules)), guests_(site_->stops.size()) {}

void LockAudit::find(VehicleId vehicle, std::string what) {
  findings_.push_back({now_, vehicle, std::move(what)});
}

void LockAudit::take(const LockEvent& event, const std::vector<LockRecord>& records) {
  ++tally_.events;
  if (event.stamp < now_) find(-1, "stamps go back");
  now_ = std::max(now_, event.stamp);
  trespassed_.clear();
  rejected_ = std::any_of(records.begin(), records.end(),
                          [](const LockRecord& r) { return r.kind == Kind::Rejected; });
  tally_.rejected += rejected_ ? 1 : 0;
  for (auto& [id, v] : seen_) v.heard_before = v.heard;
  if (!rejected_) note(event);
  for (const LockRecord& record : records) check(event, record);
  checkWhole(event, records);
}

// --- What the events alone tell

void LockAudit::note(const LockEvent& event) {
  std::visit([this](const auto& what) { note(what); }, event.what);
}
void LockAudit::note(const Enrol& e) {
  seen_[e.vehicle].shape = e;
}
void LockAudit::note(const Begin& e) {
  Seen& v = seen_[e.vehicle];
  v.way = e.way;
  v.stop = 0;
}
void LockAudit::note(const Request& e) {
  ++tally_.requests;
  if (!seen_[e.vehicle].asked) seen_[e.vehicle].asked = now_;
}
void LockAudit::note(const Report& e) {
  seen_[e.vehicle].report = e;
  seen_[e.vehicle].heard = now_;
}
void LockAudit::note(const Parked& e) {
  Seen& v = seen_[e.vehicle];
  v.on_road = v.doubted = false;
  v.report.reset();
  v.stop = e.stop;
  if (e.stop + 1 == v.way.stops.size()) v.way = {};
}
void LockAudit::note(const Restart&) {
  ++tally_.restarts;
  for (auto& guests : guests_) guests.clear();
  missing_.clear();
  for (auto& [id, v] : seen_) {
    const Enrol shape = v.shape;
    v = {};
    v.shape = shape;
    missing_.push_back(id);
  }
}
void LockAudit::note(const Announce& e) {
  std::erase(missing_, e.vehicle);
  Seen& v = seen_[e.vehicle];
  v.way = e.way;
  v.doubted = !e.parked && !e.way.stops.empty();  // it has to show steady reports first
  v.on_road = v.doubted;
  v.heard = now_;
  if (!e.way.stops.empty()) v.stop = e.stop;
}

// --- What the records claim

void LockAudit::check(const LockEvent& event, const LockRecord& record) {
  Seen& v = seen_[record.vehicle];
  switch (record.kind) {
    case Kind::Locked:
      locked(record);
      break;
    case Kind::Released:
      released(event, record);
      break;
    case Kind::Granted:
      granted(record);
      break;
    case Kind::SlotTaken:
    case Kind::SlotFreed:
      slot(record);
      break;
    case Kind::Doubted:
      v.doubted = true;
      ++tally_.doubts;
      break;
    case Kind::Trusted:
      v.doubted = false;
      break;
    case Kind::Stale:
      ++tally_.stale;
      if (seconds(now_ - v.heard_before) <= rules_.stale_after)
        find(record.vehicle, "called stale too early");
      break;
    case Kind::Trespass:
      ++tally_.trespasses;
      trespassed_.push_back(record.section);
      break;
    case Kind::Overridden:
      ++tally_.overrides;
      break;
    case Kind::Proven:
      if (!missing_.empty()) find(missing_.front(), "proven although this vehicle has not announced itself");
      break;
    case Kind::Refused:
    case Kind::Alarmed:
    case Kind::AlarmOver:
    case Kind::Restarted:
    case Kind::Rejected:
      break;
  }
  seen_.erase(-1);
}

void LockAudit::locked(const LockRecord& record) {
  ++tally_.locks;
  const bool trespass =
      std::find(trespassed_.begin(), trespassed_.end(), record.section) != trespassed_.end();
  for (const auto& [id, other] : seen_) {
    if (id == record.vehicle || trespass) continue;
    const auto [first, last] = other.held.equal_range(record.section);
    for (auto h = first; h != last; ++h) {
      if (h->second != record.movement) {
        find(record.vehicle,
             "opposes vehicle " + std::to_string(id) + " on " + site_->sections[record.section].id);
      }
    }
  }
  seen_[record.vehicle].held.emplace(record.section, record.movement);
}

void LockAudit::released(const LockEvent& event, const LockRecord& record) {
  ++tally_.releases;
  Seen& v = seen_[record.vehicle];
  const auto [first, last] = v.held.equal_range(record.section);
  const auto mine = std::find_if(first, last, [&](const auto& h) { return h.second == record.movement; });
  if (mine == last) return find(record.vehicle, "releases what it does not hold");
  v.held.erase(mine);
  if (const auto* parked = std::get_if<Parked>(&event.what); parked && parked->vehicle == record.vehicle)
    return;
  if (const auto* order = std::get_if<Override>(&event.what);
      order && order->vehicle == record.vehicle && !order->who.empty() && !order->why.empty())
    return;
  const auto* report = std::get_if<Report>(&event.what);
  if (report == nullptr || report->vehicle != record.vehicle)
    return find(record.vehicle, "releases without a report of its own");
  checkClear(record, *report);
}

/// The rear has to be clear of the section by the footprint and the hysteresis, on a position worth
/// believing.
void LockAudit::checkClear(const LockRecord& record, const Report& report) {
  Seen& v = seen_[record.vehicle];
  if (report.integrity == Report::Integrity::Alarm) find(record.vehicle, "releases during an alarm");
  if (v.doubted) find(record.vehicle, "releases while in doubt");
  const double rear = report.distance - v.shape.rear - rules_.footprint_sigmas * report.sigma;
  const double hysteresis = rules_.release_sigmas * report.sigma + rules_.release_margin;
  const double front = report.distance + v.shape.front + rules_.footprint_sigmas * report.sigma;
  const bool clear = std::any_of(v.way.sections.begin(), v.way.sections.end(), [&](const WaySection& s) {
    return s.section == record.section && s.movement == record.movement &&
           (s.to <= rear - hysteresis + kRounding || s.from >= front - kRounding);
  });
  if (!clear)
    find(record.vehicle, "releases " + site_->sections[record.section].id + " before its rear has cleared");
  if (v.cleared && report.evidence == Report::Evidence::Estimate) {
    const double reach = v.shape.max_speed * seconds(now_ - v.cleared->first) +
                         rules_.jump_sigmas * (report.sigma + v.cleared->second.sigma);
    if (std::abs(report.distance - v.cleared->second.distance) > reach + kRounding)
      find(record.vehicle, "releases from where it cannot have come");
  }
  v.cleared = {now_, report};
}

void LockAudit::granted(const LockRecord& record) {
  ++tally_.granted;
  Seen& v = seen_[record.vehicle];
  if (!missing_.empty()) find(record.vehicle, "granted before everybody is accounted for");
  if (!v.asked) {
    find(record.vehicle, "granted without a request");
  } else {
    tally_.waits.push_back(seconds(now_ - *v.asked));
    tally_.granted_at_once += now_ == *v.asked ? 1 : 0;
  }
  if (v.on_road && seconds(now_ - v.heard) > rules_.stale_after)
    find(record.vehicle, "granted on a stale position");
  if (v.on_road && v.doubted) find(record.vehicle, "granted while in doubt");
  if (v.on_road && v.report && v.report->integrity == Report::Integrity::Alarm)
    find(record.vehicle, "granted during an alarm");
  const std::size_t from = v.stop.value_or(0);
  if (v.on_road) {
    v.granted_from = v.report ? v.report->distance : v.granted_from;
  } else {
    v.granted_from = v.way.stops[from].from;
    v.heard = now_;
    v.report.reset();
    v.cleared.reset();
  }
  v.asked.reset();
  v.on_road = true;
  for (std::size_t k = from + 1; k < v.way.stops.size(); ++k) {
    if (v.way.stops[k].stop != record.stop) continue;
    v.stop = k;
    return;
  }
  find(record.vehicle, "granted a stop that is not ahead on its way");
}

void LockAudit::slot(const LockRecord& record) {
  auto& guests = guests_[record.stop];
  const auto mine =
      std::find_if(guests.begin(), guests.end(), [&](const Guest& g) { return g.vehicle == record.vehicle; });
  if (record.kind == Kind::SlotFreed) {
    if (mine == guests.end()) return find(record.vehicle, "frees room it did not have");
    guests.erase(mine);
    return;
  }
  if (mine != guests.end()) find(record.vehicle, "has room there already");
  const Enrol& shape = seen_[record.vehicle].shape;
  guests.push_back({record.vehicle, shape.front + shape.rear});
  double used = -rules_.gap_between;
  for (const Guest& guest : guests) used += guest.length + rules_.gap_between;
  const StopPlace& place = site_->stops[record.stop];
  if (used > place.length + kRounding || static_cast<int>(guests.size()) > place.capacity)
    find(record.vehicle, "more vehicles in " + place.id + " than it holds");
}

// --- What has to hold once the event is done

void LockAudit::checkWhole(const LockEvent& event, const std::vector<LockRecord>& records) {
  if (const auto* report = std::get_if<Report>(&event.what); report && !rejected_) checkBody(*report);
  if (const auto* parked = std::get_if<Parked>(&event.what); parked && !rejected_) {
    const Seen& v = seen_[parked->vehicle];
    if (!v.on_road && !v.held.empty()) find(parked->vehicle, "parked and still holds road");
  }
  if (const auto* order = std::get_if<Override>(&event.what); order && !rejected_) {
    std::erase(missing_, order->vehicle);
    Seen& v = seen_[order->vehicle];
    if (order->action == Override::Action::Remove) {
      v.on_road = v.doubted = false;
      v.way = {};
      v.asked.reset();
    }
    v.cleared.reset();
  }
  if (const auto* withdrawn = std::get_if<Withdraw>(&event.what)) seen_[withdrawn->vehicle].asked.reset();
  for (const LockRecord& record : records) {  // all sections up to the stop at once
    if (record.kind != Kind::Granted) continue;
    const Seen& v = seen_[record.vehicle];
    if (!v.stop || *v.stop >= v.way.stops.size()) continue;
    for (const WaySection& s : v.way.sections) {
      if (s.from < v.way.stops[*v.stop].to - kRounding && s.to > v.granted_from + kRounding &&
          v.held.count(s.section) == 0)
        find(record.vehicle, "granted a stop without " + site_->sections[s.section].id + " on the way there");
    }
  }
}

/// Where the vehicle certainly is, even in its own favour, it must hold the road.
void LockAudit::checkBody(const Report& report) {
  const Seen& v = seen_[report.vehicle];
  if (!v.on_road || v.doubted || report.integrity == Report::Integrity::Alarm) return;
  const double spread = rules_.footprint_sigmas * report.sigma;
  const double front = report.distance + v.shape.front - spread;
  const double rear = report.distance - v.shape.rear + spread;
  for (const WaySection& s : v.way.sections) {
    if (s.from < front - kRounding && s.to > rear + kRounding && front > rear && v.held.count(s.section) == 0)
      find(report.vehicle, "is on " + site_->sections[s.section].id + " without holding it");
  }
}

}  // namespace pos::interval
