#include "pos/interval/lock_engine.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "lock_register.hpp"
#include "pos/core/error.hpp"

namespace pos::interval {
namespace {
using Kind = LockRecord::Kind;

constexpr double kPlaceSigma = 0.5;  // m, how well a stop tells where the vehicle in it stands
}  // namespace

/// What every event leads to.
class LockEngine::Desk {
 public:
  Desk(std::shared_ptr<const LockSite> site, const LockRules& rules) : fleet_(std::move(site), rules) {}
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;
  Desk(Desk&&) = delete;
  Desk& operator=(Desk&&) = delete;
  ~Desk() = default;

  std::vector<LockRecord> take(const LockEvent& event) {
    fleet_.begin();
    if (event.stamp < fleet_.now()) {
      fleet_.reject(-1, "stamp before the last one");
      return fleet_.records();
    }
    fleet_.setNow(event.stamp);
    fleet_.noteSilence();
    std::visit([this](const auto& what) { take(what); }, event.what);
    if (fleet_.changed()) serve();
    return fleet_.records();
  }

  const LockRegister& fleet() const { return fleet_; }
  bool proven() const { return proven_; }

 private:
  // --- Events
  void take(const Enrol& e) {
    if (fleet_.all().count(e.vehicle) != 0) return fleet_.reject(e.vehicle, "already enrolled");
    if (!(e.front >= 0.0 && e.rear >= 0.0 && e.front + e.rear > 0.0 && e.max_speed > 0.0))
      return fleet_.reject(e.vehicle, "a vehicle has a length and a top speed");
    fleet_.enrol(e);
  }

  void take(const Begin& e) {
    Traveller* v = fleet_.known(e.vehicle);
    if (v == nullptr) return;
    if (v->hasWay()) return fleet_.reject(e.vehicle, "it has a way already");
    if (!v->accounted) return fleet_.reject(e.vehicle, "it has not announced itself since the restart");
    if (const auto wrong = defect(e.way)) return fleet_.reject(e.vehicle, wrong);
    fleet_.adopt(*v, e.way, 0);
  }

  void take(const Request& e) {
    Traveller* v = fleet_.known(e.vehicle);
    if (v == nullptr) return;
    if (!v->hasWay() || v->stop + 1 >= v->way.stops.size())
      return fleet_.reject(e.vehicle, "it has no way beyond its stop");
    if (!v->waiting) v->waiting_since = fleet_.now();
    v->waiting = true;
    asked_ = e.vehicle;
    fleet_.noteChange();
  }

  void take(const Withdraw& e) {
    if (Traveller* v = fleet_.known(e.vehicle)) v->waiting = false;
    fleet_.noteChange();
  }

  void take(const Report& e) {
    Traveller* v = fleet_.known(e.vehicle);
    if (v == nullptr) return;
    if (!std::isfinite(e.distance) || !(e.sigma >= 0.0) || !std::isfinite(e.sigma))
      return fleet_.reject(e.vehicle, "the report is no number");
    if (!v->on_road) return;  // who is parked need not say where it is
    v->heard = fleet_.now();
    v->stale = false;
    const bool before = v->trust.trusted();
    v->last = TrackPoint{fleet_.now(), e.distance, e.sigma};
    v->trust.take(*v->last, e.speed, e.evidence);
    fleet_.noteTrust(*v, before);
    fleet_.noteAlarm(*v, e.integrity == Report::Integrity::Alarm);
    if (!v->believed()) return;
    fleet_.noteTrespass(*v);
    // Both the report as it came and what is believed of it have to be clear.
    const auto clear = [&](const TrackPoint& at) {
      return at.distance - v->shape.rear -
             (fleet_.rules().footprint_sigmas + fleet_.rules().release_sigmas) * at.sigma -
             fleet_.rules().release_margin;
    };
    fleet_.releaseBehind(*v, std::min(clear(*v->last), clear(*v->trust.believed())));
  }

  void take(const Parked& e) {
    Traveller* v = fleet_.known(e.vehicle);
    if (v == nullptr) return;
    if (!v->on_road || e.stop > v->stop) return fleet_.reject(e.vehicle, "it was not allowed to that stop");
    const std::size_t place = v->way.stops[e.stop].stop;
    const StopPlace::Kind kind = fleet_.site().stops[place].kind;
    if (kind == StopPlace::Kind::OnRoad) return fleet_.reject(e.vehicle, "that stop is on the road");
    if (kind == StopPlace::Kind::Niche && !fleet_.book().hasSlot(place, e.vehicle))
      return fleet_.reject(e.vehicle, "no room is kept for it there");
    for (std::size_t k = 0; k <= v->stop; ++k) {
      if (v->way.stops[k].stop != place) fleet_.leaveSlot(*v, k);
    }
    fleet_.releaseAll(*v, "parked off the road");
    v->stop = e.stop;
    fleet_.takeOffRoad(*v);
    if (e.stop + 1 == v->way.stops.size()) fleet_.endWay(*v);
  }

  void take(const Tick&) { fleet_.noteChange(); }

  void take(const Restart&) {
    fleet_.forgetEverything();
    proven_ = fleet_.all().empty();
    fleet_.write(Kind::Restarted, -1);
  }

