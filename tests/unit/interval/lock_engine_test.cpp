#include "pos/interval/lock_engine.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "pos/core/error.hpp"
#include "support/lock_line.hpp"

namespace pos::interval {
namespace {

using Kind = LockRecord::Kind;
using testing::LockLine;

/// An engine with a clock that only the test moves.
class Post {
 public:
  explicit Post(const LockLine& line, const LockRules& rules = {}) : engine(line.site, rules) {}

  template <class What>
  std::vector<LockRecord> at(double t, const What& what) {
    return engine.take({stampFromSeconds(t), what});
  }
  /// Enrols the vehicle (front 3 m, rear 3 m), begins the way and asks to go.
  std::vector<LockRecord> start(double t, VehicleId id, const Way& way, int priority = 1) {
    at(t, Enrol{id, 3.0, 3.0, 7.0, priority});
    at(t, Begin{id, way});
    return at(t, Request{id});
  }
  /// A report with the speed that the last one of this test leads to.
  std::vector<LockRecord> report(double t, VehicleId id, double distance, double sigma = 1.0) {
    const double speed = t > t_ ? (distance - d_) / (t - t_) : 0.0;
    t_ = t;
    d_ = distance;
    return at(t, Report{.vehicle = id, .distance = distance, .sigma = sigma, .speed = speed});
  }
  bool holds(VehicleId id, std::size_t section) const {
    const auto& holders = engine.holders(section);
    return std::any_of(holders.begin(), holders.end(), [&](const LockHolder& h) { return h.vehicle == id; });
  }

  LockEngine engine;

