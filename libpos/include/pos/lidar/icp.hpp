#pragma once
/// Registration of two sweeps of the same walls: trimmed point-to-line iterated closest points in the plane
/// (Zheng et al. 2021, section 3.3; spec B, B7).

#include <Eigen/Core>
#include <span>
#include <vector>

#include "pos/core/measurement.hpp"
#include "pos/core/pose2.hpp"
#include "pos/lidar/angle_calibration.hpp"

namespace pos::lidar {

/// A point of a wall and the unit normal of the wall there, towards the scanner. The point lies on the line
/// through its neighbours.
struct WallPoint {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();  ///< m, scan's frame
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
};

struct WallConfig {
  double reach = 0.4;       ///< m: a point's normal is that of the line through its neighbours as far as this
  int neighbours = 3;       ///< on either side at the least, however far apart; fewer where the wall ends
  double jump_min = 0.3;    ///< m: neighbours farther apart than this and ...
  double jump_steps = 8.0;  ///< ... than so many steps of the beams' angle times the range are not one wall
  double straight_rms = 0.03;  ///< m, of the neighbours about their line; more is a corner
  ScannerCalibration calibration = {};
};

/// Points of a sweep that lie on a straight piece of wall, in the order of the beams. Beams without a return
/// are left out, and corners and clutter, for which no normal can be told.
std::vector<WallPoint> wallPoints(const Scan2D& scan, const WallConfig& config = {});

struct IcpConfig {
  double keep = 0.75;  ///< share of the pairs that stays, those with the smallest residuals; of either
                       ///< direction by itself
  double pair_distance = 2.0;  ///< m, farther points are no pair
  double pair_along = 0.5;     ///< m, nor is a point so far past the end of the wall that was seen
  double pair_angle = 0.5;     ///< rad, nor are points whose normals differ by more
  int iterations_max = 50;
  double step_small = 1e-7;  ///< m and rad, where the iteration ends
  int pairs_min = 20;
  double sigma = 0.010;      ///< m, of a range
  double weak_share = 0.02;  ///< a direction is weak when it has less than this share of the pairs' worth
};

/// Throws ConfigError naming the first field that cannot be.
IcpConfig validated(IcpConfig config);

/// Converged: the steps became small. Wandering: they did not within the iterations. TooFewPairs: the walls
/// do not meet near the guess, which is returned.
enum class IcpEnd { Converged, Wandering, TooFewPairs };

struct IcpResult {
  Pose2 T_first_second = {};  ///< L_1 = R L_2 + T: the second scan's origin and heading in the first's frame
  IcpEnd end = IcpEnd::TooFewPairs;
  int iterations = 0;
  int pairs = 0;     ///< kept
  double rms = 0.0;  ///< m, of the kept pairs' distances from their walls
  /// Of [x, y, yaw] per unit variance of a point (sum of J'J); the yaw turns about the second scan's origin.
  Matrix<3, 3> information = Matrix<3, 3>::Zero();
  /// Under `sigma` of noise along the beams of both sweeps; a direction not held at all has pair_distance for
  /// its standard deviation.
  Matrix<3, 3> covariance = Matrix<3, 3>::Identity();
  /// Of the translation alone, the turn being unknown too, as shares of the kept pairs: 0.5 and 0.5 for walls
  /// seen equally from all sides, 0 across nothing. Smaller one first.
  Eigen::Vector2d shares = Eigen::Vector2d::Zero();
  Eigen::Vector2d weak_axis = Eigen::Vector2d::UnitX();  ///< unit vector of the smaller, first scan's frame
  bool weak = false;                                     ///< shares[0] < weak_share
};

/// Moves the second scan's points onto the first scan's walls. A weak direction is reported and solved for
/// all the same; one that is not held at all keeps the guess. The turn is an angle, so the result is a
/// rotation whatever the input. O(iterations * points^2): a few ms for two sweeps of 721 beams, which a face
/// needs five times a shift.
IcpResult registered(std::span<const WallPoint> first, std::span<const WallPoint> second, const Pose2& guess,
                     const IcpConfig& config = {});

}  // namespace pos::lidar
