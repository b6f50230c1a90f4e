#include "pos/eval/switching.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pos::eval {
namespace {

Stamp at(double t) {
  return stampFromSeconds(t);
}

/// Outputs every 10 ms, two modes that are heard all the time unless a test says otherwise.
struct Story {
  SwitchingWatch watch = SwitchingWatch{};
  ModeState gnss{.name = "gnss", .probability = 0.999, .usable = true, .since = at(0.0), .sigma = 0.02};
  ModeState uwb{.name = "uwb", .probability = 0.001, .usable = false, .since = at(0.0), .sigma = 0.1};
  double t = 1.0;

  void say(double probability_uwb, int outputs = 1) {
    for (int i = 0; i < outputs; ++i, t += 0.01) {
      uwb.probability = probability_uwb;
      gnss.probability = 1.0 - probability_uwb;
      if (gnss.usable) gnss.last_applied = at(t);
      if (uwb.usable) uwb.last_applied = at(t);
      watch.take(at(t), {gnss, uwb});
    }
  }
  void joins(ModeState& mode) {
    mode.usable = true;
    mode.since = at(t);
  }
  void leaves(ModeState& mode) {
    mode.usable = false;
    mode.since = at(t);
  }
};

}  // namespace

TEST(Switching, ABetterModeThatJoinsHasSettledWhenItLeadsAndStaysSo) {
  Story story;
  story.gnss.sigma = 1.0;
  story.say(0.001, 5);
  story.joins(story.uwb);  // at 1.05
  story.say(0.001);
  story.say(0.60);      // 1.06, leads, but jumped
  story.say(0.95);      // 1.07, jumped
  story.say(0.97, 10);  // 1.08: first of the steady ones
  const SwitchingFigures figures = story.watch.finish();
  ASSERT_EQ(figures.switches.size(), 1U);
  EXPECT_EQ(figures.switches[0].change, "+uwb");
  EXPECT_NEAR(*figures.switches[0].delay(), 0.03, 1e-9);
  EXPECT_NEAR(*figures.meanDelay(), 0.03, 1e-9);
  EXPECT_EQ(figures.failed(), 0U);
}

TEST(Switching, AWorseModeHasToCountButNotToLead) {
  Story story;
  story.say(0.001, 5);
  story.joins(story.uwb);
  story.say(0.09, 4);  // settled, but too little to count
  story.say(0.12, 4);  // 1.09
  const SwitchingFigures figures = story.watch.finish();
  EXPECT_NEAR(*figures.switches[0].delay(), 0.04, 1e-9);
  EXPECT_NEAR(*figures.switches[0].delayToBetter(), 0.01, 1e-9);  // 1.05 jumped by 0.089
}

TEST(Switching, ADepartedModeHasSettledWhenItIsAtItsFloor) {
  Story story;
  story.uwb.usable = true;
  story.say(0.90, 5);
  story.leaves(story.gnss);  // 1.05
  story.say(0.94);
  story.say(0.97);
  story.say(0.985, 5);  // 1.07
  const SwitchingFigures figures = story.watch.finish({at(0.5), at(1.02), at(1.2)});
  ASSERT_EQ(figures.switches.size(), 1U);
  EXPECT_EQ(figures.switches[0].change, "-gnss");
  EXPECT_NEAR(*figures.switches[0].delay(), 0.02, 1e-9);
  EXPECT_NEAR(*figures.switches[0].wait(), 0.03, 1e-9);
}

TEST(Switching, EveryModeInUseHasToBeHeardAfterTheSwitch) {
  Story story;
  story.gnss.sigma = 1.0;
  story.say(0.97, 5);
  story.joins(story.uwb);
  for (int i = 0; i < 8; ++i, story.t += 0.01) {
    story.uwb.last_applied = at(story.t);
    story.gnss.last_applied = at(i < 5 ? 1.02 : story.t);  // silent until 1.10
    story.watch.take(at(story.t), {story.gnss, story.uwb});
  }
  EXPECT_NEAR(*story.watch.finish().switches[0].delay(), 0.05, 1e-9);
}

TEST(Switching, ChatterNeverSettles) {
  Story story;
  story.gnss.sigma = 1.0;
  story.say(0.001, 5);
  story.joins(story.uwb);
  for (int i = 0; i < 300; ++i) story.say(i % 2 == 0 ? 0.6 : 0.4);
  const SwitchingFigures figures = story.watch.finish();
  EXPECT_FALSE(figures.switches[0].delay());
  EXPECT_EQ(figures.failed(), 1U);
  EXPECT_TRUE(std::isinf(*figures.meanDelay()));
}

TEST(Switching, SettlingAfterTwoSecondsIsTooLate) {
  Story story;
  story.gnss.sigma = 1.0;
  story.say(0.001, 5);
  story.joins(story.uwb);
  story.say(0.3, 205);
  story.say(0.97, 20);
  EXPECT_EQ(story.watch.finish().failed(), 1U);
}

TEST(Switching, ASecondSwitchBeforeTheFirstHasSettledLeavesThatOneFailed) {
  Story story;
  story.gnss.sigma = 1.0;
  story.say(0.001, 5);
  story.joins(story.uwb);
  story.say(0.4, 2);
  story.leaves(story.gnss);
  story.say(0.99, 6);
  const SwitchingFigures figures = story.watch.finish();
  ASSERT_EQ(figures.switches.size(), 2U);
  EXPECT_FALSE(figures.switches[0].delay());
  EXPECT_TRUE(figures.switches[1].delay());
  EXPECT_EQ(figures.failed(), 1U);
}

TEST(Switching, StartAndOutageAreNoSwitches) {
  Story story;
  story.gnss.usable = false;
  story.say(0.001, 3);
  story.joins(story.gnss);
  story.say(0.001, 3);
  story.leaves(story.gnss);
  story.say(0.001, 3);
  const SwitchingFigures figures = story.watch.finish();
  EXPECT_TRUE(figures.switches.empty());
  EXPECT_FALSE(figures.meanDelay());
}

}  // namespace pos::eval
