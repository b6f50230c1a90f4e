#include "pos/interval/lock_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "pos/core/error.hpp"
#include "support/lock_mine.hpp"

namespace pos::interval {
namespace {

class LockMapTest : public ::testing::Test {
 protected:
  testing::LockMine mine{testing::lockMine()};
  map::RouteLine route(const std::string& from, double at, const std::string& to, double until) const {
    return *mine.graph.shortestRoute({mine.network.indexOf(from), at, 0.0, 0.0},
                                     {mine.network.indexOf(to), until, 0.0, 0.0});
  }
};

}  // namespace

TEST_F(LockMapTest, AWayCoversItsRouteWithoutGaps) {
  const map::RouteLine line = route("main", 0.0, "branch", 600.0);
  const Way way = mine.locks.way(line);
  EXPECT_EQ(way.sections.front().from, 0.0);
  EXPECT_NEAR(way.sections.back().to, line.length(), 1e-9);
  double length = 0.0;
  for (const WaySection& s : way.sections) length += s.to - s.from;
  EXPECT_NEAR(length, line.length(), 1e-9);
}

TEST_F(LockMapTest, TheWayBackUsesTheSameSectionsTheOtherWayRoundOnOneLane) {
  const map::RouteLine line = route("south", 1500.0, "north", 1200.0);  // one lane all the way
  const Way there = mine.locks.way(line);
  const Way back = mine.locks.way(line.reversed());
  ASSERT_EQ(there.sections.size(), back.sections.size());
  for (std::size_t i = 0; i < there.sections.size(); ++i) {
    const WaySection& a = there.sections[i];
    const WaySection& b = back.sections[back.sections.size() - 1 - i];
    EXPECT_EQ(a.section, b.section);
    EXPECT_NE(a.movement, b.movement);
  }
  ASSERT_EQ(there.stops.size(), back.stops.size());
  for (std::size_t k = 0; k < there.stops.size(); ++k) {
    EXPECT_EQ(there.stops[k].stop, back.stops[back.stops.size() - 1 - k].stop);
  }
}

TEST_F(LockMapTest, LanesOfOneRoadShareNoSection) {
  const Way out = mine.locks.way(route("main", 0.0, "south", 1500.0));
  const Way in = mine.locks.way(route("south", 1500.0, "main", 0.0));
  std::set<std::size_t> lanes;
  for (const Way* way : {&out, &in}) {
    std::set<std::size_t> mine_only;
    for (const WaySection& s : way->sections) {
      if (!mine.locks.site()->sections[s.section].single_lane) mine_only.insert(s.section);
    }
    EXPECT_FALSE(mine_only.empty());
    for (const std::size_t section : mine_only) EXPECT_TRUE(lanes.insert(section).second);
  }
}

TEST_F(LockMapTest, EveryStopLiesInsideSectionsThatAreHeldWithIt) {
  for (const Way& way : mine.ways()) {
    for (const WayStop& stop : way.stops) {
      const bool inside = std::any_of(way.sections.begin(), way.sections.end(), [&](const WaySection& s) {
        return s.from <= stop.at && stop.at <= s.to;
      });
      EXPECT_TRUE(inside);
    }
  }
}

TEST_F(LockMapTest, EverySectionOfALockedRoadBelongsToALockInterval) {
  for (const LockSection& section : mine.locks.site()->sections) {
    EXPECT_FALSE(section.intervals.empty()) << section.id;
  }
}

TEST_F(LockMapTest, AWayThatEndsInAJunctionIsRefused) {
  const auto to_junction = mine.graph.shortestRoute({mine.network.indexOf("main"), 0.0, 0.0, 0.0},
                                                    {mine.network.indexOf("main"), 800.0, 0.0, 0.0});
  ASSERT_TRUE(to_junction);
  EXPECT_THROW((void)mine.locks.way(*to_junction), DataError);
}

}  // namespace pos::interval
