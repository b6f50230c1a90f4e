#include "pos/interval/lock_engine.hpp"

#include <algorithm>
#include <set>

#include "lock_dispatch.hpp"
#include "pos/core/error.hpp"

namespace pos::interval {
namespace {
using Kind = LockRecord::Kind;

constexpr double kPlaceSigma = 0.5;  // m, how well a stop tells where the vehicle in it stands
}  // namespace

/// The engine's working parts.
class LockEngine::Desk {
 public:
  Desk(std::shared_ptr<const LockSite> site, const LockRules& rules)
      : site_(std::move(site)), rules_(validated(rules)), book_(*site_) {}
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;
  Desk(Desk&&) = delete;
  Desk& operator=(Desk&&) = delete;
  ~Desk() = default;

  std::vector<LockRecord> take(const LockEvent& event) {
    records_.clear();
    if (event.stamp < now_) {
      write(Kind::Rejected, -1).reason = "stamp before the last one";
      return records_;
    }
    now_ = event.stamp;
    changed_ = false;
    noteSilence();
    std::visit([this](const auto& what) { take(what); }, event.what);
    if (changed_) serve();
    return std::move(records_);
  }

  const LockSite& site() const { return *site_; }
  const LockBook& book() const { return book_; }
  bool proven() const { return proven_; }
  const Traveller* find(VehicleId vehicle) const {
    const auto found = all_.find(vehicle);
    return found != all_.end() ? &found->second : nullptr;
  }

 private:
  LockRecord& write(Kind kind, VehicleId vehicle) {
    return records_.emplace_back(LockRecord{.stamp = now_, .kind = kind, .vehicle = vehicle});
  }
  void reject(VehicleId vehicle, const char* reason) { write(Kind::Rejected, vehicle).reason = reason; }
  /// The vehicle, or null with a Rejected record.
  Traveller* known(VehicleId vehicle) {
    const auto found = all_.find(vehicle);
    if (found != all_.end()) return &found->second;
    reject(vehicle, "no vehicle of this number is enrolled");
    return nullptr;
  }

  // --- Sections and slots
  void hold(Traveller& v, std::size_t index) {
    if (v.held[index] != 0) return;
    v.held[index] = 1;
    const WaySection& s = v.way.sections[index];
    book_.lock(s.section, v.holder(index));
    LockRecord& record = write(Kind::Locked, v.shape.vehicle);
    record.section = s.section;
    record.movement = s.movement;
  }
  void release(Traveller& v, std::size_t index, const char* reason) {
    if (v.held[index] == 0) return;
    v.held[index] = 0;
    const WaySection& s = v.way.sections[index];
    book_.release(s.section, v.holder(index));
    LockRecord& record = write(Kind::Released, v.shape.vehicle);
    record.section = s.section;
    record.movement = s.movement;
    record.reason = reason;
    changed_ = true;
  }
  void takeSlot(Traveller& v, std::size_t k) {
    const std::size_t place = v.way.stops[k].stop;
    if (site_->stops[place].kind == StopPlace::Kind::Depot || book_.hasSlot(place, v.shape.vehicle)) return;
    book_.take(place, v.shape.vehicle, v.length());
    write(Kind::SlotTaken, v.shape.vehicle).stop = place;
  }
  void leaveSlot(Traveller& v, std::size_t k) {
    const std::size_t place = v.way.stops[k].stop;
    if (!book_.hasSlot(place, v.shape.vehicle)) return;
    book_.leave(place, v.shape.vehicle);
    write(Kind::SlotFreed, v.shape.vehicle).stop = place;
    changed_ = true;
  }
  void releaseAll(Traveller& v, const char* reason) {
    for (std::size_t i = 0; i < v.held.size(); ++i) release(v, i, reason);
  }
  void takeOffRoad(Traveller& v) {
    v.on_road = v.stale = v.alarmed = false;
    v.last.reset();
    v.strayed.reset();
    v.trust.forget();
    changed_ = true;
  }
  void endWay(Traveller& v) {
    for (std::size_t k = 0; k < v.way.stops.size(); ++k) leaveSlot(v, k);
    v.way = {};
    v.held.clear();
    v.stop = 0;
    v.waiting = false;
  }
  void adopt(Traveller& v, const Way& way, std::size_t stop) {
    v.way = way;
    v.held.assign(way.sections.size(), 0);
    v.stop = stop;
    v.waiting = false;
  }

