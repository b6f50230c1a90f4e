#include "pos/estimation/slip_watch.hpp"

#include <gtest/gtest.h>

namespace pos::estimation {
namespace {

Stamp at(double t) {
  return stampFromSeconds(100.0 + t);
}

SlipEvidence evidence(double t, bool disagrees, bool agree = false) {
  return {.stamp = at(t), .disagrees = disagrees, .velocities_agree = agree};
}

TEST(SlipWatch, OneExceedanceIsSkippedAndTwoOfThreeIsolate) {
  SlipWatch watch({});
  EXPECT_EQ(watch.observe(evidence(0.0, false)), SlipAction::Use);
  EXPECT_EQ(watch.observe(evidence(0.1, true)), SlipAction::Skip);
  EXPECT_EQ(watch.observe(evidence(0.2, false)), SlipAction::Use);
  EXPECT_FALSE(watch.isolated());
  EXPECT_EQ(watch.observe(evidence(0.3, true)), SlipAction::Isolate);
  EXPECT_TRUE(watch.isolated());
  EXPECT_EQ(watch.isolations(), 1);
}

TEST(SlipWatch, ExceedancesFarApartDoNotIsolate) {
  SlipWatch watch({});
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(watch.observe(evidence(0.1 * i, i % 3 == 0)), i % 3 == 0 ? SlipAction::Skip : SlipAction::Use);
  }
  EXPECT_EQ(watch.isolations(), 0);
}

TEST(SlipWatch, ThreeAgreementsInARowRelease) {
  SlipWatch watch({});
  watch.observe(evidence(0.0, true));
  ASSERT_EQ(watch.observe(evidence(0.1, true)), SlipAction::Isolate);
  EXPECT_EQ(watch.observe(evidence(0.2, false, true)), SlipAction::Stay);
  EXPECT_EQ(watch.observe(evidence(0.3, false, true)), SlipAction::Stay);
  EXPECT_EQ(watch.observe(evidence(0.4, false, false)), SlipAction::Stay) << "starts counting anew";
  EXPECT_EQ(watch.observe(evidence(0.5, false, true)), SlipAction::Stay);
  EXPECT_EQ(watch.observe(evidence(0.6, false, true)), SlipAction::Stay);
  EXPECT_EQ(watch.observe(evidence(0.7, false, true)), SlipAction::Release);
  EXPECT_FALSE(watch.isolated());
  EXPECT_EQ(watch.observe(evidence(0.8, true)), SlipAction::Skip) << "old exceedances are forgotten";
}

TEST(SlipWatch, IsolationIsBoundedByTimeAndBySigma) {
  SlipWatch by_time({.max_time = 2.0});
  by_time.observe(evidence(0.0, true));
  by_time.observe(evidence(0.1, true));
  EXPECT_EQ(by_time.observe(evidence(2.0, false)), SlipAction::Stay);
  EXPECT_FALSE(by_time.degraded());
  EXPECT_EQ(by_time.observe(evidence(2.2, false)), SlipAction::Stay) << "wheels are not steady";
  EXPECT_TRUE(by_time.degraded());
  SlipEvidence steady = evidence(2.3, false);
  steady.wheels_steady = true;
  EXPECT_EQ(by_time.observe(steady), SlipAction::ForceBack);
  EXPECT_FALSE(by_time.isolated());

  SlipWatch by_sigma({.max_sigma = 0.2});
  by_sigma.observe(evidence(0.0, true));
  by_sigma.observe(evidence(0.1, true));
  SlipEvidence lost = evidence(0.2, false);
  lost.position_sigma = 0.3;
  EXPECT_EQ(by_sigma.observe(lost), SlipAction::Stay);
  EXPECT_TRUE(by_sigma.degraded());
}

TEST(SlipWatch, SteadyWheelsAreNotTakenBackWhileTheVehicleStands) {
  SlipWatch watch({.max_time = 2.0});
  watch.observe(evidence(0.0, true));
  watch.observe(evidence(0.1, true));
  SlipEvidence standing = evidence(3.0, false);
  standing.wheels_steady = true;
  standing.standing = true;
  EXPECT_EQ(watch.observe(standing), SlipAction::Stay);
  EXPECT_TRUE(watch.degraded()) << "but it says for how long they have been out";
  standing.standing = false;
  EXPECT_EQ(watch.observe(standing), SlipAction::ForceBack);
}

TEST(SlipWatch, HandlingDecides) {
  SlipWatch believing({.handling = SlipConfig::Handling::None});
  SlipWatch gating({.handling = SlipConfig::Handling::Gate});
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(believing.observe(evidence(0.1 * i, true)), SlipAction::Use);
    EXPECT_EQ(gating.observe(evidence(0.1 * i, true)), SlipAction::Skip);
  }
  EXPECT_FALSE(believing.isolated());
  EXPECT_FALSE(gating.isolated());
}

}  // namespace
}  // namespace pos::estimation