  void take(const Announce& e) {
    Traveller* v = fleet_.known(e.vehicle);
    if (v == nullptr) return;
    if (v->accounted) return fleet_.reject(e.vehicle, "nothing was asked of it");
    if (!e.way.stops.empty()) {
      if (const auto wrong = defect(e.way)) return fleet_.reject(e.vehicle, wrong);
      if (e.stop >= e.way.stops.size()) return fleet_.reject(e.vehicle, "the way has no such stop");
      fleet_.adopt(*v, e.way, e.stop);
      v->on_road = !e.parked;
      fleet_.takeSlot(*v, e.stop);
      if (v->on_road) fleet_.holdAnnounced(*v, e.rear_limit);
      if (!v->on_road) v->trust.forget();
    } else {
      v->trust.forget();
    }
    account(*v);
  }

  void take(const Override& e) {
    Traveller* v = fleet_.known(e.vehicle);
    if (v == nullptr) return;
    if (e.who.empty() || e.why.empty())
      return fleet_.reject(e.vehicle, "an override needs a name and a reason");
    fleet_.write(Kind::Overridden, e.vehicle).reason = e.who + ": " + e.why;
    if (e.action == Override::Action::Trust) {
      v->trust.forget();
      fleet_.write(Kind::Trusted, e.vehicle).reason = "override";
    } else {
      fleet_.releaseAll(*v, "override");
      fleet_.takeOffRoad(*v);
      fleet_.endWay(*v);
      if (!v->accounted) account(*v);
    }
    fleet_.noteChange();
  }

  // --- Parts of events
  const char* defect(const Way& way) const {
    try {
      validated(way, fleet_.site());
    } catch (const DataError&) {
      return "the way does not fit the site";
    }
    return nullptr;
  }

  void account(Traveller& v) {
    v.accounted = true;
    proven_ = std::all_of(fleet_.all().begin(), fleet_.all().end(),
                          [](const auto& entry) { return entry.second.accounted; });
    if (proven_) fleet_.write(Kind::Proven, -1);
    fleet_.noteChange();
  }

  // --- Granting
  /// Tries everybody that waits, the first in rank first.
  void serve() {
    const LockDispatch dispatch(fleet_.site(), fleet_.rules(), fleet_.book(), fleet_.all());
    std::vector<Traveller*> waiting;
    for (auto& [id, v] : fleet_.all()) {
      if (v.waiting) waiting.push_back(&v);
    }
    std::stable_sort(waiting.begin(), waiting.end(), [&](const Traveller* a, const Traveller* b) {
      const int rank_a = dispatch.rank(*a, fleet_.now());
      const int rank_b = dispatch.rank(*b, fleet_.now());
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
      if (auto claim = dispatch.claimOf(v, fleet_.now())) claims.push_back(std::move(*claim));
    }
    if (v.shape.vehicle != asked_) return;  // told once, when it asked
    const Obstacle& obstacle = std::get<Obstacle>(decision);
    LockRecord& record = fleet_.write(Kind::Refused, v.shape.vehicle);
    record.other = obstacle.other;
    record.reason = obstacle.reason;
  }

  void grant(Traveller& v, std::size_t k, const LockDispatch& dispatch) {
    LockRecord& record = fleet_.write(Kind::Granted, v.shape.vehicle);
    record.stop = v.way.stops[k].stop;
    const SectionRange range = dispatch.sectionsTo(v, k);
    if (!v.on_road) {
      const WayStop& left = v.way.stops[v.stop];
      v.rear_limit = v.authority = left.from;
      v.heard = fleet_.now();
      v.trust.prove({fleet_.now(), left.at, std::max(kPlaceSigma, (left.to - left.from) / 6.0)});
      v.on_road = true;
    }
    for (std::size_t i = range.first; i < range.last; ++i) fleet_.hold(v, i);
    if (range.last > range.first) v.authority = std::max(v.authority, v.way.sections[range.last - 1].to);
    fleet_.takeSlot(v, k);
    v.stop = k;
    v.waiting = false;
  }

  LockRegister fleet_;
  VehicleId asked_ = -1;
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
  return desk_->fleet().book().holders(section);
}

std::vector<std::size_t> LockEngine::occupiedIntervals() const {
  std::set<std::size_t> occupied;
  const auto& sections = desk_->fleet().site().sections;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (!holders(i).empty()) occupied.insert(sections[i].intervals.begin(), sections[i].intervals.end());
  }
  return {occupied.begin(), occupied.end()};
}

VehicleView LockEngine::view(VehicleId vehicle) const {
  const Traveller* v = desk_->fleet().find(vehicle);
  if (v == nullptr) {
    throw DataError(
        Complaint{.what = "no vehicle of this number is enrolled", .got = std::to_string(vehicle)});
  }
  VehicleView view{
      .on_road = v->on_road, .waiting = v->waiting, .authority = v->authority, .believed = v->believed()};
  if (v->hasWay()) view.stop = v->stop;
  return view;
}

bool LockEngine::proven() const {
  return desk_->proven();
}

}  // namespace pos::interval