  // --- Events
  void take(const Enrol& e) {
    if (all_.count(e.vehicle) != 0) return reject(e.vehicle, "already enrolled");
    if (!(e.front >= 0.0 && e.rear >= 0.0 && e.front + e.rear > 0.0 && e.max_speed > 0.0))
      return reject(e.vehicle, "a vehicle has a length and a top speed");
    all_.emplace(e.vehicle, Traveller(e, rules_));
  }

  void take(const Begin& e) {
    Traveller* v = known(e.vehicle);
    if (v == nullptr) return;
    if (v->hasWay()) return reject(e.vehicle, "it has a way already");
    if (!v->accounted) return reject(e.vehicle, "it has not announced itself since the restart");
    if (const auto wrong = defect(e.way)) return reject(e.vehicle, wrong);
    adopt(*v, e.way, 0);
  }

  void take(const Request& e) {
    Traveller* v = known(e.vehicle);
    if (v == nullptr) return;
    if (!v->hasWay() || v->stop + 1 >= v->way.stops.size())
      return reject(e.vehicle, "it has no way beyond its stop");
    if (!v->waiting) v->waiting_since = now_;
    v->waiting = true;
    asked_ = e.vehicle;
    changed_ = true;
  }

  void take(const Withdraw& e) {
    if (Traveller* v = known(e.vehicle)) v->waiting = false;
    changed_ = true;
  }

  void take(const Report& e) {
    Traveller* v = known(e.vehicle);
    if (v == nullptr) return;
    if (!std::isfinite(e.distance) || !(e.sigma >= 0.0) || !std::isfinite(e.sigma))
      return reject(e.vehicle, "the report is no number");
    if (!v->on_road) return;  // who is parked need not say where it is
    v->heard = now_;
    v->stale = false;
    const bool before = v->trust.trusted();
    v->last = TrackPoint{now_, e.distance, e.sigma};
    v->trust.take(*v->last, e.speed, e.evidence);
    noteTrust(*v, before);
    noteAlarm(*v, e.integrity == Report::Integrity::Alarm);
    if (!v->believed()) return;
    noteTrespass(*v);
    // Both the report as it came and what is believed of it have to be clear.
    const auto clear = [&](const TrackPoint& at) {
      return at.distance - v->shape.rear - (rules_.footprint_sigmas + rules_.release_sigmas) * at.sigma -
             rules_.release_margin;
    };
    releaseBehind(*v, std::min(clear(*v->last), clear(*v->trust.believed())));
  }

  void take(const Parked& e) {
    Traveller* v = known(e.vehicle);
    if (v == nullptr) return;
    if (!v->on_road || e.stop > v->stop) return reject(e.vehicle, "it was not allowed to that stop");
    const std::size_t place = v->way.stops[e.stop].stop;
    const StopPlace::Kind kind = site_->stops[place].kind;
    if (kind == StopPlace::Kind::OnRoad) return reject(e.vehicle, "that stop is on the road");
    if (kind == StopPlace::Kind::Niche && !book_.hasSlot(place, e.vehicle))
      return reject(e.vehicle, "no room is kept for it there");
    for (std::size_t k = 0; k <= v->stop; ++k) {
      if (v->way.stops[k].stop != place) leaveSlot(*v, k);
    }
    releaseAll(*v, "parked off the road");
    v->stop = e.stop;
    takeOffRoad(*v);
    if (e.stop + 1 == v->way.stops.size()) endWay(*v);
  }

  void take(const Tick&) { changed_ = true; }

  void take(const Restart&) {
    book_.clear();
    proven_ = all_.empty();
    for (auto& [id, v] : all_) {
      v.way = {};
      v.held.clear();
      v.on_road = v.waiting = v.stale = v.alarmed = v.accounted = false;
      v.last.reset();
      v.strayed.reset();
      v.trust.lose();
    }
    write(Kind::Restarted, -1);
  }

  void take(const Announce& e) {
    Traveller* v = known(e.vehicle);
    if (v == nullptr) return;
    if (v->accounted) return reject(e.vehicle, "nothing was asked of it");
    if (!e.way.stops.empty()) {
      if (const auto wrong = defect(e.way)) return reject(e.vehicle, wrong);
      if (e.stop >= e.way.stops.size()) return reject(e.vehicle, "the way has no such stop");
      adopt(*v, e.way, e.stop);
      v->on_road = !e.parked;
      takeSlot(*v, e.stop);
      if (v->on_road) holdAnnounced(*v, e.rear_limit);
      if (!v->on_road) v->trust.forget();
    } else {
      v->trust.forget();
    }
    account(*v);
  }

