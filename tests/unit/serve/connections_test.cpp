// Which sensors are heard.
#include "pos/serve/connections.hpp"

#include <gtest/gtest.h>

#include "pos/core/error.hpp"

namespace pos::serve {
namespace {

Duration s(double t) {
  return durationFromSeconds(t);
}

Measurement range(AnchorId anchor) {
  BeaconRange reading;
  reading.anchor = anchor;
  reading.range = 5.0;
  return {Stamp{}, "uwb", reading};
}

Measurement passage() {
  return {Stamp{}, "gate", PassageFix{.place = "C1"}};
}

class Monitor : public ::testing::Test {
 protected:
  Connection uwb(double now) const { return monitor_.at(s(now)).sources.at(0).link.state; }
  Link anchor(std::size_t i, double now) const { return monitor_.at(s(now)).anchors.at(i).link; }

  ConnectionMonitor monitor_{{}, {7, 3}};
};

}  // namespace

TEST_F(Monitor, ASourceGoesStaleWithinASecondAndIsLostAfterFive) {
  for (int i = 0; i <= 100; ++i) monitor_.arrived(range(7), s(0.02 * i));  // until 2 s
  EXPECT_EQ(uwb(2.0), Connection::Connected);
  EXPECT_EQ(uwb(2.79), Connection::Connected);
  EXPECT_EQ(uwb(2.81), Connection::Stale) << "0.19 s are left for telling and drawing it";
  EXPECT_EQ(uwb(6.99), Connection::Stale);
  EXPECT_EQ(uwb(7.01), Connection::Lost);
  monitor_.arrived(range(7), s(8.0));
  EXPECT_EQ(uwb(8.0), Connection::Connected);
  EXPECT_NEAR(*monitor_.at(s(8.5)).sources[0].link.age, 0.5, 1e-9);
}

TEST_F(Monitor, ASlowSourceIsGivenThreePeriods) {
  for (int i = 0; i <= 5; ++i) monitor_.arrived(range(7), s(2.0 * i));  // until 10 s
  EXPECT_EQ(uwb(15.9), Connection::Connected);
  EXPECT_EQ(uwb(16.1), Connection::Stale);
  EXPECT_EQ(uwb(39.9), Connection::Stale);
  EXPECT_EQ(uwb(40.1), Connection::Lost);
}

TEST_F(Monitor, OneLongSilenceIsNotTakenForThePeriod) {
  for (int i = 0; i <= 20; ++i) monitor_.arrived(range(7), s(0.1 * i));  // until 2 s
  for (int i = 0; i <= 5; ++i) monitor_.arrived(range(7), s(20.0 + 0.1 * i));
  EXPECT_EQ(uwb(21.2), Connection::Connected);
  EXPECT_EQ(uwb(21.4), Connection::Stale);
}

TEST_F(Monitor, EveryAnchorOfTheMapIsListedInItsOrder) {
  monitor_.arrived(range(3), s(1.0));
  monitor_.arrived(range(99), s(1.0));  // of no map
  const Connections now = monitor_.at(s(1.5));
  ASSERT_EQ(now.anchors.size(), 2U);
  EXPECT_EQ(now.anchors[0].id, 7);
  EXPECT_EQ(now.anchors[0].link.state, Connection::Waiting);
  EXPECT_EQ(now.anchors[1].link.state, Connection::Connected);
  EXPECT_EQ(now.anchors[1].link.count, 1U);
  EXPECT_EQ(now.sources[0].link.count, 2U);
}

TEST_F(Monitor, GatedReadingsOfTheLastTenSecondsAreCounted) {
  monitor_.arrived(range(7), s(0.0));
  for (int i = 0; i < 10; ++i)
    monitor_.judged(range(7), i < 3 ? Verdict::Gated : Verdict::Applied, s(0.5 * i));
  monitor_.judged(range(7), Verdict::Unsupported, s(4.6));
  EXPECT_DOUBLE_EQ(*anchor(0, 4.9).gated_ratio, 0.3);
  EXPECT_EQ(anchor(0, 4.9).last_tested, Verdict::Applied);
  EXPECT_DOUBLE_EQ(*anchor(0, 11.5).gated_ratio, 0.0);  // the gated ones are out of the window
  EXPECT_FALSE(anchor(0, 30.0).gated_ratio);
  EXPECT_FALSE(anchor(1, 4.9).gated_ratio);
}

TEST_F(Monitor, ARefusedReadingMakesItsSourceInvalidUntilAGoodOneComes) {
  monitor_.refused("uwb", "nonsense", s(0.0));  // a bad line invents no source
  EXPECT_TRUE(monitor_.at(s(0.0)).sources.empty());
  monitor_.arrived(range(7), s(1.0));
  monitor_.refused("uwb", "range is negative", s(1.1));
  EXPECT_EQ(uwb(1.2), Connection::Invalid);
  EXPECT_EQ(monitor_.at(s(1.2)).sources[0].link.why, "range is negative");
  monitor_.arrived(range(7), s(1.3));
  EXPECT_EQ(uwb(1.4), Connection::Connected);
  EXPECT_EQ(monitor_.at(s(1.4)).sources[0].link.refused, 1U);
}

TEST_F(Monitor, PassagesAreNotWatched) {
  monitor_.arrived(passage(), s(0.0));
  EXPECT_EQ(monitor_.at(s(1000.0)).sources[0].link.state, Connection::Event);
  EXPECT_TRUE(monitor_.changes(s(1000.0)).empty());
}

TEST_F(Monitor, ChangesAreToldOnce) {
  monitor_.arrived(range(7), s(0.0));
  EXPECT_TRUE(monitor_.changes(s(0.1)).empty());
  const auto stale = monitor_.changes(s(1.2));
  ASSERT_EQ(stale.size(), 1U);
  EXPECT_EQ(stale[0].state, Connection::Stale);
  EXPECT_NEAR(stale[0].age, 1.2, 1e-9);
  EXPECT_TRUE(monitor_.changes(s(1.3)).empty());
  EXPECT_EQ(monitor_.changes(s(6.0)).at(0).state, Connection::Lost);
  monitor_.arrived(range(7), s(7.0));
  EXPECT_EQ(monitor_.changes(s(7.1)).at(0).state, Connection::Connected);
}

TEST_F(Monitor, ForgetsEverythingForANewBeginning) {
  monitor_.arrived(range(7), s(5.0));
  monitor_.forget();
  EXPECT_TRUE(monitor_.at(s(0.0)).sources.empty());
  EXPECT_EQ(anchor(0, 0.0).state, Connection::Waiting);
}

TEST(ConnectionRules, LostComesAfterStale) {
  EXPECT_THROW((void)validated(ConnectionRules{.stale_after = 2.0, .lost_after = 1.0}), ConfigError);
  EXPECT_THROW((void)validated(ConnectionRules{.stale_after = 0.0}), ConfigError);
}

}  // namespace pos::serve
