#include "pos/uwb/dual_tag.hpp"

#include <cmath>

namespace pos::uwb {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Signed angle from a to b.
double angleBetween(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::atan2(cross(a, b), a.dot(b));
}

}  // namespace

std::optional<SnapshotPose> snapshotPose(const TagPosition& left, const TagPosition& right,
                                         const TagPair& tags) {
  const Eigen::Vector2d b = left.p_map - right.p_map;
  const double length = b.norm();
  if (!(length > 1e-6)) return std::nullopt;
  const double yaw = angleBetween(tags.baseline(), b);
  const Eigen::Vector2d middle_body = 0.5 * (tags.left_body + tags.right_body);
  const Eigen::Vector2d lever_map = rotation2(yaw) * middle_body;
  const Eigen::Vector2d p = 0.5 * (left.p_map + right.p_map) - lever_map;

  // d yaw / d b = (-b_y, b_x) / |b|^2; the lever turns with the yaw
  const Eigen::RowVector2d dyaw_db = Eigen::RowVector2d(-b.y(), b.x()) / (length * length);
  const Eigen::Vector2d dp_dyaw(lever_map.y(), -lever_map.x());
  Matrix<3, 2> J_left;
  J_left << 0.5 * Eigen::Matrix2d::Identity() + dp_dyaw * dyaw_db, dyaw_db;
  Matrix<3, 2> J_right;
  J_right << 0.5 * Eigen::Matrix2d::Identity() - dp_dyaw * dyaw_db, -dyaw_db;

  SnapshotPose snapshot;
  snapshot.pose.mean = {p.x(), p.y(), wrapAngle(yaw)};
  snapshot.pose.covariance =
      J_left * left.covariance * J_left.transpose() + J_right * right.covariance * J_right.transpose();
  const Eigen::Vector2d direction = b / length;
  const double variance = direction.dot((left.covariance + right.covariance) * direction);
  const double excess = length - tags.length();
  snapshot.baseline_chi_square = variance > 0.0 ? excess * excess / variance : 0.0;
  return snapshot;
}

TagAdvance tagAdvance(const Eigen::Vector2d& left_before, const Eigen::Vector2d& right_before,
                      const Eigen::Vector2d& left_now, const Eigen::Vector2d& right_now) {
  return {0.5 * ((left_now - left_before) + (right_now - right_before)),
          angleBetween(left_before - right_before, left_now - right_now)};
}

DifferentialMapper::DifferentialMapper(const Pose2& start, const TagPair& tags,
                                       const Eigen::Vector2d& left_map, const Eigen::Vector2d& right_map)
    : middle_body_(0.5 * (tags.left_body + tags.right_body)),
      middle_map_(start * middle_body_),
      yaw_(start.yaw),
      left_map_(left_map),
      right_map_(right_map) {}

void DifferentialMapper::advance(const Eigen::Vector2d& left_map, const Eigen::Vector2d& right_map) {
  const TagAdvance step = tagAdvance(left_map_, right_map_, left_map, right_map);
  middle_map_ += step.translation;
  yaw_ = wrapAngle(yaw_ + step.rotation);
  left_map_ = left_map;
  right_map_ = right_map;
}

Pose2 DifferentialMapper::pose() const {
  const Eigen::Vector2d p = middle_map_ - rotation2(yaw_) * middle_body_;
  return {p.x(), p.y(), yaw_};
}

}  // namespace pos::uwb
