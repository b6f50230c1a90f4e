#include "pos/lidar/angle_calibration.hpp"

#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"

namespace pos::lidar {

ScannerCalibration validated(ScannerCalibration c) {
  requireFinite(c.a1, "a1", "1/deg");
  requireFinite(c.a3, "a3", "deg");
  require(c.a2 > 0.0 && 2.0 * c.a1 * 180.0 + c.a2 > 0.0 && std::isfinite(c.a2), "a2",
          "a polynomial that rises over 0 to 180 degrees");
  require(c.scale > -1.0 && std::isfinite(c.scale), "scale", "> -1");
  requireFinite(c.offset, "offset", "m");
  return c;
}

double calibratedAngle(double measured, const ScannerCalibration& c) {
  const double m = degrees(measured);
  return radians((c.a1 * m + c.a2) * m + c.a3);
}

double rawAngle(double truth, const ScannerCalibration& c) {
  // The root of a1 m^2 + a2 m + rest = 0 that stays finite for a1 = 0 and does not cancel.
  const double rest = c.a3 - degrees(truth);
  return radians(-2.0 * rest / (c.a2 + std::sqrt(c.a2 * c.a2 - 4.0 * c.a1 * rest)));
}

double calibratedRange(double measured, const ScannerCalibration& c) {
  return (measured - c.offset) / (1.0 + c.scale);
}

double rawRange(double truth, const ScannerCalibration& c) {
  return (1.0 + c.scale) * truth + c.offset;
}

}  // namespace pos::lidar
