#pragma once
/// The vehicles and what they hold, as the engine knows it; every change of it is written down as a record.

#include <memory>
#include <vector>

#include "lock_dispatch.hpp"

namespace pos::interval {

class LockRegister {
 public:
  LockRegister(std::shared_ptr<const LockSite> site, const LockRules& rules)
      : site_(std::move(site)), rules_(validated(rules)), book_(*site_) {}

  const LockSite& site() const { return *site_; }
  const LockRules& rules() const { return rules_; }
  const LockBook& book() const { return book_; }
  const Travellers& all() const { return all_; }
  Travellers& all() { return all_; }
  Stamp now() const { return now_; }
  const Traveller* find(VehicleId vehicle) const;
  /// The vehicle, or null with a Rejected record.
  Traveller* known(VehicleId vehicle);

  /// Begins an event: no records, nothing changed.
  void begin();
  void setNow(Stamp stamp) { now_ = stamp; }
  std::vector<LockRecord> records() { return std::move(records_); }
  LockRecord& write(LockRecord::Kind kind, VehicleId vehicle);
  void reject(VehicleId vehicle, const char* reason);
  /// Something is different for those who wait.
  bool changed() const { return changed_; }
  void noteChange() { changed_ = true; }

  void enrol(const Enrol& e) { all_.emplace(e.vehicle, Traveller(e, rules_)); }
  /// All books empty; everybody has to announce itself.
  void forgetEverything();
  /// The vehicle takes up a way and may drive to `stop`.
  void adopt(Traveller& v, const Way& way, std::size_t stop);
  void endWay(Traveller& v);
  void takeOffRoad(Traveller& v);

  /// Locks the section of this index in its way.
  void hold(Traveller& v, std::size_t index);
  void releaseAll(Traveller& v, const char* reason);
  /// Lets go what the rear has left behind, where nothing of the vehicle is behind `clear` (m along the way).
  void releaseBehind(Traveller& v, double clear);
  /// Some part of the vehicle is beyond its leave even if all uncertainty is in its favour: that road is
  /// locked at once, and let go again when the vehicle has been back for some time.
  void noteTrespass(Traveller& v);
  /// Locks what a vehicle says it holds after a restart.
  void holdAnnounced(Traveller& v, double rear_limit);
  void takeSlot(Traveller& v, std::size_t k);
  void leaveSlot(Traveller& v, std::size_t k);

  void noteTrust(Traveller& v, bool before);
  void noteAlarm(Traveller& v, bool alarm);
  /// Calls those stale that have not been heard for too long.
  void noteSilence();

 private:
  void releaseStrayed(Traveller& v);
  void trespass(Traveller& v, SectionRange range);
  void release(Traveller& v, std::size_t index, const char* reason);

  std::shared_ptr<const LockSite> site_;
  LockRules rules_;
  LockBook book_;
  Travellers all_;
  std::vector<LockRecord> records_;
  Stamp now_ = Stamp::min();
  bool changed_ = false;
};

}  // namespace pos::interval
