#include "lock_book.hpp"

#include <algorithm>

namespace pos::interval {

void LockBook::clear() {
  for (auto& holders : holders_) holders.clear();
  for (auto& guests : guests_) guests.clear();
}

void LockBook::lock(std::size_t section, LockHolder holder) {
  holders_[section].push_back(holder);
}

void LockBook::release(std::size_t section, LockHolder holder) {
  auto& all = holders_[section];
  const auto found = std::find(all.begin(), all.end(), holder);
  if (found != all.end()) all.erase(found);
}

std::optional<VehicleId> LockBook::opponent(std::size_t section, LockHolder of) const {
  for (const LockHolder& holder : holders_[section]) {
    if (holder.vehicle != of.vehicle && holder.movement != of.movement) return holder.vehicle;
  }
  return std::nullopt;
}

bool LockBook::room(std::size_t stop, double length, double gap) const {
  const StopPlace& place = site_->stops[stop];
  if (place.kind == StopPlace::Kind::Depot) return true;
  double used = length;
  for (const Guest& guest : guests_[stop]) used += guest.length + gap;
  return used <= place.length && static_cast<int>(guests_[stop].size()) < place.capacity;
}

void LockBook::take(std::size_t stop, VehicleId vehicle, double length) {
  if (!hasSlot(stop, vehicle)) guests_[stop].push_back({vehicle, length});
}

void LockBook::leave(std::size_t stop, VehicleId vehicle) {
  std::erase_if(guests_[stop], [&](const Guest& guest) { return guest.vehicle == vehicle; });
}

bool LockBook::hasSlot(std::size_t stop, VehicleId vehicle) const {
  return std::any_of(guests_[stop].begin(), guests_[stop].end(),
                     [&](const Guest& guest) { return guest.vehicle == vehicle; });
}

}  // namespace pos::interval
