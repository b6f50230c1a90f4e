#include "pos/lidar/angle_calibration.hpp"

#include <gtest/gtest.h>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"
#include "pos/sim/lidar_errors.hpp"

namespace pos::lidar {

// Spec B, errata of P2-(4): the polynomial in degrees is off by -0.054, 0.099, 0.298, 0.138 and 0.001
// degrees.
TEST(ScannerCalibration, PaperPolynomialGivesTheKnownErrors) {
  const std::vector<std::pair<double, double>> facts{
      {0.0, -0.054}, {23.0, 0.099}, {90.0, 0.298}, {157.0, 0.138}, {180.0, 0.001}};
  for (const auto& [truth, error] : facts) {
    const double raw = rawAngle(radians(truth), ScannerCalibration::paper());
    EXPECT_NEAR(degrees(raw) - truth, error, 6e-4) << truth;
  }
}

TEST(ScannerCalibration, RoundTripIsExact) {
  const ScannerCalibration paper = ScannerCalibration::paper();
  for (int i = 0; i <= 720; ++i) {
    const double angle = radians(0.25 * i);
    EXPECT_NEAR(calibratedAngle(rawAngle(angle, paper), paper), angle, 1e-12);
    EXPECT_NEAR(rawAngle(calibratedAngle(angle, paper), paper), angle, 1e-12);
    const double range = 0.05 * i;
    EXPECT_NEAR(calibratedRange(rawRange(range, paper), paper), range, 1e-12);
  }
}

TEST(ScannerCalibration, DefaultChangesNothing) {
  EXPECT_NEAR(calibratedAngle(1.234, {}), 1.234, 1e-15);
  EXPECT_NEAR(rawAngle(1.234, {}), 1.234, 1e-15);
  EXPECT_EQ(calibratedRange(7.5, {}), 7.5);
}

TEST(ScannerCalibration, TakesOutWhatTheSimulatorPutsIn) {
  const sim::LidarErrors errors = sim::LidarErrors::paper();
  const ScannerCalibration paper = ScannerCalibration::paper();
  for (const double truth : {0.1, 0.8, 1.6, 2.4, 3.1}) {
    EXPECT_NEAR(calibratedAngle(sim::measuredAngle(truth, errors), paper), truth, 1e-12);
    EXPECT_NEAR(calibratedRange(sim::measuredRange(5.0 * truth, errors), paper), 5.0 * truth, 1e-12);
  }
}

TEST(ScannerCalibration, PolynomialThatFallsIsRefused) {
  EXPECT_THROW((void)validated(ScannerCalibration{.a1 = -0.004}), ConfigError);
  EXPECT_THROW((void)validated(ScannerCalibration{.a2 = 0.0}), ConfigError);
  EXPECT_THROW((void)validated(ScannerCalibration{.scale = -1.0}), ConfigError);
  EXPECT_NO_THROW((void)validated(ScannerCalibration::paper()));
}

}  // namespace pos::lidar
