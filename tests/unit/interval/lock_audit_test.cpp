#include "pos/interval/lock_audit.hpp"

#include <gtest/gtest.h>

#include "pos/interval/lock_engine.hpp"
#include "support/lock_line.hpp"

namespace pos::interval {
namespace {

using Kind = LockRecord::Kind;

/// An audit that has seen vehicle 1 drive east from the depot to the first niche.
class Log {
 public:
  Log() : line(2), engine(line.site, {}), audit(line.site, {}) {
    for (const VehicleId id : {1, 2}) pass(0.0, Enrol{id, 3.0, 3.0, 7.0, 1});
    pass(1.0, Begin{1, line.east});
    pass(1.0, Begin{2, line.west});
    pass(2.0, Request{1});
    for (double t = 3.0; t < 20.0; t += 1.0)
      pass(t, Report{.vehicle = 1, .distance = 4.0 * (t - 2.0), .sigma = 1.0, .speed = 4.0});
  }
  template <class What>
  void pass(double t, const What& what) {
    const LockEvent event{stampFromSeconds(t), what};
    audit.take(event, engine.take(event));
  }
  template <class What>
  void forge(double t, const What& what, const std::vector<LockRecord>& records) {
    audit.take({stampFromSeconds(t), what}, records);
  }
  std::string found() const { return audit.findings().empty() ? "" : audit.findings().front().what; }

  testing::LockLine line;
  LockEngine engine;
  LockAudit audit;
};

}  // namespace

TEST(LockAudit, AnHonestLogHasNoFindings) {
  const Log log;
  EXPECT_EQ(log.found(), "");
  EXPECT_EQ(log.audit.tally().granted, 1u);
  EXPECT_EQ(log.audit.tally().granted_at_once, 1u);
  EXPECT_EQ(log.audit.tally().locks, 2u);
}

TEST(LockAudit, FindsTwoMovementsOnOneSection) {
  Log log;
  log.forge(30.0, Tick{}, {{.kind = Kind::Locked, .vehicle = 2, .section = 1, .movement = -1}});
  EXPECT_NE(log.found().find("opposes vehicle 1"), std::string::npos) << log.found();
}

TEST(LockAudit, FindsAReleaseBeforeTheRearHasCleared) {
  Log log;
  log.forge(20.0, Report{.vehicle = 1, .distance = 109.0, .sigma = 1.0},
            {{.kind = Kind::Released, .vehicle = 1, .section = 0, .movement = 1}});
  EXPECT_NE(log.found().find("before its rear has cleared"), std::string::npos) << log.found();
}

TEST(LockAudit, FindsAReleaseWithoutAReport) {
  Log log;
  log.forge(20.0, Tick{}, {{.kind = Kind::Released, .vehicle = 1, .section = 0, .movement = 1}});
  EXPECT_NE(log.found().find("without a report"), std::string::npos) << log.found();
}

TEST(LockAudit, FindsAGrantWithoutARequestAndWithoutTheRoad) {
  Log log;
  log.forge(20.0, Tick{}, {{.kind = Kind::Granted, .vehicle = 2, .stop = 3}});
  EXPECT_NE(log.found().find("without a request"), std::string::npos) << log.found();
  EXPECT_NE(log.audit.findings().back().what.find("on the way there"), std::string::npos);
}

TEST(LockAudit, FindsAGrantOnAStalePosition) {
  Log log;
  log.forge(30.0, Request{1}, {{.kind = Kind::Granted, .vehicle = 1, .stop = 3}});
  EXPECT_NE(log.found().find("stale"), std::string::npos) << log.found();
}

TEST(LockAudit, FindsAFullChamber) {
  Log log;
  log.forge(20.0, Tick{}, {{.kind = Kind::SlotTaken, .vehicle = 2, .stop = 2}});
  EXPECT_NE(log.found().find("more vehicles in N0"), std::string::npos) << log.found();
}

TEST(LockAudit, FindsAVehicleOnRoadItDoesNotHold) {
  Log log;
  log.forge(20.0, Report{.vehicle = 1, .distance = 160.0, .sigma = 0.5}, {});
  EXPECT_NE(log.found().find("without holding it"), std::string::npos) << log.found();
}

TEST(LockAudit, FindsTrafficBeforeEverybodyIsAccountedForAfterARestart) {
  Log log;
  log.pass(20.0, Restart{});
  log.forge(21.0, Tick{}, {{.kind = Kind::Proven, .vehicle = -1}});
  EXPECT_NE(log.found().find("has not announced"), std::string::npos) << log.found();
}

}  // namespace pos::interval
