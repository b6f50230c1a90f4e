#pragma once
/// Systematic errors of a planar laser scanner, taken out or put in (Zheng et al. 2021, eq. 4; spec B, B2).
/// The paper's polynomial is in degrees.

namespace pos::lidar {

/// true angle = a1 m^2 + a2 m + a3 for a measured angle m, in degrees, on [0, 180];
/// measured range = (1 + scale) true + offset. The default is a scanner without errors ("raw").
struct ScannerCalibration {
  double a1 = 0.0;      ///< 1/deg
  double a2 = 1.0;      ///< -
  double a3 = 0.0;      ///< deg
  double scale = 0.0;   ///< -, delta K
  double offset = 0.0;  ///< m, delta b

  /// The values of the paper's Table 2.
  static constexpr ScannerCalibration paper() { return {4e-5, 0.9925, 0.0531, 6e-4, 0.035}; }
  bool operator==(const ScannerCalibration&) const = default;
};

/// Throws ConfigError: the polynomial has to rise over 0 to 180 degrees and the scale to be above -1.
ScannerCalibration validated(ScannerCalibration calibration);

/// Where a beam truly looks (rad) that says it looks along `measured` rad: the polynomial itself.
double calibratedAngle(double measured, const ScannerCalibration& calibration);
/// What the scanner says (rad) of a beam that truly looks along `truth` rad: the polynomial's positive root,
/// the exact inverse of calibratedAngle on 0..pi.
double rawAngle(double truth, const ScannerCalibration& calibration);

/// True range (m) of a measured one, and back.
double calibratedRange(double measured, const ScannerCalibration& calibration);
double rawRange(double truth, const ScannerCalibration& calibration);

}  // namespace pos::lidar
