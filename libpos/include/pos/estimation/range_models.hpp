#pragma once
/// Motion and sensor models of `range_odometry` (docs/math/range_odometry.md). Pure functions of the state.

#include <Eigen/Core>

#include "pos/core/measurement.hpp"
#include "pos/estimation/configs.hpp"
#include "pos/estimation/range_state.hpp"
#include "pos/filters/ekf.hpp"

namespace pos::estimation {

/// Covariance of an odometry increment's tangent [x y yaw] in the previous body frame: each density times the
/// square root of the distance, angle or time it grows with. dt in s.
Matrix<3, 3> odometryCovariance(const OdometryNoise& noise, const Pose2& increment, double dt);

/// State driven by odometry increments: the translation times the wheel scale, the turn less the gyro bias.
struct OdometryMotion {
  const RangeLayout* layout;
  const RangeOdometryConfig* config;
  filters::Step<RangeState> step(const RangeState& x, const Pose2& increment, double dt) const;
};

/// No odometry: velocity and yaw rate are states driven by white acceleration.
struct ConstantVelocityMotion {
  const RangeLayout* layout;
  const RangeOdometryConfig* config;
  struct NoInput {};
  filters::Step<RangeState> step(const RangeState& x, NoInput, double dt) const;
};

/// filters::predict for steps of these two motions, whose F is the identity but for elements right of the
/// diagonal in the rows of the pose: P <- F P F' + Qd costs O(n^2) instead of O(n^3) (bench/range_odometry).
void predictPose(Belief<RangeState>& belief, const filters::Step<RangeState>& step);

/// Velocity of the body where odometry gives it: forward and left in m/s (body axes), yaw rate in rad/s.
struct BodyVelocity {
  Eigen::Vector2d linear = Eigen::Vector2d::Zero();
  double yaw_rate = 0.0;
};

/// One range seen from the state. All lengths in m, map axes unless named body.
struct RangeGeometry {
  Eigen::Vector3d anchor_map = Eigen::Vector3d::Zero();
  AnchorId anchor = 0;
  Eigen::Vector3d tag_body = Eigen::Vector3d::Zero();
  double body_height = 0.0;        ///< m, z of the body frame in the map
  double range_bias = 0.0;         ///< m, the anchor's surveyed bias
  double age = 0.0;                ///< s, stamp of the range minus stamp of the state
  BodyVelocity odometry_velocity;  ///< carries the state over `age` where velocity is not a state
};

/// Prediction of a range with its Jacobian, and the second-order terms of the geometry: at short distance, or
/// while the position is poorly known, the distance to an anchor is not linear in the position.
struct RangePrediction {
  double range = 0.0;               ///< m
  TangentRows<RangeState, 1> H;     ///< d range / d tangent
  double curvature_mean = 0.0;      ///< m, tr(Hessian P) / 2: what the mean of the range exceeds `range` by
  double curvature_variance = 0.0;  ///< m^2, tr((Hessian P)^2) / 2
  double distance = 0.0;            ///< m, geometric
};

/// h(x) = scale * |p_tag(t - latency) - p_anchor| + offset + anchor offset + anchor bias.
/// `covariance` is the state's; only its position block enters the second-order terms
/// (Bar-Shalom, Li, Kirubarajan 2001, section 10.3.3).
RangePrediction predictedRange(const RangeState& x, const RangeLayout& layout,
                               const TangentMatrix<RangeState>& covariance, const RangeGeometry& geometry);

/// A point of the body (m, forward and left) seen at a place of the map (m).
struct SeenPoint {
  Eigen::Vector2d p_map = Eigen::Vector2d::Zero();
  Eigen::Vector2d p_body = Eigen::Vector2d::Zero();
};

/// A position fix at `age` seconds after the state; two rows.
filters::Innovation<RangeState, 2> positionInnovation(const RangeState& x, const RangeLayout& layout,
                                                      const SeenPoint& seen, double age,
                                                      const BodyVelocity& odometry_velocity);

/// A position fix with a heading (rad) at the same moment; three rows, the last one's nu in (-pi, pi].
filters::Innovation<RangeState, 3> poseInnovation(const RangeState& x, const RangeLayout& layout,
                                                  const SeenPoint& seen, double yaw, double age,
                                                  const BodyVelocity& odometry_velocity);

}  // namespace pos::estimation
