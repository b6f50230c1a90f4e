#pragma once
/// Planar pose: position in a parent frame and heading of the child frame.

#include <Eigen/Core>

#include "pos/core/angle.hpp"
#include "pos/core/manifold.hpp"

namespace pos {

/// T_parent_child in the plane: x, y in metres, yaw in radians counter-clockwise from the parent's +x.
/// Tangent order [x, y, yaw], translation expressed in the parent frame (so a covariance of a vehicle's
/// pose reads directly in map axes).
struct Pose2 {
  static constexpr int kDof = 3;
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;

  Eigen::Vector2d translation() const { return {x, y}; }
  bool operator==(const Pose2&) const = default;  ///< every bit, the yaw is not wrapped first
};

/// Rotation matrix of an angle: child coordinates to parent coordinates.
Eigen::Matrix2d rotation2(double yaw);

/// T_a_b * T_b_c = T_a_c.
Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c);
/// T_a_b to T_b_a.
Pose2 inverse(const Pose2& T_a_b);
/// A point given in the child frame, in parent coordinates.
Eigen::Vector2d operator*(const Pose2& T_parent_child, const Eigen::Vector2d& p_child);

Pose2 plus(const Pose2& x, const Vector<3>& d);
/// Tangent d with plus(from, d) = to; the yaw part is wrapped.
Vector<3> minus(const Pose2& to, const Pose2& from);

}  // namespace pos