 private:
  double t_ = 0.0;
  double d_ = 0.0;
};

std::size_t count(const std::vector<LockRecord>& records, Kind kind) {
  return static_cast<std::size_t>(
      std::count_if(records.begin(), records.end(), [&](const LockRecord& r) { return r.kind == kind; }));
}

const LockRecord* first(const std::vector<LockRecord>& records, Kind kind) {
  const auto found =
      std::find_if(records.begin(), records.end(), [&](const LockRecord& r) { return r.kind == kind; });
  return found != records.end() ? &*found : nullptr;
}

}  // namespace

TEST(LockEngine, AGrantLocksTheWholeBlockUpToTheNextChamberAtOnce) {
  const LockLine line(2);
  Post post(line);
  const auto records = post.start(0.0, 1, line.east);
  ASSERT_EQ(count(records, Kind::Granted), 1u);
  EXPECT_EQ(first(records, Kind::Granted)->stop, 2u);
  EXPECT_TRUE(post.holds(1, 0));
  EXPECT_TRUE(post.holds(1, 1));
  EXPECT_FALSE(post.holds(1, 2));
  EXPECT_EQ(count(records, Kind::SlotTaken), 1u);
}

TEST(LockEngine, VehiclesThatMeetShareNoBlockAndPassAtAChamber) {
  const LockLine line(1);
  Post post(line);
  post.start(0.0, 1, line.east);
  const auto refused = post.start(1.0, 2, line.west);  // niche full, bay held
  ASSERT_EQ(count(refused, Kind::Refused), 1u);
  EXPECT_EQ(first(refused, Kind::Refused)->other, 1);
  const auto after = post.at(30.0, Parked{1, 1});
  ASSERT_EQ(count(after, Kind::Granted), 1u);  // now the other may drive through to the depot
  EXPECT_EQ(first(after, Kind::Granted)->vehicle, 2);
  EXPECT_EQ(first(after, Kind::Granted)->stop, 0u);
}

TEST(LockEngine, APlatoonSharesABlock) {
  const LockLine line(1, 2);
  Post post(line);
  EXPECT_EQ(count(post.start(0.0, 1, line.east), Kind::Granted), 1u);
  EXPECT_EQ(count(post.start(1.0, 2, line.east), Kind::Granted), 1u);
  EXPECT_TRUE(post.holds(1, 0));
  EXPECT_TRUE(post.holds(2, 0));
}

TEST(LockEngine, NobodyIsSentToAFullChamberButThroughItWhereThereIsRoomBeyond) {
  const LockLine line(2, 1);
  Post post(line);
  post.start(0.0, 1, line.east);
  post.at(20.0, Parked{1, 1});
  const auto records = post.start(21.0, 2, line.east);
  ASSERT_EQ(count(records, Kind::Granted), 1u);
  EXPECT_EQ(first(records, Kind::Granted)->stop, 3u);
}

TEST(LockEngine, ReleasesBehindTheRearOnlyWithItsHysteresis) {
  const LockLine line(2);
  Post post(line);
  post.start(0.0, 1, line.east);
  post.at(0.5, Request{1});  // on to the second niche
  // Block 0 ends at 100 m; rear 3 m, 5 sigmas, 2 m more: clear from 110 m on.
  for (double d = 4.0; d < 109.0; d += 4.0) {
    EXPECT_EQ(count(post.report(d / 4.0, 1, d), Kind::Released), 0u) << d;
  }
  EXPECT_EQ(count(post.report(27.6, 1, 109.9), Kind::Released), 0u);
  const auto records = post.report(28.0, 1, 110.1);
  EXPECT_EQ(count(records, Kind::Released), 1u);
  EXPECT_EQ(first(records, Kind::Released)->section, 0u);
}

TEST(LockEngine, AnUncertainPositionReleasesLater) {
  const LockLine line(2);
  Post post(line);
  post.start(0.0, 1, line.east);
  post.at(0.5, Request{1});
  for (double d = 4.0; d <= 110.1; d += 4.0) (void)post.report(d / 4.0, 1, d, 2.0);
  EXPECT_TRUE(post.holds(1, 0));
  EXPECT_EQ(count(post.report(28.0, 1, 115.2, 2.0), Kind::Released), 1u);
}

TEST(LockEngine, AJumpReleasesNothingUntilTheTrackIsFoundAgain) {
  const LockLine line(2);
  Post post(line);
  post.start(0.0, 1, line.east);
  post.at(0.5, Request{1});
  const auto report = [&](double t, double d) {
    return post.at(t, Report{.vehicle = 1, .distance = d, .sigma = 1.0, .speed = 4.0});
  };
  for (double t = 1.0; t <= 10.0; t += 1.0) (void)report(t, 4.0 * t);
  const auto jumped = report(11.0, 120.0);
  EXPECT_EQ(count(jumped, Kind::Doubted), 1u);
  EXPECT_EQ(count(jumped, Kind::Released), 0u);
  for (double t = 12.0; t <= 30.0; t += 1.0) {  // steady there, and still not believed
    EXPECT_EQ(count(report(t, 120.0 + 4.0 * (t - 11.0)), Kind::Released), 0u);
  }
  EXPECT_EQ(count(report(31.0, 124.0), Kind::Trusted), 1u);  // where the wheels have taken it
}

TEST(LockEngine, APassageProvesAPositionThatJumped) {
  const LockLine line(2);
  Post post(line);
  post.start(0.0, 1, line.east);
  post.at(0.5, Request{1});
  (void)post.report(1.0, 1, 4.0);
  (void)post.at(2.0, Report{.vehicle = 1, .distance = 120.0, .sigma = 1.0, .speed = 4.0});
  const auto proven = post.at(
      3.0, Report{.vehicle = 1, .distance = 120.0, .sigma = 0.4, .evidence = Report::Evidence::Passage});
  EXPECT_EQ(count(proven, Kind::Trusted), 1u);
  EXPECT_EQ(count(proven, Kind::Released), 1u);
}

TEST(LockEngine, SilenceKeepsEverythingLockedAndSteadyReportsEndTheDoubt) {
  const LockLine line(2);
  Post post(line);
  post.start(0.0, 1, line.east);
  post.at(0.5, Request{1});
  (void)post.report(1.0, 1, 4.0);
  EXPECT_EQ(count(post.at(6.5, Tick{}), Kind::Stale), 1u);
  EXPECT_FALSE(post.engine.view(1).believed);
  EXPECT_EQ(count(post.report(30.0, 1, 120.0), Kind::Released), 0u);
  for (double t = 31.0; t < 40.0; t += 1.0)
    EXPECT_EQ(count(post.report(t, 1, 120.0), Kind::Released), 0u) << t;
  EXPECT_EQ(count(post.report(40.0, 1, 120.0), Kind::Released), 1u);
}

TEST(LockEngine, AnAlarmStopsReleasesAndGrants) {
  const LockLine line(2);
  Post post(line);
  post.start(0.0, 1, line.east);
  for (double d = 4.0; d <= 100.0; d += 4.0) (void)post.report(d / 4.0, 1, d);
  const auto alarmed = post.at(26.0, Report{.vehicle = 1,
                                            .distance = 111.0,
                                            .sigma = 1.0,
                                            .speed = 11.0,
                                            .integrity = Report::Integrity::Alarm});
  EXPECT_EQ(count(alarmed, Kind::Alarmed), 1u);
  EXPECT_EQ(count(post.at(26.5, Request{1}), Kind::Refused), 1u);
  EXPECT_TRUE(post.holds(1, 0));
  const auto over = post.report(27.0, 1, 114.0);
  EXPECT_EQ(count(over, Kind::AlarmOver), 1u);
  EXPECT_EQ(count(over, Kind::Granted), 1u);
}

TEST(LockEngine, LoadedVehiclesGoFirst) {
  const LockLine line(1, 2);
  Post post(line);
  post.start(0.0, 1, line.east);
  post.at(1.0, Request{1});          // through to the east
  post.start(2.0, 2, line.west, 1);  // empty, waits first
  post.start(3.0, 3, line.west, 0);  // loaded
  for (double d = 3.5; d <= 240.0; d += 3.5) (void)post.report(2.0 + d / 3.5, 1, d);
  const auto done = post.at(80.0, Parked{1, 2});
  ASSERT_EQ(count(done, Kind::Granted), 2u);
  EXPECT_EQ(first(done, Kind::Granted)->vehicle, 3);
}

TEST(LockEngine, APlatoonIsClosedForOneThatHasWaitedLong) {
  const LockLine line(1, 3);
  Post post(line, {.patience = 60.0});
  post.start(0.0, 1, line.east);
  EXPECT_EQ(count(post.start(1.0, 2, line.west), Kind::Granted), 0u);
  EXPECT_EQ(count(post.start(30.0, 3, line.east), Kind::Granted), 1u);  // joins the platoon
  EXPECT_EQ(count(post.start(62.0, 4, line.east), Kind::Granted), 0u);  // no longer
}

TEST(LockEngine, AfterARestartNothingIsGrantedUntilEverybodyIsAccountedFor) {
  const LockLine line(2);
  Post post(line);
  post.start(0.0, 1, line.east);
  post.start(1.0, 2, line.west);
  post.at(10.0, Restart{});
  EXPECT_FALSE(post.engine.proven());
  EXPECT_EQ(count(post.at(11.0, Announce{1, line.east, 1, 0.0, false}), Kind::Proven), 0u);
  EXPECT_TRUE(post.holds(1, 0));
  EXPECT_TRUE(post.holds(1, 1));
  post.at(11.5, Enrol{3, 3.0, 3.0, 7.0, 1});
  post.at(11.5, Begin{3, line.east});
  EXPECT_EQ(count(post.at(12.0, Request{3}), Kind::Refused), 1u);
  const auto last = post.at(13.0, Announce{2, line.west, 1, 0.0, false});
  EXPECT_EQ(count(last, Kind::Proven), 1u);
  EXPECT_TRUE(post.engine.proven());
}

TEST(LockEngine, AnOverrideNeedsANameAndAReasonAndIsWrittenDown) {
  const LockLine line(1);
  Post post(line);
  post.start(0.0, 1, line.east);
  EXPECT_EQ(count(post.at(1.0, Override{Override::Action::Remove, 1, "", ""}), Kind::Rejected), 1u);
  EXPECT_TRUE(post.holds(1, 0));
  const auto done = post.at(2.0, Override{Override::Action::Remove, 1, "Kim", "towed out"});
  ASSERT_EQ(count(done, Kind::Overridden), 1u);
  EXPECT_EQ(first(done, Kind::Overridden)->reason, "Kim: towed out");
  EXPECT_FALSE(post.holds(1, 0));
}

TEST(LockEngine, AVehicleBeyondItsLeaveIsATrespassAndLocksTheRoadAllTheSame) {
  const LockLine line(2);
  Post post(line);
  post.start(0.0, 1, line.east);  // leave ends with the bay, at 140 m
  for (double d = 4.0; d <= 140.0; d += 4.0)
    EXPECT_EQ(count(post.report(d / 4.0, 1, d), Kind::Trespass), 0u) << d;
  EXPECT_EQ(count(post.report(36.0, 1, 144.0), Kind::Trespass), 1u);
  EXPECT_TRUE(post.holds(1, 2));
}

TEST(LockEngine, EventsThatMakeNoSenseChangeNothing) {
  const LockLine line(1);
  Post post(line);
  EXPECT_EQ(count(post.at(0.0, Request{9}), Kind::Rejected), 1u);
  post.start(1.0, 1, line.east);
  EXPECT_EQ(count(post.at(0.5, Tick{}), Kind::Rejected), 1u);
  EXPECT_EQ(count(post.at(2.0, Begin{1, line.east}), Kind::Rejected), 1u);
  EXPECT_EQ(count(post.at(2.0, Parked{1, 2}), Kind::Rejected), 1u);
  Way gap = line.east;
  gap.sections[1].from += 1.0;
  post.at(3.0, Enrol{2, 3.0, 3.0, 7.0, 1});
  EXPECT_EQ(count(post.at(3.0, Begin{2, gap}), Kind::Rejected), 1u);
  EXPECT_THROW(LockEngine(line.site, {.stale_after = -1.0}), ConfigError);
}

}  // namespace pos::interval
