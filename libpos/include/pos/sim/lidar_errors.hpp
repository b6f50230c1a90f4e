#pragma once
/// Systematic errors of a laser scanner (spec B, B2; paper P2 eq. 4, whose polynomial is in degrees).

#include <string>

namespace pos::sim {

/// true angle = a1 m^2 + a2 m + a3 for a measured angle m, in degrees, on [0, 180];
/// measured range = (1 + scale) true + offset.
struct LidarErrors {
  double a1 = 0.0;      ///< 1/deg
  double a2 = 1.0;      ///< -
  double a3 = 0.0;      ///< deg
  double scale = 0.0;   ///< -, delta K
  double offset = 0.0;  ///< m, delta b

  /// The values of the paper's Table 2.
  static LidarErrors paper() { return {4e-5, 0.9925, 0.0531, 6e-4, 0.035}; }
};

/// Where a beam said to look along `measured` rad truly looks, rad.
double trueAngle(double measured, const LidarErrors& errors);
/// The positive root of the polynomial: what a scanner says of a target at `truth` rad. Exact inverse of
/// trueAngle on 0..pi.
double measuredAngle(double truth, const LidarErrors& errors);
double measuredRange(double truth, const LidarErrors& errors);

/// Throws ConfigError naming `key` when the polynomial does not rise over 0..180 degrees.
LidarErrors validated(LidarErrors errors, const std::string& key);

}  // namespace pos::sim
