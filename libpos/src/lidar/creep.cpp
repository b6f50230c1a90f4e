#include "pos/lidar/creep.hpp"

#include <cmath>

#include "pos/core/square.hpp"

namespace pos::lidar {

Creep creepOf(const IcpResult& registration, const DwellStand& stand) {
  const Pose2& T = registration.T_first_second;
  const Pose3 T_first_second = Pose3::fromXyzYawPitchRoll(T.x, T.y, 0.0, T.yaw, 0.0, 0.0);
  // The body's own way: the scanner's, without what its lever arm did while the body turned.
  const Pose3 T_body1_body2 = stand.T_body_sensor * T_first_second * inverse(stand.T_body_sensor);
  const Eigen::Vector3d moved_face = stand.R_face_body * T_body1_body2.translation;

  const Eigen::Vector3d along_sensor =
      stand.T_body_sensor.rotation.conjugate() * stand.R_face_body.transpose() * Eigen::Vector3d::UnitY();
  const Eigen::Vector2d along = along_sensor.head<2>();
  const double variance = along.dot(registration.covariance.topLeftCorner<2, 2>() * along);
  const bool held = !registration.weak || std::abs(registration.weak_axis.dot(along)) < std::sqrt(0.5);
  return {.value = moved_face.y() - stand.stop_difference,
          .advance = moved_face.x(),
          .sigma = std::sqrt(variance + square(stand.stop_difference_sigma)),
          .usable = registration.end == IcpEnd::Converged && held};
}

}  // namespace pos::lidar
