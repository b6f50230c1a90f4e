#include "pos/core/pose3.hpp"

#include <cmath>

namespace pos {

Pose3 Pose3::fromXyzYawPitchRoll(double x, double y, double z, double yaw, double pitch, double roll) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return {{x, y, z},
          AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
              AngleAxisd(roll, Vector3d::UnitX())};
}

Pose3 Pose3::fromPlanar(const Pose2& pose, double z) {
  return fromXyzYawPitchRoll(pose.x, pose.y, z, pose.yaw, 0.0, 0.0);
}

double Pose3::yaw() const {
  const Eigen::Vector3d forward = rotation * Eigen::Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

Pose3 operator*(const Pose3& T_a_b, const Pose3& T_b_c) {
  return {T_a_b * T_b_c.translation, (T_a_b.rotation * T_b_c.rotation).normalized()};
}

Pose3 inverse(const Pose3& T_a_b) {
  const Eigen::Quaterniond r = T_a_b.rotation.conjugate();
  return {-(r * T_a_b.translation), r};
}

Eigen::Vector3d operator*(const Pose3& T_parent_child, const Eigen::Vector3d& p_child) {
  return T_parent_child.rotation * p_child + T_parent_child.translation;
}

Pose3 plus(const Pose3& x, const Vector<6>& d) {
  return {x.translation + d.head<3>(), (x.rotation * quaternionFromRotationVector(d.tail<3>())).normalized()};
}

Vector<6> minus(const Pose3& to, const Pose3& from) {
  Vector<6> d;
  d << to.translation - from.translation, rotationVector(from.rotation.conjugate() * to.rotation);
  return d;
}

Eigen::Quaterniond quaternionFromRotationVector(const Eigen::Vector3d& w) {
  const double half = 0.5 * w.norm();
  // sin(half) / (2 half) as a series where the quotient loses digits
  const double scale = half < 1e-4 ? 0.5 * (1.0 - half * half / 6.0) : 0.5 * std::sin(half) / half;
  const Eigen::Vector3d v = scale * w;
  return {std::cos(half), v.x(), v.y(), v.z()};
}

Eigen::Vector3d rotationVector(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;  // q and -q are the same rotation: take the short way
  const Eigen::Vector3d v = sign * q.vec();
  const double sine = v.norm();
  const double cosine = sign * q.w();
  const double scale = sine < 1e-4 ? 2.0 * (1.0 + sine * sine / 6.0) : 2.0 * std::atan2(sine, cosine) / sine;
  return scale * v;
}

}  // namespace pos
