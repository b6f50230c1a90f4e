#pragma once
/// The Earth as an inertial system feels it: how far a change of coordinates is in metres, how it turns, how
/// it curves and how it pulls. n = local level frame, east north up.

#include <Eigen/Core>

namespace pos::ins {

/// WGS-84.
inline constexpr double kEquatorRadius = 6378137.0;               ///< m
inline constexpr double kEccentricitySquared = 6.69437999014e-3;  ///< -
inline constexpr double kEarthRate = 7.292115e-5;                 ///< rad/s

/// What the Earth is like at one place. Symbols of docs/math/ins.md.
struct EarthPoint {
  /// m per unit of each coordinate (east, north, up).
  Eigen::Vector3d metric = Eigen::Vector3d::Ones();
  Eigen::Vector3d omega_ie = Eigen::Vector3d::Zero();  ///< rad/s, Earth rate in n
  double omega_ie_by_north_y = 0.0;  ///< rad/s per m north: derivative of omega_ie's north part
  double omega_ie_by_north_z = 0.0;  ///< and of its up part
  double inverse_meridian = 0.0;     ///< 1/m, 1 / (R_M + h)
  double inverse_transverse = 0.0;   ///< 1/m, 1 / (R_N + h)
  double tan_latitude = 0.0;
  double gravity = 9.80665;        ///< m/s^2, down
  double gravity_by_north = 0.0;   ///< 1/s^2
  double gravity_by_height = 0.0;  ///< 1/s^2, about -3.086e-6

  /// Turn rate of n over the Earth while moving with v_n (transport rate), rad/s in n.
  Eigen::Vector3d omega_en(const Eigen::Vector3d& v_n) const;
};

/// A flat Earth that does not turn or a flat one that does, on which coordinates are metres, or the ellipsoid
/// with coordinates (longitude rad, latitude rad, height m).
class Earth {
 public:
  /// Flat: no rotation, no curvature, this gravity (m/s^2) everywhere.
  static Earth flat(double gravity = 9.80665) { return Earth(gravity); }
  static Earth ellipsoid() { return Earth(); }
  /// Flat, but turning at `rate` (rad/s, in the axes of the coordinates): one level for the whole site, right
  /// to 1.6e-7 rad of tilt per metre from where the rate and the gravity were taken.
  static Earth level(const Eigen::Vector3d& rate, double gravity) { return Earth(rate, gravity); }

  EarthPoint at(const Eigen::Vector3d& coordinates) const;
  /// Coordinates are metres: no curvature.
  bool isFlat() const { return flat_; }
  /// The Earth's rate is felt.
  bool turns() const { return !flat_ || !rate_.isZero(0.0); }

 private:
  explicit Earth(double gravity) : flat_(true), gravity_(gravity) {}
  Earth(const Eigen::Vector3d& rate, double gravity) : flat_(true), gravity_(gravity), rate_(rate) {}
  Earth() = default;

  bool flat_ = false;
  double gravity_ = 0.0;
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();
};

/// Radii of curvature of the ellipsoid along the meridian and across it, m.
double meridianRadius(double latitude);
double transverseRadius(double latitude);
/// Normal gravity of WGS-84 (m/s^2) at latitude (rad) and height (m above the ellipsoid), free air. The
/// series in Jiang et al. 2024 is an older one and differs by up to 7e-5 m/s^2. Below ground the rock above
/// pulls the other way, at most 1.1 mm/s^2 at 500 m: an accelerometer bias takes that up.
double normalGravity(double latitude, double height);

}  // namespace pos::ins
