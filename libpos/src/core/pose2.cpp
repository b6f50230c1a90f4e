#include "pos/core/pose2.hpp"

namespace pos {

Eigen::Matrix2d rotation2(double yaw) {
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}

Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c) {
  const Eigen::Vector2d p = T_a_b * T_b_c.translation();
  return {p.x(), p.y(), wrapAngle(T_a_b.yaw + T_b_c.yaw)};
}

Pose2 inverse(const Pose2& T_a_b) {
  const Eigen::Vector2d p = -(rotation2(-T_a_b.yaw) * T_a_b.translation());
  return {p.x(), p.y(), wrapAngle(-T_a_b.yaw)};
}

Eigen::Vector2d operator*(const Pose2& T_parent_child, const Eigen::Vector2d& p_child) {
  return rotation2(T_parent_child.yaw) * p_child + T_parent_child.translation();
}

Pose2 plus(const Pose2& x, const Vector<3>& d) {
  return {x.x + d[0], x.y + d[1], wrapAngle(x.yaw + d[2])};
}

Vector<3> minus(const Pose2& to, const Pose2& from) {
  return {to.x - from.x, to.y - from.y, wrapAngle(to.yaw - from.yaw)};
}

}  // namespace pos
