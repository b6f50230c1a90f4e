#include "pos/sim/vehicle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"

namespace pos::sim {

const Mount& Vehicle::mount(std::string_view mount_name) const {
  const auto found =
      std::find_if(mounts.begin(), mounts.end(), [&](const Mount& m) { return m.name == mount_name; });
  if (found != mounts.end()) return *found;
  std::string names;
  for (const Mount& there : mounts) names += (names.empty() ? "" : ", ") + there.name;
  refuse("the vehicle has no such mount", "mounts", std::string(mount_name),
         names.empty() ? "a mount" : names);
}

Vehicle validated(const Vehicle& vehicle) {
  requirePositive(vehicle.length, "length");
  requirePositive(vehicle.width, "width");
  requirePositive(vehicle.height, "height");
  requireNotNegative(vehicle.clearance, "clearance");
  requireFinite(vehicle.centre_x, "centre_x");
  requirePositive(vehicle.max_speed, "max_speed");
  requireFinite(vehicle.encoder_axle_x, "encoder_axle_x");
  if (vehicle.steering != Steering::Guided) {
    requirePositive(vehicle.wheel_radius, "wheel_radius");
    requirePositive(vehicle.encoder_track, "encoder_track");
  }
  if (vehicle.steering != Steering::Guided && vehicle.steering != Steering::Differential) {
    requirePositive(vehicle.wheelbase, "wheelbase");
    requirePositive(vehicle.max_steer, "max_steer");
  }
  std::set<std::string> names;
  for (const Mount& mount : vehicle.mounts) {
    if (!mount.p_body.allFinite()) refuse("a mount is no place", "mounts", mount.name, "x, y, z in metres");
    if (!names.insert(mount.name).second)
      refuse("two mounts of one name", "mounts", mount.name, "unique names");
  }
  return vehicle;
}

Eigen::Vector3d pointVelocity(const Kinematics& body, const Eigen::Vector3d& p_body) {
  return body.R_map_body.transpose() * body.v_map + body.omega_body.cross(p_body);
}

Eigen::Vector3d pointPosition(const Kinematics& body, const Eigen::Vector3d& p_body) {
  return body.p_map + body.R_map_body * p_body;
}

WheelPair wheelGroundSpeeds(const Vehicle& vehicle, const Kinematics& body) {
  // A steered wheel rolls the way its point goes; an unsteered one has no sideways speed.
  const auto speed = [&](double side) {
    const Eigen::Vector3d v =
        pointVelocity(body, {vehicle.encoder_axle_x, side * 0.5 * vehicle.encoder_track, 0.0});
    return vehicle.encoder_axle_x == 0.0 ? v.x() : std::copysign(std::hypot(v.x(), v.y()), v.x());
  };
  return {speed(1.0), speed(-1.0)};
}

double steerAngle(const Vehicle& vehicle, double curvature) {
  switch (vehicle.steering) {
    case Steering::FrontAckermann:
      return std::atan(vehicle.wheelbase * curvature);
    case Steering::FourWheel:
      return std::atan(0.5 * vehicle.wheelbase * curvature);
    case Steering::Articulated:
      // Joint midway between the axles: each half turns its axle by the same angle.
      return 2.0 * std::atan(0.5 * vehicle.wheelbase * curvature);
    case Steering::Differential:
    case Steering::Guided:
      break;
  }
  return 0.0;
}

}  // namespace pos::sim
