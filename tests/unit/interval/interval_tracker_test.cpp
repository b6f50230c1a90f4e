#include "pos/interval/interval_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/interval_drive.hpp"

namespace pos::interval {
namespace {

class IntervalTrackerTest : public ::testing::Test {
 protected:
  Estimate at(double t, double x, double sigma, double yaw = 0.0) const {
    const Matrix<3, 3> P = Vector<3>(sigma * sigma, 0.25, 1e-4).asDiagonal();
    return planarEstimate(stampFromSeconds(t), {x, 0.0, yaw}, P);
  }
  std::size_t interval(const std::string& from, const std::string& to) const {
    for (std::size_t i = 0; i < scene.intervals.size(); ++i) {
      if (scene.intervals[i].from == from && scene.intervals[i].to == to) return i;
    }
    ADD_FAILURE() << from << " " << to;
    return 0;
  }
  double probability(const IntervalBelief& belief, std::size_t of) const {
    for (const IntervalProbability& i : belief.intervals) {
      if (i.interval == of) return i.probability;
    }
    return 0.0;
  }
  testing::IntervalDrive scene{testing::intervalDemo()};
  IntervalTracker tracker{scene.network, scene.graph, scene.intervals, {}, {}};
};

}  // namespace

TEST_F(IntervalTrackerTest, TheProbabilityIsTheShareOfTheGaussianInTheInterval) {
  const double sigma = 4.0;
  const IntervalBelief belief = tracker.take(at(0.0, 48.0, sigma));
  const double behind = 0.5 * std::erfc(-(2.0 / sigma) / std::sqrt(2.0));  // Phi(0.5)
  EXPECT_NEAR(probability(belief, interval("main:start", "R50")), behind, 1e-6);
  EXPECT_NEAR(probability(belief, interval("R50", "R150")), 1.0 - behind, 1e-6);
}

TEST_F(IntervalTrackerTest, BeforeAJunctionTheVehicleIsInBothIntervalsThatBeginThere) {
  for (double x = 150.0; x < 230.0; x += 0.5) (void)tracker.take(at(x / 5.0, x, 0.5));
  const IntervalBelief belief = tracker.take(at(46.2, 231.0, 0.5));
  std::size_t inside = 0;
  for (const std::size_t i : belief.atLeast(0.9)) {
    EXPECT_EQ(scene.intervals[i].from, "R150");
    ++inside;
  }
  EXPECT_EQ(inside, 2u);
}

TEST_F(IntervalTrackerTest, TheLaneFollowsTheFacing) {
  const IntervalBelief belief = tracker.take(at(0.0, 420.0, 0.5, kPi));
  ASSERT_EQ(belief.atLeast(0.9).size(), 1u);
  EXPECT_EQ(scene.intervals[belief.atLeast(0.9)[0]].from, "L500");
  EXPECT_TRUE(belief.against_chainage);
}

TEST_F(IntervalTrackerTest, EntriesAndExitsAreToldOnceWithTheTimeOfCrossing) {
  std::vector<IntervalEvent> entries;
  std::vector<IntervalEvent> exits;
  for (int k = 0; k <= 300; ++k) {
    const double t = 0.1 * k;
    (void)tracker.take(at(t, 20.0 + 5.0 * t, 0.5));
    for (const IntervalEvent& e : tracker.events()) {
      if (e.kind == IntervalEvent::Kind::Entry) entries.push_back(e);
      if (e.kind == IntervalEvent::Kind::Exit) exits.push_back(e);
    }
  }
  ASSERT_GE(entries.size(), 2u);
  EXPECT_EQ(entries[1].interval, interval("R50", "R150"));
  EXPECT_NEAR(secondsSinceOrigin(entries[1].at), 6.0, 0.02);  // 50 m
  EXPECT_NEAR(entries[1].at_sigma, 0.1, 0.02);                // 0.5 m at 5 m/s
  EXPECT_GE(entries[1].confidence, 0.9);
  EXPECT_GE(entries[1].stamp, entries[1].at);
  ASSERT_GE(exits.size(), 1u);
  EXPECT_EQ(exits[0].interval, interval("main:start", "R50"));
  EXPECT_NEAR(secondsSinceOrigin(exits[0].at), 6.0, 0.02);
}

TEST_F(IntervalTrackerTest, TheTimeToTheNextBoundaryComesWithItsSigma) {
  IntervalBelief belief;
  for (double t = 0.0; t <= 12.0; t += 0.1) belief = tracker.take(at(t, 60.0 + 5.0 * t, 0.5));
  ASSERT_TRUE(belief.next);
  EXPECT_NEAR(belief.next->distance, 30.0, 1.0);
  EXPECT_NEAR(belief.next->seconds, belief.next->distance / 5.0, 0.02);
  EXPECT_NEAR(belief.next->seconds_sigma, std::hypot(0.1, belief.next->distance * 0.3 / 25.0), 0.01);
  for (double t = 12.1; t <= 20.0; t += 0.1) belief = tracker.take(at(t, 120.0, 0.5));
  EXPECT_FALSE(belief.next);  // it stands
}

TEST_F(IntervalTrackerTest, EveryPlaceOfEveryRoadIsInAnInterval) {
  for (map::RoadwayIndex road = 0; road < scene.network.map().roadways.size(); ++road) {
    const map::Centreline& line = scene.network.centreline(road);
    for (double s = line.chainageStart() + 0.25; s < line.chainageEnd(); s += 0.5) {
      const auto lanes = scene.network.map().roadways[road].lanes == 2
                             ? std::vector{map::Lane::Forward, map::Lane::Backward}
                             : std::vector{map::Lane::Both};
      for (const map::Lane lane : lanes)
        EXPECT_GE(map::intervalsAt(scene.intervals, road, s, lane).size(), 1u) << road << " " << s;
    }
  }
}

TEST_F(IntervalTrackerTest, TheSumOverIntervalsThatDoNotOverlapIsOne) {
  for (const double x : {20.0, 49.0, 60.0, 430.0, 451.0, 560.0}) {
    IntervalTracker fresh{scene.network, scene.graph, scene.intervals, {}, {}};
    const IntervalBelief belief = fresh.take(at(0.0, x, 3.0));
    double sum = 0.0;
    for (const IntervalProbability& i : belief.intervals) sum += i.probability;
    EXPECT_NEAR(sum, 1.0, 1e-3) << x;
  }
}

}  // namespace pos::interval
