#pragma once
/// State and models of `dead_reckoning`, variants `encoders` and `ekf_heading`: two wheels drive, an inertial
/// attitude corrects (Jiang et al. 2024, eqs. 6-9 as corrected in docs/math/dead_reckoning.md). Pure
/// functions.

#include "pos/core/belief.hpp"
#include "pos/estimation/sins_configs.hpp"
#include "pos/filters/ekf.hpp"

namespace pos::estimation {

/// Where the middle of the axle is, how it stands, and what two instruments do wrong.
/// Tangent [x, y, z, climb, roll, yaw, yaw bias, track error].
struct WheelHeading {
  static constexpr int kDof = 8;

  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< m, of the axle's middle
  double climb = 0.0;                               ///< rad, nose up
  double roll = 0.0;                                ///< rad, right side down
  double yaw = 0.0;                                 ///< rad, counter-clockwise from the map's x
  double yaw_bias = 0.0;                            ///< rad, the inertial heading reads too much
  double track_error = 0.0;  ///< the vehicle turns (1 - track_error) times what the wheels say

  Eigen::Quaterniond rotation() const;
};

/// First rows of the tangent.
enum WheelHeadingRow { kAxle = 0, kClimb = 3, kRoll = 4, kYaw = 5, kYawBias = 6, kTrackError = 7 };

WheelHeading plus(const WheelHeading& x, const Tangent<WheelHeading>& d);
Tangent<WheelHeading> minus(const WheelHeading& to, const WheelHeading& from);

/// How much one wheel's way means for the state: columns d next / d left way, d next / d right way.
Matrix<8, 2> wayGain(const WheelHeading& x, const ins::WheelWay& way, double track);

/// One wheel reading: the chord of the arc along its middle heading, along the slope. `level_walk` (rad per
/// sqrt(s)) is how climb and roll wander.
filters::Step<WheelHeading> driven(const WheelHeading& x, const ins::WheelWay& way, double dt,
                                   const ins::OdometerConfig& odometer, const HeadingFilterConfig& config,
                                   double level_walk);

/// Climb, roll and yaw as an inertial attitude has them (rad).
struct SeenAttitude {
  double climb = 0.0;
  double roll = 0.0;
  double yaw = 0.0;
};
SeenAttitude seenAttitude(const Eigen::Matrix3d& R_map_body);
filters::Innovation<WheelHeading, 3> attitudeSeen(const WheelHeading& x, const SeenAttitude& seen);

/// Covariance of the pose tangent [axle's place (map), rotation (body axes)].
Matrix<6, 6> poseCovariance(const Belief<WheelHeading>& belief);

}  // namespace pos::estimation
