#include "pos/map/clearance.hpp"

#include <gtest/gtest.h>

#include "pos/core/error.hpp"

namespace pos::map {
namespace {

/// The trackless vehicle of the paper's table 10.
constexpr VehicleSize kVehicle{.width = 1.245, .height = 1.3};

Roadway section(double width, double height, int lanes) {
  Roadway roadway;
  roadway.width = width;
  roadway.height = height;
  roadway.lanes = lanes;
  return roadway;
}

}  // namespace

TEST(Clearance, NeededWidthsAreThoseOfThePaper) {
  EXPECT_NEAR(neededWidth(2, kVehicle, kVehicle, {}), 3.790, 1e-12);
  EXPECT_NEAR(neededWidth(1, kVehicle, kVehicle, {}), 2.345, 1e-12);
  // Printed for one lane is 2.545 m: it adds t, although nobody is met.
  const ClearanceRules rules;
  EXPECT_NEAR(neededWidth(1, kVehicle, kVehicle, rules) + rules.meeting_gap, 2.545, 1e-12);
}

TEST(Clearance, ThePapersOwnRoadwaysAreTooNarrow) {
  const ClearanceReport two = clearance(section(3.6, 2.0, 2), kVehicle, {});
  ASSERT_EQ(two.violations().size(), 1U);
  EXPECT_NEAR(two.violations()[0].slack(), -0.190, 1e-12);
  const ClearanceReport one = clearance(section(2.2, 2.0, 1), kVehicle, {});
  ASSERT_EQ(one.violations().size(), 1U);
  EXPECT_NEAR(one.violations()[0].slack(), -0.145, 1e-12);
}

TEST(Clearance, ARoadwayOfExactlyTheNeededWidthIsWideEnough) {
  EXPECT_TRUE(clearance(section(3.79, 2.0, 2), kVehicle, {}).violations().empty());
  EXPECT_FALSE(clearance(section(3.78, 2.0, 2), kVehicle, {}).violations().empty());
}

TEST(Clearance, RoofIsComparedAtTheUpperCorners) {
  Roadway arch = section(4.0, 2.5, 1);
  arch.section = Section::Arch;  // walls 0.5 m, roof over 1.7 m from the middle: 0.5 + 1.054
  const ClearanceReport report = clearance(arch, kVehicle, {});
  ASSERT_EQ(report.violations().size(), 1U);
  EXPECT_EQ(report.violations()[0].rule, "roof over the vehicle by the wall");
  EXPECT_NEAR(report.violations()[0].found, 0.5 + std::sqrt(4.0 - 1.7 * 1.7), 1e-12);
  EXPECT_TRUE(clearance(section(4.0, 2.5, 1), kVehicle, {}).violations().empty());
}

TEST(Clearance, NegativeGapIsRefused) {
  EXPECT_THROW(validated(ClearanceRules{.walkway = -0.1}), ConfigError);
}

}  // namespace pos::map
