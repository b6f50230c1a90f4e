#include <gtest/gtest.h>

#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/core/random.hpp"
#include "pos/io/files.hpp"
#include "pos/io/units.hpp"

namespace pos::io {
namespace {

TEST(OptionsUnits, LongestEndingIsTheUnit) {
  EXPECT_EQ(unitOf("range_std_m").symbol, "m");
  EXPECT_EQ(unitOf("yaw_deg_per_sqrt_m").symbol, "deg/sqrt(m)");
  EXPECT_EQ(unitOf("walk_deg_per_s_per_sqrt_s").symbol, "deg/s/sqrt(s)");
  EXPECT_EQ(unitOf("walk_per_sqrt_s").symbol, "1/sqrt(s)");
  EXPECT_EQ(unitOf("confidence").symbol, "");
  EXPECT_EQ(unitOf("beams").symbol, "") << "an ending needs its underscore";
}

TEST(OptionsUnits, StemIsTheKeyWithoutAnyUnit) {
  EXPECT_EQ(stemOf("range_std_m"), "range_std");
  EXPECT_EQ(stemOf("range_std_mm"), "range_std");
  EXPECT_EQ(stemOf("rate_rad_per_s"), "rate");
  EXPECT_EQ(stemOf("count"), "count");
}

TEST(OptionsUnits, DegreesBecomeRadians) {
  EXPECT_DOUBLE_EQ(siValue("180", "yaw_deg"), kPi);
  EXPECT_DOUBLE_EQ(siValue("-9e1", "gyro_deg_per_s"), -kPi / 2);
  EXPECT_EQ(siValue("0.3", "range_m"), 0.3);
}

TEST(OptionsUnits, WalkPerRootDegreeMatchesItsDefinition) {
  // 0.5 deg/sqrt(deg) over a turn of 90 deg is 0.5 * sqrt(90) deg.
  const double in_si = siValue("0.5", "yaw_deg_per_sqrt_deg");
  EXPECT_NEAR(degrees(in_si * std::sqrt(radians(90.0))), 0.5 * std::sqrt(90.0), 1e-12);
}

TEST(OptionsUnits, RoundNumbersStayRound) {
  EXPECT_EQ(numberText(radians(5.0), "yaw_deg"), "5");
  EXPECT_EQ(numberText(0.1, "x_m"), "0.1");
  EXPECT_EQ(numberText(100000, "x_m"), "100000");
  EXPECT_EQ(numberText(0.0, "x_m"), "0");
  EXPECT_EQ(numberText(-2.5e-9, "x_m"), "-2.5e-09");
}

TEST(OptionsUnits, EveryDoubleReadsBackToItself) {
  RandomStream random(7, 0);
  for (int i = 0; i < 20000; ++i) {
    const double value = random.normal() * std::pow(10.0, random.uniform(-12, 12));
    for (const char* key : {"x_m", "yaw_deg", "yaw_deg_per_sqrt_deg"}) {
      const std::string text = numberText(value, key);
      ASSERT_TRUE(isNumber(text)) << text;
      ASSERT_EQ(siValue(text, key), value) << key << " " << text;
    }
  }
}

TEST(OptionsUnits, NumbersAreDecimalOnly) {
  for (const char* good : {"0", "-1", "+1", "1.", ".5", "0.5", "1e3", "1.5E-3", "-0"}) {
    EXPECT_TRUE(isNumber(good)) << good;
  }
  for (const char* bad : {"", "-", ".", "e3", "1e", "1e+", "01", "00", "-01.5", "0x1", "1 ", " 1", "1m",
                          "inf", "nan", "1.2.3", "--1", "1e3.5"}) {
    EXPECT_FALSE(isNumber(bad)) << bad;
  }
  EXPECT_TRUE(isWholeNumber("-12"));
  for (const char* bad : {"", "-", "1.", "1e3", "012", "0x1"}) EXPECT_FALSE(isWholeNumber(bad)) << bad;
}

TEST(OptionsUnits, NearestNameToleratesSlips) {
  const std::vector<std::string> names = {"range_std_m", "range_max_m", "seed"};
  EXPECT_EQ(nearestName("range_sdt_m", names), "range_std_m");
  EXPECT_EQ(nearestName("Range_Max_m", names), "range_max_m");
  EXPECT_EQ(nearestName("sed", names), "seed");
  EXPECT_EQ(nearestName("quite_other", names), std::nullopt);
  EXPECT_EQ(nearestName("x", {"y"}), std::nullopt) << "one letter changed in a word of one is another word";
}

}  // namespace
}  // namespace pos::io
