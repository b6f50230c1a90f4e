#include "lock_register.hpp"

#include <algorithm>

namespace pos::interval {
namespace {
using Kind = LockRecord::Kind;
}

const Traveller* LockRegister::find(VehicleId vehicle) const {
  const auto found = all_.find(vehicle);
  return found != all_.end() ? &found->second : nullptr;
}

Traveller* LockRegister::known(VehicleId vehicle) {
  const auto found = all_.find(vehicle);
  if (found != all_.end()) return &found->second;
  reject(vehicle, "no vehicle of this number is enrolled");
  return nullptr;
}

void LockRegister::begin() {
  records_.clear();
  changed_ = false;
}

LockRecord& LockRegister::write(Kind kind, VehicleId vehicle) {
  return records_.emplace_back(LockRecord{.stamp = now_, .kind = kind, .vehicle = vehicle});
}

void LockRegister::reject(VehicleId vehicle, const char* reason) {
  write(Kind::Rejected, vehicle).reason = reason;
}

void LockRegister::forgetEverything() {
  book_.clear();
  for (auto& [id, v] : all_) {
    v.way = {};
    v.held.clear();
    v.on_road = v.waiting = v.stale = v.alarmed = v.accounted = false;
    v.last.reset();
    v.strayed.reset();
    v.trust.lose();
  }
}

void LockRegister::adopt(Traveller& v, const Way& way, std::size_t stop) {
  v.way = way;
  v.held.assign(way.sections.size(), 0);
  v.stop = stop;
  v.waiting = false;
}

void LockRegister::endWay(Traveller& v) {
  for (std::size_t k = 0; k < v.way.stops.size(); ++k) leaveSlot(v, k);
  adopt(v, {}, 0);
}

void LockRegister::takeOffRoad(Traveller& v) {
  v.on_road = v.stale = v.alarmed = false;
  v.last.reset();
  v.strayed.reset();
  v.trust.forget();
  changed_ = true;
}

// --- Sections

void LockRegister::hold(Traveller& v, std::size_t index) {
  if (v.held[index] != 0) return;
  v.held[index] = 1;
  const WaySection& s = v.way.sections[index];
  book_.lock(s.section, v.holder(index));
  LockRecord& record = write(Kind::Locked, v.shape.vehicle);
  record.section = s.section;
  record.movement = s.movement;
}

void LockRegister::release(Traveller& v, std::size_t index, const char* reason) {
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

void LockRegister::releaseAll(Traveller& v, const char* reason) {
  for (std::size_t i = 0; i < v.held.size(); ++i) release(v, i, reason);
}

void LockRegister::releaseBehind(Traveller& v, double clear) {
  for (std::size_t i = 0; i < v.way.sections.size() && v.way.sections[i].to <= clear; ++i) {
    if (v.way.sections[i].to > v.way.stops[v.stop].from) break;  // where it waits it stays
    release(v, i, "its rear has cleared");
    v.rear_limit = std::max(v.rear_limit, v.way.sections[i].to);
  }
  for (std::size_t k = 0; k < v.stop; ++k) {
    if (v.way.stops[k].to <= clear && v.way.stops[k].stop != v.way.stops[v.stop].stop) leaveSlot(v, k);
  }
}

void LockRegister::noteTrespass(Traveller& v) {
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

void LockRegister::releaseStrayed(Traveller& v) {
  v.strayed.reset();
  const SectionRange own = touched(v.way, v.rear_limit, v.authority);
  for (std::size_t i = 0; i < v.held.size(); ++i) {
    if (i < own.first || i >= own.last) release(v, i, "certainly not there");
  }
}

void LockRegister::trespass(Traveller& v, SectionRange range) {
  for (std::size_t i = range.first; i < range.last; ++i) {
    if (v.held[i] != 0) continue;
    LockRecord& record = write(Kind::Trespass, v.shape.vehicle);
    record.section = v.way.sections[i].section;
    record.other = book_.opponent(record.section, v.holder(i)).value_or(-1);
    hold(v, i);
  }
}

void LockRegister::holdAnnounced(Traveller& v, double rear_limit) {
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

// --- Room at stops

void LockRegister::takeSlot(Traveller& v, std::size_t k) {
  const std::size_t place = v.way.stops[k].stop;
  if (site_->stops[place].kind == StopPlace::Kind::Depot || book_.hasSlot(place, v.shape.vehicle)) return;
  book_.take(place, v.shape.vehicle, v.length());
  write(Kind::SlotTaken, v.shape.vehicle).stop = place;
}

void LockRegister::leaveSlot(Traveller& v, std::size_t k) {
  const std::size_t place = v.way.stops[k].stop;
  if (!book_.hasSlot(place, v.shape.vehicle)) return;
  book_.leave(place, v.shape.vehicle);
  write(Kind::SlotFreed, v.shape.vehicle).stop = place;
  changed_ = true;
}

// --- What is thought of the positions

void LockRegister::noteTrust(Traveller& v, bool before) {
  if (before == v.trust.trusted()) return;
  write(before ? Kind::Doubted : Kind::Trusted, v.shape.vehicle);
  changed_ = true;
}

void LockRegister::noteAlarm(Traveller& v, bool alarm) {
  if (alarm == v.alarmed) return;
  v.alarmed = alarm;
  write(alarm ? Kind::Alarmed : Kind::AlarmOver, v.shape.vehicle);
  changed_ = true;
}

void LockRegister::noteSilence() {
  for (auto& [id, v] : all_) {
    if (!v.on_road || v.stale || seconds(now_ - v.heard) <= rules_.stale_after) continue;
    v.stale = true;
    write(Kind::Stale, id);
  }
}

}  // namespace pos::interval
