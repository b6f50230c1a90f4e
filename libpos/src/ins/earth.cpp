#include "pos/ins/earth.hpp"

#include <cmath>

namespace pos::ins {
namespace {

// WGS-84 normal gravity: Somigliana's closed form on the ellipsoid, second order in height above it.
constexpr double kGravityEquator = 9.7803253359;         // m/s^2
constexpr double kSomigliana = 1.931852652458e-3;        // -
constexpr double kFlattening = 1.0 / 298.257223563;      // -
constexpr double kCentrifugalRatio = 3.449786506841e-3;  // omega^2 a^2 b / GM

struct Gravity {
  double value;
  double by_latitude;
  double by_height;
};

Gravity gravityAt(double s, double c, double height) {
  const double s2 = s * s;
  const double w2 = 1.0 - kEccentricitySquared * s2;
  const double surface = kGravityEquator * (1.0 + kSomigliana * s2) / std::sqrt(w2);
  const double slope =
      2.0 / kEquatorRadius * (1.0 + kFlattening + kCentrifugalRatio - 2.0 * kFlattening * s2);
  const double curve = 3.0 / (kEquatorRadius * kEquatorRadius);
  const double at_height = 1.0 - slope * height + curve * height * height;
  const double by_s2 = surface * (kSomigliana / (1.0 + kSomigliana * s2) + 0.5 * kEccentricitySquared / w2);
  const double slope_by_s2 = -4.0 * kFlattening / kEquatorRadius;
  return {surface * at_height, 2.0 * s * c * (by_s2 * at_height - surface * slope_by_s2 * height),
          surface * (-slope + 2.0 * curve * height)};
}

}  // namespace

double meridianRadius(double latitude) {
  const double s = std::sin(latitude);
  const double w = 1.0 - kEccentricitySquared * s * s;
  return kEquatorRadius * (1.0 - kEccentricitySquared) / (w * std::sqrt(w));
}

double transverseRadius(double latitude) {
  const double s = std::sin(latitude);
  return kEquatorRadius / std::sqrt(1.0 - kEccentricitySquared * s * s);
}

double normalGravity(double latitude, double height) {
  return gravityAt(std::sin(latitude), std::cos(latitude), height).value;
}

Eigen::Vector3d EarthPoint::omega_en(const Eigen::Vector3d& v_n) const {
  const double east = v_n.x() * inverse_transverse;
  return {-v_n.y() * inverse_meridian, east, east * tan_latitude};
}

EarthPoint Earth::at(const Eigen::Vector3d& coordinates) const {
  EarthPoint point;
  if (flat_) {
    point.gravity = gravity_;
    point.omega_ie = rate_;
    return point;
  }
  const double latitude = coordinates.y();
  const double height = coordinates.z();
  const double s = std::sin(latitude);
  const double c = std::cos(latitude);
  const double w2 = 1.0 - kEccentricitySquared * s * s;
  const double R_N = kEquatorRadius / std::sqrt(w2);
  const double M = R_N * (1.0 - kEccentricitySquared) / w2 + height;
  const double N = R_N + height;
  point.metric = {N * c, M, 1.0};
  point.omega_ie = {0.0, kEarthRate * c, kEarthRate * s};
  point.omega_ie_by_north_y = -kEarthRate * s / M;
  point.omega_ie_by_north_z = kEarthRate * c / M;
  point.inverse_meridian = 1.0 / M;
  point.inverse_transverse = 1.0 / N;
  point.tan_latitude = s / c;
  const Gravity gravity = gravityAt(s, c, height);
  point.gravity = gravity.value;
  point.gravity_by_north = gravity.by_latitude / M;
  point.gravity_by_height = gravity.by_height;
  return point;
}

}  // namespace pos::ins
