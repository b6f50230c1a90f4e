#include "pos/estimation/leg_selection.hpp"

#include <gtest/gtest.h>

namespace pos::estimation {
namespace {

using Event = FaceProgress::Event;

/// Drives along the face in steps of 0.1 s; the last event that was one.
Event driven(FaceProgress& progress, double& station, double to, double speed) {
  Event last = Event::None;
  const double v = to > station ? speed : -speed;
  while ((to - station) * v > 0.0) {
    station += 0.1 * v;
    const Event event = progress.step(station, v, 0.1);
    if (event != Event::None) last = event;
  }
  for (int i = 0; i < 20; ++i) {
    const Event event = progress.step(station, 0.0, 0.1);
    if (event != Event::None) last = event;
  }
  return last;
}

}  // namespace

TEST(LegSelection, ModesAreThoseOfTable1) {
  using enum ZoneSide;
  EXPECT_EQ(sideOf(2, Travel::Forward), B);
  EXPECT_EQ(sideOf(2, Travel::Backward), B);
  EXPECT_EQ(sideOf(7, Travel::Forward), A);
  EXPECT_EQ(sideOf(7, Travel::Backward), A);
  EXPECT_EQ(sideOf(1, Travel::Forward), B);
  EXPECT_EQ(sideOf(1, Travel::Backward), A);
  EXPECT_EQ(sideOf(5, Travel::Forward), Both);
  EXPECT_EQ(sideOf(5, Travel::Backward), B);
}

TEST(LegSelection, WindowHoldsNLegsAtAnyTime) {
  for (const int features : {1, 2, 3, 4}) {
    for (const int mode : {2, 6, 7}) {
      const double distance = mode == 6 ? 0.0 : 4.5;
      const LegWindow window({.mode = mode, .features = features, .distance = distance}, 1.5, mode);
      for (double offset = 0.01; offset < 1.5; offset += 0.1) {
        int used = 0;
        for (int i = -20; i <= 20; ++i) used += window.takesUp(Travel::Forward, offset + 1.5 * i) ? 1 : 0;
        EXPECT_EQ(used, features) << "mode " << mode << ", " << offset;
      }
    }
  }
}

TEST(LegSelection, ALegInUseStaysALittleLonger) {
  const LegWindow window({.mode = 2, .features = 1, .distance = 9.0}, 1.5, 2);
  EXPECT_FALSE(window.takesUp(Travel::Forward, -10.51));
  EXPECT_TRUE(window.keeps(Travel::Forward, -10.51));
  EXPECT_FALSE(window.keeps(Travel::Forward, -10.6));
  EXPECT_FALSE(window.takesUp(Travel::Forward, 9.5)) << "the other half";
}

TEST(LegSelection, ASupportThatMayHaveMovedIsOutUntilTheNextCycle) {
  FaceProgress progress(FaceConfig{}, 11.0);
  progress.start(0.0);
  double station = 0.0;
  EXPECT_EQ(driven(progress, station, 100.0, 0.5), Event::None);
  EXPECT_TRUE(progress.mayHaveMoved(88.0));
  EXPECT_FALSE(progress.mayHaveMoved(90.0));
  // It backs a little: what was passed stays out.
  EXPECT_EQ(driven(progress, station, 80.0, 0.5), Event::None);
  EXPECT_TRUE(progress.inPass());
  EXPECT_TRUE(progress.mayHaveMoved(88.0));
  EXPECT_EQ(driven(progress, station, 350.0, 0.5), Event::Arrived);
  EXPECT_FALSE(progress.mayHaveMoved(341.0));
}

TEST(LegSelection, AnEndOperationLeadsToTheNextPass) {
  FaceProgress progress(FaceConfig{}, 11.0);
  progress.start(0.0);
  double station = 0.0;
  EXPECT_EQ(driven(progress, station, 350.0, 1.0), Event::Arrived);
  EXPECT_EQ(progress.arrivals(), 1);
  EXPECT_EQ(progress.end(), 2);
  EXPECT_EQ(driven(progress, station, 306.9, 1.0), Event::None);
  EXPECT_EQ(progress.travel(), Travel::Backward);
  EXPECT_EQ(driven(progress, station, 350.0, 1.0), Event::Returned);
  EXPECT_EQ(progress.end(), 1);
  EXPECT_EQ(driven(progress, station, 0.0, 1.0), Event::Arrived);
  EXPECT_EQ(progress.arrivals(), 2);
  EXPECT_EQ(driven(progress, station, 100.0, 1.0), Event::Departed) << "no excursion";
  EXPECT_EQ(progress.end(), 2);
}

TEST(LegSelection, ForwardAndBackwardAreAlike) {
  FaceProgress forward(FaceConfig{}, 11.0);
  FaceProgress backward(FaceConfig{}, 11.0);
  forward.start(0.0);
  backward.start(350.0);
  double a = 0.0;
  double b = 350.0;
  driven(forward, a, 120.0, 0.5);
  driven(backward, b, 230.0, 0.5);
  for (double s = 0.25; s < 350.0; s += 0.5)
    EXPECT_EQ(forward.mayHaveMoved(s), backward.mayHaveMoved(350.0 - s)) << s;
}

TEST(LegSelection, LatticeFollowsACreepingRow) {
  SupportLattice lattice(1.5, 0.5);
  double row = 0.3;
  for (int i = 0; i < 50; ++i) {
    if (i == 20) row -= 0.3;
    const auto number = lattice.numberAt(row + 1.5 * i);
    ASSERT_TRUE(number);
    EXPECT_EQ(*number, i);
    lattice.found(*number, row + 1.5 * i);
  }
  EXPECT_FALSE(lattice.numberAt(lattice.stationOf(3) + 0.7)) << "between two supports";
}

}  // namespace pos::estimation
