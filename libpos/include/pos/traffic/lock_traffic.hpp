#pragma once
/// Random traffic for trying out locks: vehicles that obey what they are allowed, with positions that are
/// noisy, go missing, jump, grow uncertain and raise alarms, and an engine that loses its memory now and
/// then. Truth is kept apart and judged without asking the engine.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pos/interval/lock_audit.hpp"
#include "pos/interval/lock_engine.hpp"

namespace pos::traffic {

struct TrafficOptions {
  std::uint64_t seed = 1;
  int vehicles = 20;
  std::size_t requests = 4000;       ///< no new ways are begun after this many
  double missing_per_s = 1.0 / 300;  ///< a spell without reports, 2 to 40 s
  double jump_per_s = 1.0 / 200;     ///< a wrong place by 10 to 80 m, for 1 to 8 s
  double vague_per_s = 1.0 / 300;    ///< sigma of 2 to 8 m, for 5 to 30 s
  double alarm_per_s = 1.0 / 1000;   ///< for 5 to 20 s
  double restart_per_s = 1.0 / 5000;
  double stuck_after = 3000.0;  ///< s without any grant while somebody waits: a deadlock
};
TrafficOptions validated(TrafficOptions options);

struct TrafficResult {
  interval::AuditTally tally;
  std::vector<interval::AuditFinding> findings;
  std::size_t opposing = 0;  ///< seconds in which two bodies opposed each other in one section, by truth
  std::size_t deadlocks = 0;
  std::string jam = {};  ///< who waited where for what, at a deadlock
  std::size_t ways_finished = 0;
  double simulated = 0.0;  ///< s
  double driven = 0.0;     ///< m, all vehicles

  /// Share (0..1) of the locks against which the audit has found nothing.
  double lockSuccess() const;
};

/// Where a vehicle on the road truly is.
struct TruePlace {
  interval::VehicleId vehicle = 0;
  const interval::Way* way = nullptr;
  double distance = 0.0;  ///< m along the way, of its reference point
};

/// Told what happens while it runs; either may be empty.
struct TrafficWatch {
  std::function<void(const interval::LockEvent&, const std::vector<interval::LockRecord>&)> event = {};
  /// Once a second of traffic time, `t` in s since its start.
  std::function<void(double t, const std::vector<TruePlace>&)> places = {};
};

/// Runs traffic on the ways until the requests are used up and everybody is home, or nobody can go on. The
/// same options give the same run. Ways begin at depots; from every depot where one ends one has to begin
/// (DataError otherwise).
TrafficResult runTraffic(std::shared_ptr<const interval::LockSite> site, std::vector<interval::Way> ways,
                         const interval::LockRules& rules, const TrafficOptions& options,
                         const TrafficWatch& watch = {});

}  // namespace pos::traffic
