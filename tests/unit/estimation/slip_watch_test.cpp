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

SlipWatch isolatedAtOnce(const SlipConfig& config) {
  SlipWatch watch(config);
  watch.observe(evidence(0.0, true));
  watch.observe(evidence(0.1, true));
  return watch;
}

SlipEvidence steadyWheels(double t_s, double position_sigma) {
  SlipEvidence e = evidence(t_s, false);
  e.wheels_steady = true;
  e.position_sigma = position_sigma;
  return e;
}

TEST(SlipWatch, AgreementWithAVagueVelocityNeedsWheelsThatWentBack) {
  SlipWatch watch({});
  SlipEvidence slip = evidence(0.0, true);
  slip.jump = 0.09;
  watch.observe(slip);
  slip.stamp = at(0.1);
  ASSERT_EQ(watch.observe(slip), SlipAction::Isolate);
  SlipEvidence vague = evidence(2.0, false, true);
  vague.velocity_sigma = 0.03;  // 0.09 m/s would hide in it
  vague.wheels_steady = true;
  vague.offset = 0.09;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(watch.observe(vague), SlipAction::Stay);
  SlipEvidence back = vague;
  back.jump = -0.08;
  EXPECT_EQ(watch.observe(back), SlipAction::Stay);
  EXPECT_EQ(watch.observe(vague), SlipAction::Stay);
  EXPECT_EQ(watch.observe(vague), SlipAction::Release);
}

TEST(SlipWatch, AFalseAlarmIsOverWithinASecond) {
  SlipWatch watch({});
  SlipEvidence noise = evidence(0.0, true);
  noise.jump = 0.08;
  watch.observe(noise);
  noise.stamp = at(0.1);
  ASSERT_EQ(watch.observe(noise), SlipAction::Isolate);
  SlipAction last = SlipAction::Stay;
  double t = 0.2;
  for (; t < 2.0 && last == SlipAction::Stay; t += 0.1) {
    SlipEvidence e = evidence(t, false, true);
    e.velocity_sigma = 0.02;
    e.wheels_steady = true;
    e.offset = 0.01;
    last = watch.observe(e);
  }
  EXPECT_EQ(last, SlipAction::Release);
  EXPECT_LT(t, 1.2);
}

TEST(SlipWatch, TimeDegradesThePositionAndDoesNotBringTheWheelsBack) {
  SlipWatch watch = isolatedAtOnce({.degraded_after = 2.0});
  EXPECT_EQ(watch.observe(steadyWheels(2.0, 0.1)), SlipAction::Stay);
  EXPECT_FALSE(watch.degraded());
  EXPECT_EQ(watch.observe(steadyWheels(2.2, 0.1)), SlipAction::Stay) << "wheels 30 % too fast are steady too";
  EXPECT_TRUE(watch.degraded());
  EXPECT_TRUE(watch.isolated());
}

TEST(SlipWatch, SteadyWheelsAreTakenBackWhenTheInertialVelocityIsWornOut) {
  SlipWatch watch = isolatedAtOnce({.max_sigma = 0.2});
  SlipEvidence shaking = steadyWheels(0.2, 0.3);
  shaking.wheels_steady = false;
  EXPECT_EQ(watch.observe(shaking), SlipAction::Stay);
  EXPECT_TRUE(watch.degraded());
  EXPECT_EQ(watch.observe(steadyWheels(0.3, 0.3)), SlipAction::ForceBack);
  EXPECT_FALSE(watch.isolated());
}

TEST(SlipWatch, SteadyWheelsAreNotTakenBackWhileTheVehicleStands) {
  SlipWatch watch = isolatedAtOnce({.max_sigma = 0.2});
  SlipEvidence standing = steadyWheels(3.0, 0.3);
  standing.standing = true;
  EXPECT_EQ(watch.observe(standing), SlipAction::Stay);
  EXPECT_TRUE(watch.degraded()) << "but it says so";
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
