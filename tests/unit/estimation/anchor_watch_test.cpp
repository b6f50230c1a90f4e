#include "pos/estimation/anchor_watch.hpp"

#include <gtest/gtest.h>

namespace pos::estimation {
namespace {

Stamp at(double t) {
  return stampFromSeconds(2000.0 + t);
}

TEST(AnchorWatch, OneAnchorThatDisagreesIsBlockedForAWhile) {
  AnchorWatch watch({}, 4);
  using Finding = AnchorWatch::Finding;
  for (int k = 0; k < 3; ++k) {
    for (int anchor = 0; anchor < 3; ++anchor)
      EXPECT_EQ(watch.note(anchor, at(0.1 * k), Verdict::Applied), Finding::None);
    EXPECT_EQ(watch.note(3, at(0.1 * k), Verdict::Gated), k == 2 ? Finding::Blocked : Finding::None);
  }
  EXPECT_TRUE(watch.blocked(3, at(0.9)));
  EXPECT_FALSE(watch.blocked(3, at(1.21)));
  EXPECT_FALSE(watch.blocked(2, at(0.9)));
}

TEST(AnchorWatch, WhenMostDisagreeTheFilterIsLost) {
  AnchorWatch watch({}, 4);
  auto finding = AnchorWatch::Finding::None;
  double t = 0.0;
  for (; t < 3.0 && finding != AnchorWatch::Finding::Lost; t += 0.1) {
    for (int anchor = 0; anchor < 4 && finding != AnchorWatch::Finding::Lost; ++anchor) {
      const bool blocked = watch.blocked(anchor, at(t));
      finding = watch.note(anchor, at(t), blocked ? std::nullopt : std::optional(Verdict::Gated));
    }
  }
  EXPECT_GE(t, 1.0);
  EXPECT_LE(t, 1.3);
}

}  // namespace
}  // namespace pos::estimation
