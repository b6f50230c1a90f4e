#pragma once
/// Who holds which section and which room: the engine's books.

#include <optional>
#include <vector>

#include "pos/interval/lock_events.hpp"
#include "pos/interval/lock_holder.hpp"

namespace pos::interval {

class LockBook {
 public:
  explicit LockBook(const LockSite& site)
      : site_(&site), holders_(site.sections.size()), guests_(site.stops.size()) {}

  void clear();
  const std::vector<LockHolder>& holders(std::size_t section) const { return holders_[section]; }
  void lock(std::size_t section, LockHolder holder);
  void release(std::size_t section, LockHolder holder);
  /// Another vehicle that holds the section with another movement.
  std::optional<VehicleId> opponent(std::size_t section, LockHolder of) const;

  /// Whether there is room for a vehicle of this length (m) beside those that have a slot.
  bool room(std::size_t stop, double length, double gap) const;
  void take(std::size_t stop, VehicleId vehicle, double length);
  void leave(std::size_t stop, VehicleId vehicle);
  bool hasSlot(std::size_t stop, VehicleId vehicle) const;

 private:
  struct Guest {
    VehicleId vehicle = 0;
    double length = 0.0;
  };
  const LockSite* site_;
  std::vector<std::vector<LockHolder>> holders_;
  std::vector<std::vector<Guest>> guests_;
};

}  // namespace pos::interval
