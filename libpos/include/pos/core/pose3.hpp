#pragma once
/// Pose in space.

#include <Eigen/Geometry>

#include "pos/core/manifold.hpp"
#include "pos/core/pose2.hpp"

namespace pos {

/// T_parent_child: translation in metres (parent axes) and a unit quaternion child -> parent.
/// Tangent order [translation (parent axes), rotation (child axes, radians)].
struct Pose3 {
  static constexpr int kDof = 6;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  /// From position and yaw-pitch-roll (z-y-x, radians).
  static Pose3 fromXyzYawPitchRoll(double x, double y, double z, double yaw, double pitch, double roll);
  static Pose3 fromPlanar(const Pose2& pose, double z = 0.0);
  /// Heading of the child's x axis seen from above, (-pi, pi].
  double yaw() const;
  /// Dropped to the plane: x, y, yaw.
  Pose2 planar() const { return {translation.x(), translation.y(), yaw()}; }
};

Pose3 operator*(const Pose3& T_a_b, const Pose3& T_b_c);
Pose3 inverse(const Pose3& T_a_b);
Eigen::Vector3d operator*(const Pose3& T_parent_child, const Eigen::Vector3d& p_child);

Pose3 plus(const Pose3& x, const Vector<6>& d);
Vector<6> minus(const Pose3& to, const Pose3& from);

/// Rotation vector (radians) to quaternion and back; a series near zero keeps both exact there.
Eigen::Quaterniond quaternionFromRotationVector(const Eigen::Vector3d& w);
Eigen::Vector3d rotationVector(const Eigen::Quaterniond& q);

}  // namespace pos
