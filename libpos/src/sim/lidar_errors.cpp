#include "pos/sim/lidar_errors.hpp"

#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"

namespace pos::sim {

double trueAngle(double measured, const LidarErrors& errors) {
  const double m = degrees(measured);
  return radians((errors.a1 * m + errors.a2) * m + errors.a3);
}

double measuredAngle(double truth, const LidarErrors& errors) {
  // a1 m^2 + a2 m + c = 0, in the form that does not cancel and stands a1 = 0.
  const double c = errors.a3 - degrees(truth);
  return radians(-2.0 * c / (errors.a2 + std::sqrt(errors.a2 * errors.a2 - 4.0 * errors.a1 * c)));
}

double measuredRange(double truth, const LidarErrors& errors) {
  return (1.0 + errors.scale) * truth + errors.offset;
}

LidarErrors validated(LidarErrors errors, const std::string& key) {
  require(errors.a2 > 0.0 && 2.0 * errors.a1 * 180.0 + errors.a2 > 0.0, key + ".a1, a2",
          "a polynomial that rises over 0 to 180 degrees");
  requireFinite(errors.a1, key + ".a1", "1/deg");
  requireFinite(errors.a3, key + ".a3", "deg");
  require(errors.scale > -1.0 && std::isfinite(errors.scale), key + ".scale", "> -1");
  requireFinite(errors.offset, key + ".offset", "m");
  return errors;
}

}  // namespace pos::sim