  void take(const Override& e) {
    Traveller* v = known(e.vehicle);
    if (v == nullptr) return;
    if (e.who.empty() || e.why.empty()) return reject(e.vehicle, "an override needs a name and a reason");
    write(Kind::Overridden, e.vehicle).reason = e.who + ": " + e.why;
    if (e.action == Override::Action::Trust) {
      v->trust.forget();
      write(Kind::Trusted, e.vehicle).reason = "override";
    } else {
      releaseAll(*v, "override");
      takeOffRoad(*v);
      endWay(*v);
      if (!v->accounted) account(*v);
    }
    changed_ = true;
  }

  // --- Parts of events
  const char* defect(const Way& way) const {
    try {
      validated(way, *site_);
    } catch (const DataError&) {
      return "the way does not fit the site";
    }
    return nullptr;
  }

  void noteSilence() {
    for (auto& [id, v] : all_) {
      if (!v.on_road || v.stale || seconds(now_ - v.heard) <= rules_.stale_after) continue;
      v.stale = true;
      write(Kind::Stale, id);
    }
  }
  void noteTrust(Traveller& v, bool before) {
    if (before == v.trust.trusted()) return;
    write(before ? Kind::Doubted : Kind::Trusted, v.shape.vehicle);
    changed_ = true;
  }
  void noteAlarm(Traveller& v, bool alarm) {
    if (alarm == v.alarmed) return;
    v.alarmed = alarm;
    write(alarm ? Kind::Alarmed : Kind::AlarmOver, v.shape.vehicle);
    changed_ = true;
  }

  /// Some part of the vehicle is beyond its leave even if all uncertainty is in its favour: that road is
  /// locked at once, and let go again when the vehicle has been back for some time.
  void noteTrespass(Traveller& v) {
    const TrackPoint& at = *v.trust.believed();
    const double spread = rules_.footprint_sigmas * at.sigma;
    const double front = at.distance + v.shape.front;
    const double rear = at.distance - v.shape.rear;
    const bool beyond = front - spread > v.authority || rear + spread < v.rear_limit;
    if (front - spread > v.authority) trespass(v, touched(v.way, v.authority, front - spread));
    if (rear + spread < v.rear_limit) trespass(v, touched(v.way, rear + spread, v.rear_limit));
    if (beyond || (v.strayed && (front + spread > v.authority || rear - spread < v.rear_limit)))
      v.strayed = now_;
    if (v.strayed && seconds(now_ - *v.strayed) >= rules_.steady_for) releaseStrayed(v);
  }
  void releaseStrayed(Traveller& v) {
    v.strayed.reset();
    const SectionRange own = touched(v.way, v.rear_limit, v.authority);
    for (std::size_t i = 0; i < v.held.size(); ++i) {
      if (i < own.first || i >= own.last) release(v, i, "certainly not there");
    }
  }
  void trespass(Traveller& v, SectionRange range) {
    for (std::size_t i = range.first; i < range.last; ++i) {
      if (v.held[i] != 0) continue;
      LockRecord& record = write(Kind::Trespass, v.shape.vehicle);
      record.section = v.way.sections[i].section;
      record.other = book_.opponent(record.section, v.holder(i)).value_or(-1);
      hold(v, i);
    }
  }

  void releaseBehind(Traveller& v, double clear) {
    for (std::size_t i = 0; i < v.way.sections.size() && v.way.sections[i].to <= clear; ++i) {
      if (v.way.sections[i].to > v.way.stops[v.stop].from) break;  // where it waits it stays
      release(v, i, "its rear has cleared");
      v.rear_limit = std::max(v.rear_limit, v.way.sections[i].to);
    }
    for (std::size_t k = 0; k < v.stop; ++k) {
      if (v.way.stops[k].to <= clear && v.way.stops[k].stop != v.way.stops[v.stop].stop) leaveSlot(v, k);
    }
  }

  void holdAnnounced(Traveller& v, double rear_limit) {
    v.rear_limit = rear_limit;
    const SectionRange range = touched(v.way, rear_limit, v.way.stops[v.stop].to);
    for (std::size_t i = range.first; i < range.last; ++i) {
      const auto other = book_.opponent(v.way.sections[i].section, v.holder(i));
      if (other) {
        LockRecord& record = write(Kind::Trespass, v.shape.vehicle);
        record.section = v.way.sections[i].section;
        record.other = *other;
        record.reason = "announced against another";
      }
      hold(v, i);
    }
    v.authority = range.last > range.first ? v.way.sections[range.last - 1].to : rear_limit;
    v.heard = now_;
  }
  void account(Traveller& v) {
    v.accounted = true;
    proven_ = std::all_of(all_.begin(), all_.end(), [](const auto& entry) { return entry.second.accounted; });
    if (proven_) write(Kind::Proven, -1);
    changed_ = true;
  }

