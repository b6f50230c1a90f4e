#include "pos/core/config_checks.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace pos {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What `rule` complains about; "accepted" where it does not.
Complaint complaintOf(const std::function<void()>& rule) {
  try {
    rule();
  } catch (const ConfigError& error) {
    return error.complaint();
  }
  return {.what = "accepted"};
}

bool accepted(const std::function<void()>& rule) {
  return complaintOf(rule).what == "accepted";
}

struct Inner {
  double width = 1.0;
};
Inner validated(Inner inner) {
  requirePositive(inner.width, "width_m");
  return inner;
}

}  // namespace

TEST(ConfigChecks, ComplaintsCarryKeyValueAndWhatWasExpected) {
  const Complaint plain = complaintOf([] { requirePositive(-0.5, "gate.open_after_s"); });
  EXPECT_EQ(plain.key, "gate.open_after_s");
  EXPECT_EQ(plain.got, "-0.5");
  EXPECT_EQ(plain.expected, "> 0");
  EXPECT_EQ(plain.what, "the value has to be positive");
}

TEST(ConfigChecks, UnitsStandBehindWhatWasExpectedAndOwnersBeforeWhatIsWrong) {
  const Complaint full =
      complaintOf([] { requireNotNegative(-3.0, "roadways[2].width_m", "m", "roadway r1"); });
  EXPECT_EQ(full.what, "roadway r1: the value must not be negative");
  EXPECT_EQ(full.expected, ">= 0 m");
  EXPECT_EQ(complaintOf([] { requireFinite(kNan, "x", "rad"); }).expected, "a finite number rad");
}

TEST(ConfigChecks, SmallValuesAreToldInFull) {
  EXPECT_EQ(complaintOf([] { requirePositive(-2.5e-9, "delay_s"); }).got, "-2.5e-09");
}

TEST(ConfigChecks, EachCheckAcceptsJustItsRange) {
  EXPECT_TRUE(accepted([] { requirePositive(1e-300, "k"); }));
  EXPECT_FALSE(accepted([] { requirePositive(0.0, "k"); }));
  EXPECT_TRUE(accepted([] { requireNotNegative(0.0, "k"); }));
  EXPECT_FALSE(accepted([] { requireNotNegative(-1e-300, "k"); }));
  EXPECT_TRUE(accepted([] { requireFinite(-1e300, "k"); }));
  EXPECT_TRUE(accepted([] { requireShare(0.0, "k"); }));
  EXPECT_TRUE(accepted([] { requireShare(1.0, "k"); }));
  EXPECT_FALSE(accepted([] { requireShare(1.0 + 1e-15, "k"); }));
  EXPECT_FALSE(accepted([] { requireShare(-1e-15, "k"); }));
  EXPECT_TRUE(accepted([] { requireConfidence(0.95, "k"); }));
  EXPECT_FALSE(accepted([] { requireConfidence(0.0, "k"); }));
  EXPECT_FALSE(accepted([] { requireConfidence(1.0, "k"); }));
}

TEST(ConfigChecks, WhatIsNoNumberPassesNoCheck) {
  for (const double value : {kNan, kInfinity, -kInfinity}) {
    EXPECT_FALSE(accepted([=] { requirePositive(value, "k"); }));
    EXPECT_FALSE(accepted([=] { requireNotNegative(value, "k"); }));
    EXPECT_FALSE(accepted([=] { requireFinite(value, "k"); }));
    EXPECT_FALSE(accepted([=] { requireShare(value, "k"); }));
    EXPECT_FALSE(accepted([=] { requireConfidence(value, "k"); }));
  }
}

TEST(ConfigChecks, RequireSaysWhatWasExpected) {
  EXPECT_TRUE(accepted([] { require(true, "beams", ">= 1"); }));
  const Complaint complaint = complaintOf([] { require(false, "beams", ">= 1", "the laser is blind"); });
  EXPECT_EQ(complaint.key, "beams");
  EXPECT_EQ(complaint.expected, ">= 1");
  EXPECT_EQ(complaint.what, "the laser is blind");
}

TEST(ConfigChecks, KeysOfInnerTablesAreWhole) {
  EXPECT_EQ(complaintOf([] { requireValid(Inner{.width = 0.0}, "sensors[3]"); }).key, "sensors[3].width_m");
  EXPECT_TRUE(accepted([] { requireValid(Inner{}, "sensors[3]"); }));
  const auto nested = [] { under("a", [] { under("b", [] { requireShare(2.0, "c"); }); }); };
  EXPECT_EQ(complaintOf(nested).key, "a.b.c");
  EXPECT_EQ(complaintOf([] { under("a", [] { refuse("nothing fits", "", "", ""); }); }).key, "a");
  EXPECT_EQ(under("a", [] { return 7; }), 7);
}

TEST(ConfigChecks, UnderKeepsTheRestOfTheComplaint) {
  const Complaint whole =
      complaintOf([] { under("a", [] { refuse("what", "b", "got", "expected", "suggestion"); }); });
  EXPECT_EQ(toString(whole),
            "what\n  key:      a.b\n  got:      got\n  expected: expected\n  try:      suggestion");
}

TEST(ConfigChecks, ListsAreNumberedFromZero) {
  EXPECT_EQ(indexed("tags", 0), "tags[0]");
  EXPECT_EQ(prefixed(indexed("tags", 1), "id"), "tags[1].id");
}

}  // namespace pos
