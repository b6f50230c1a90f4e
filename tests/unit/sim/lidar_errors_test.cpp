#include "pos/sim/lidar_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"

namespace pos::sim {

// Spec B, section 0: the angle errors of the paper's coefficients.
TEST(LidarErrors, PaperPolynomialErrsAsTabulated) {
  struct Row {
    double angle_deg;
    double error_deg;
  };
  for (const Row& row : {Row{0, -0.054}, Row{23, 0.099}, Row{90, 0.298}, Row{157, 0.138}, Row{180, 0.001}}) {
    const double measured = degrees(measuredAngle(radians(row.angle_deg), LidarErrors::paper()));
    EXPECT_NEAR(measured - row.angle_deg, row.error_deg, 0.0005) << row.angle_deg;
  }
}

TEST(LidarErrors, AngleAndItsInverseGoRoundTrip) {
  for (const LidarErrors& errors :
       {LidarErrors::paper(), LidarErrors{}, LidarErrors{-1e-5, 1.002, -0.1, 0, 0}}) {
    for (int i = 0; i <= 180; ++i) {
      const double angle = radians(i);
      EXPECT_NEAR(trueAngle(measuredAngle(angle, errors), errors), angle, 1e-12);
      EXPECT_NEAR(measuredAngle(trueAngle(angle, errors), errors), angle, 1e-12);
    }
  }
}

TEST(LidarErrors, NoErrorsIsTheIdentity) {
  EXPECT_DOUBLE_EQ(measuredAngle(-1.3, LidarErrors{}), -1.3);
  EXPECT_DOUBLE_EQ(measuredRange(7.0, LidarErrors{}), 7.0);
}

TEST(LidarErrors, RangeErrorIsScaleAndOffset) {
  EXPECT_DOUBLE_EQ(measuredRange(10.0, LidarErrors::paper()), 10.0 + 0.006 + 0.035);
}

// Spec B, B6.1: what the systematic errors alone do to an estimate that walks from leg to leg over 350 m, a
// leg used from y = -d to -(d + 1.5) in the s-frame, 4 m beside the track: (lateral, longitudinal), m.
TEST(LidarErrors, WalkFromLegToLegErrsAsTheTheorySays) {
  struct Row {
    double first;
    double last;
    double lateral;
    double longitudinal;
  };
  const auto measured = [](double x, double y) -> std::pair<double, double> {
    const double angle = measuredAngle(std::atan2(-x, y), LidarErrors::paper());
    const double range = measuredRange(std::hypot(x, y), LidarErrors::paper());
    return {-range * std::sin(angle), range * std::cos(angle)};
  };
  for (const Row& row :
       {Row{0.0, -1.5, -2.286, 2.886}, Row{-4.5, -6.0, -1.470, 0.392}, Row{-9.0, -10.5, -0.601, 0.120},
        Row{1.5, 0.0, -1.179, 3.448}, Row{10.5, 9.0, 0.536, 0.672}}) {
    const auto [x0, y0] = measured(-4.0, row.first);
    const auto [x1, y1] = measured(-4.0, row.last);
    EXPECT_NEAR(350.0 / 1.5 * (x0 - x1), row.lateral, 0.001);
    EXPECT_NEAR(350.0 / 1.5 * (y0 - y1 - 1.5), row.longitudinal, 0.001);
  }
}

TEST(LidarErrors, RefusesAPolynomialThatTurnsBack) {
  EXPECT_THROW((void)validated(LidarErrors{.a1 = -0.005, .a2 = 1.0}, "e"), ConfigError);
  EXPECT_THROW((void)validated(LidarErrors{.scale = -1.0}, "e"), ConfigError);
  EXPECT_NO_THROW((void)validated(LidarErrors::paper(), "e"));
}

}  // namespace pos::sim
