#pragma once
/// Who may go on: the decisions of the engine, without any change to its books.

#include <map>
#include <optional>
#include <string>
#include <variant>

#include "lock_book.hpp"
#include "lock_traveller.hpp"

namespace pos::interval {

using Travellers = std::map<VehicleId, Traveller>;

/// Why a vehicle may not go on yet.
struct Obstacle {
  enum class Kind {
    Road,     ///< another movement on the way there; it will clear by itself
    Place,    ///< the stop, or one on the way, cannot be used
    Deadlock  ///< afterwards not everybody could finish
  };
  Kind kind = Kind::Road;
  VehicleId other = -1;
  std::string reason = {};
};

/// What a waiting vehicle of higher rank is about to use.
struct Claim {
  VehicleId owner = 0;
  int rank = 0;
  bool patient = false;  ///< has waited long enough to be let in before its equals
  std::vector<std::pair<std::size_t, int>> sections = {};  ///< section and movement
};

class LockDispatch {
 public:
  LockDispatch(const LockSite& site, const LockRules& rules, const LockBook& book, const Travellers& all)
      : site_(&site), rules_(&rules), book_(&book), all_(&all) {}

  /// The stop the vehicle may drive to now, or the reason why there is none (of the nearest stop).
  std::variant<std::size_t, Obstacle> decided(const Traveller& v, const std::vector<Claim>& claims) const;
  /// What `v` would be granted if only the road were clear; nothing when there is more in its way.
  std::optional<Claim> claimOf(const Traveller& v, Stamp now) const;
  /// Priority class after aging.
  int rank(const Traveller& v, Stamp now) const;
  /// Sections the grant up to way stop k adds, indices into the way.
  SectionRange sectionsTo(const Traveller& v, std::size_t k) const;

 private:
  std::optional<Obstacle> onTheRoad(const Traveller& v, std::size_t k,
                                    const std::vector<Claim>& claims) const;
  std::optional<Obstacle> againstClaims(const Traveller& v, SectionRange range,
                                        const std::vector<Claim>& claims) const;
  bool blocks(const Traveller& v, const Claim& claim) const;
  std::optional<VehicleId> shadow(const Traveller& v, std::size_t section, int movement) const;
  std::optional<Obstacle> atTheStops(const Traveller& v, std::size_t k) const;
  std::optional<Obstacle> safety(const Traveller& v, std::size_t k) const;
  std::optional<VehicleId> waiterAt(const Traveller& v, std::size_t place) const;
  std::optional<VehicleId> inFrontInQueue(const Traveller& v) const;
  std::optional<VehicleId> passingThrough(const Traveller& v, std::size_t place) const;
  StopPlace::Kind kindOf(const Traveller& v, std::size_t k) const {
    return site_->stops[v.way.stops[k].stop].kind;
  }

  const LockSite* site_;
  const LockRules* rules_;
  const LockBook* book_;
  const Travellers* all_;
};

}  // namespace pos::interval
