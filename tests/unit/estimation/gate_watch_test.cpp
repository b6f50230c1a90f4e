#include "pos/estimation/gate_watch.hpp"

#include <gtest/gtest.h>

namespace pos::estimation {
namespace {

Stamp at(double t) {
  return stampFromSeconds(t);
}

/// Feeds anchors 1..n in turn at 4 Hz from t0 to t1; says how often the gate opened.
int openings(GateWatch& watch, double t0, double t1, int anchors, const std::vector<AnchorId>& passing) {
  int count = 0;
  int turn = 0;
  for (double t = t0; t < t1; t += 0.25) {
    const AnchorId anchor = 1 + turn++ % anchors;
    const bool passes = std::find(passing.begin(), passing.end(), anchor) != passing.end();
    count += watch.opens(at(t), anchor, passes ? Verdict::Applied : Verdict::Gated) ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST(GateWatch, OneBadAnchorAmongGoodOnesIsThatAnchorsTrouble) {
  GateWatch watch{GateConfig{}};
  EXPECT_EQ(openings(watch, 0.0, 120.0, 3, {2, 3}), 0);
  EXPECT_EQ(watch.openings(), 0);
}

TEST(GateWatch, OpensWhenEveryAnchorIsRejectedForLongEnough) {
  GateWatch watch{GateConfig{}};
  EXPECT_EQ(openings(watch, 0.0, 4.5, 3, {}), 0);
  EXPECT_EQ(openings(watch, 4.5, 6.0, 3, {}), 1);
}

TEST(GateWatch, OneAgreeingAnchorOfManyIsNoAgreement) {
  GateWatch watch{GateConfig{}};
  EXPECT_GE(openings(watch, 0.0, 20.0, 4, {1}), 2);
}

TEST(GateWatch, ASingleAnchorIsGivenThreeTimesThePatience) {
  GateWatch watch{GateConfig{}};
  EXPECT_EQ(openings(watch, 0.0, 14.0, 1, {}), 0);
  EXPECT_EQ(openings(watch, 14.0, 16.0, 1, {}), 1);
}

TEST(GateWatch, AgreementResetsTheCount) {
  GateWatch watch{GateConfig{}};
  EXPECT_EQ(openings(watch, 0.0, 11.0, 3, {}), 2);
  EXPECT_EQ(watch.openings(), 2);
  EXPECT_EQ(openings(watch, 11.0, 15.0, 3, {1, 2, 3}), 0);
  EXPECT_EQ(watch.openings(), 0);
}

}  // namespace pos::estimation
