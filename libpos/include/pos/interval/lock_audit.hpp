#pragma once
/// Replays the log of a lock engine and says where its rules were broken. Written apart from the engine,
/// simply and slowly: it keeps its own books from the records and judges them by the events alone.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pos/interval/lock_events.hpp"
#include "pos/interval/lock_rules.hpp"

namespace pos::interval {

struct AuditFinding {
  Stamp stamp = {};
  VehicleId vehicle = -1;
  std::string what = {};
};

struct AuditTally {
  std::size_t events = 0;
  std::size_t requests = 0;  ///< accepted ones
  std::size_t granted = 0;
  std::size_t granted_at_once = 0;
  std::size_t locks = 0;  ///< sections locked
  std::size_t releases = 0;
  std::size_t doubts = 0;
  std::size_t stale = 0;
  std::size_t trespasses = 0;
  std::size_t restarts = 0;
  std::size_t overrides = 0;
  std::size_t rejected = 0;
  std::vector<double> waits = {};  ///< s from asking to being allowed
};

class LockAudit {
 public:
  LockAudit(std::shared_ptr<const LockSite> site, const LockRules& rules);

  /// One event and what the engine wrote down about it.
  void take(const LockEvent& event, const std::vector<LockRecord>& records);
  const std::vector<AuditFinding>& findings() const { return findings_; }
  const AuditTally& tally() const { return tally_; }

 private:
  struct Seen {
    Enrol shape = {};
    Way way = {};
    std::optional<std::size_t> stop = {};       ///< index into way.stops last granted
    std::multimap<std::size_t, int> held = {};  ///< section, movement
    std::optional<Stamp> asked = {};
    std::optional<Report> report = {};
    Stamp heard = {};
    Stamp heard_before = {};    ///< before this event
    double granted_from = 0.0;  ///< m along the way
    bool on_road = false;
    bool doubted = false;
    std::optional<std::pair<Stamp, Report>> cleared = {};  ///< the report of the last release
  };
  struct Guest {
    VehicleId vehicle = -1;
    double length = 0.0;
  };

  void find(VehicleId vehicle, std::string what);
  void note(const LockEvent& event);
  void note(const Enrol& e);
  void note(const Begin& e);
  void note(const Request& e);
  void note(const Report& e);
  void note(const Parked& e);
  void note(const Restart& e);
  void note(const Announce& e);
  template <class Other>
  void note(const Other&) {}
  void check(const LockEvent& event, const LockRecord& record);
  void locked(const LockRecord& record);
  void released(const LockEvent& event, const LockRecord& record);
  void granted(const LockRecord& record);
  void slot(const LockRecord& record);
  void checkClear(const LockRecord& record, const Report& report);
  void checkWhole(const LockEvent& event, const std::vector<LockRecord>& records);
  void checkBody(const Report& report);

  std::shared_ptr<const LockSite> site_;
  LockRules rules_;
  std::map<VehicleId, Seen> seen_;
  std::vector<std::vector<Guest>> guests_;
  std::vector<VehicleId> missing_;       ///< not announced since the restart
  std::vector<std::size_t> trespassed_;  ///< sections, in this event
  Stamp now_ = {};
  bool rejected_ = false;
  AuditTally tally_;
  std::vector<AuditFinding> findings_;
};

}  // namespace pos::interval