  // --- Granting
  /// Tries everybody that waits, the first in rank first.
  void serve() {
    const LockDispatch dispatch(*site_, rules_, book_, all_);
    std::vector<Traveller*> waiting;
    for (auto& [id, v] : all_) {
      if (v.waiting) waiting.push_back(&v);
    }
    std::stable_sort(waiting.begin(), waiting.end(), [&](const Traveller* a, const Traveller* b) {
      const int rank_a = dispatch.rank(*a, now_);
      const int rank_b = dispatch.rank(*b, now_);
      return rank_a != rank_b ? rank_a < rank_b : a->waiting_since < b->waiting_since;
    });
    std::vector<Claim> claims;
    for (Traveller* v : waiting) serve(*v, dispatch, claims);
    asked_ = -1;
  }

  void serve(Traveller& v, const LockDispatch& dispatch, std::vector<Claim>& claims) {
    const auto decision =
        proven_ ? dispatch.decided(v, claims)
                : Obstacle{Obstacle::Kind::Place, -1, "after a restart not all are accounted for"};
    if (const std::size_t* k = std::get_if<std::size_t>(&decision)) return grant(v, *k, dispatch);
    if (proven_) {
      if (auto claim = dispatch.claimOf(v, now_)) claims.push_back(std::move(*claim));
    }
    if (v.shape.vehicle != asked_) return;  // told once, when it asked
    const Obstacle& obstacle = std::get<Obstacle>(decision);
    LockRecord& record = write(Kind::Refused, v.shape.vehicle);
    record.other = obstacle.other;
    record.reason = obstacle.reason;
  }

  void grant(Traveller& v, std::size_t k, const LockDispatch& dispatch) {
    LockRecord& record = write(Kind::Granted, v.shape.vehicle);
    record.stop = v.way.stops[k].stop;
    const SectionRange range = dispatch.sectionsTo(v, k);
    if (!v.on_road) {
      const WayStop& left = v.way.stops[v.stop];
      v.rear_limit = v.authority = left.from;
      v.heard = now_;
      v.trust.prove({now_, left.at, std::max(kPlaceSigma, (left.to - left.from) / 6.0)});
      v.on_road = true;
    }
    for (std::size_t i = range.first; i < range.last; ++i) hold(v, i);
    if (range.last > range.first) v.authority = std::max(v.authority, v.way.sections[range.last - 1].to);
    takeSlot(v, k);
    v.stop = k;
    v.waiting = false;
  }

  std::shared_ptr<const LockSite> site_;
  LockRules rules_;
  LockBook book_;
  Travellers all_;
  std::vector<LockRecord> records_;
  Stamp now_ = Stamp::min();
  VehicleId asked_ = -1;
  bool changed_ = false;
  bool proven_ = true;
};

LockEngine::LockEngine(std::shared_ptr<const LockSite> site, const LockRules& rules)
    : desk_(std::make_unique<Desk>(std::move(site), rules)) {}
LockEngine::LockEngine(LockEngine&&) noexcept = default;
LockEngine& LockEngine::operator=(LockEngine&&) noexcept = default;
LockEngine::~LockEngine() = default;

std::vector<LockRecord> LockEngine::take(const LockEvent& event) {
  return desk_->take(event);
}

const std::vector<LockHolder>& LockEngine::holders(std::size_t section) const {
  return desk_->book().holders(section);
}

std::vector<std::size_t> LockEngine::occupiedIntervals() const {
  std::set<std::size_t> occupied;
  const auto& sections = desk_->site().sections;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (!holders(i).empty()) occupied.insert(sections[i].intervals.begin(), sections[i].intervals.end());
  }
  return {occupied.begin(), occupied.end()};
}

VehicleView LockEngine::view(VehicleId vehicle) const {
  const Traveller* v = desk_->find(vehicle);
  if (v == nullptr)
    throw DataError(
        Complaint{.what = "no vehicle of this number is enrolled", .got = std::to_string(vehicle)});
  VehicleView view{
      .on_road = v->on_road, .waiting = v->waiting, .authority = v->authority, .believed = v->believed()};
  if (v->hasWay()) view.stop = v->stop;
  return view;
}

bool LockEngine::proven() const {
  return desk_->proven();
}

}  // namespace pos::interval
