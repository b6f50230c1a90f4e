#pragma once
/// Vehicles: their dimensions, where things sit on them, how their points and wheels move.
///
/// The body origin is the point whose velocity lies along the body's x axis on a bend: the middle of the
/// non-steered axle (Ackermann, differential), the vehicle's centre (symmetric four-wheel steer, shearer),
/// the middle of the rear axle of an articulated loader. At origin height z = 0 is the floor.

#include <string>
#include <string_view>
#include <vector>

#include "pos/sim/motion.hpp"

namespace pos::sim {

enum class Steering { FrontAckermann, FourWheel, Differential, Articulated, Guided };

/// A place on the body: a tag, an antenna, the inertial unit, a scanner.
struct Mount {
  std::string name = {};
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< m, FLU

  bool operator==(const Mount&) const = default;
};

struct Vehicle {
  std::string name = {};
  Steering steering = Steering::FrontAckermann;
  double length = 0.0;        ///< m over all
  double width = 0.0;         ///< m over all
  double height = 0.0;        ///< m
  double clearance = 0.0;     ///< m under the body
  double centre_x = 0.0;      ///< m from the body origin forward to the middle of the length
  double wheelbase = 0.0;     ///< m, front to rear axle
  double front_track = 0.0;   ///< m between the middles of the tyres
  double rear_track = 0.0;    ///< m
  double wheel_radius = 0.0;  ///< m
  double wheel_width = 0.0;   ///< m
  double max_speed = 0.0;     ///< m/s
  double max_steer = 0.0;     ///< rad, of a wheel, or of the joint
  /// m from the body origin forward to the axle whose wheels carry the encoders; their track is
  /// `encoder_track`.
  double encoder_axle_x = 0.0;
  double encoder_track = 0.0;  ///< m
  std::vector<Mount> mounts = {};

  bool operator==(const Vehicle&) const = default;

  /// The mount of that name; throws ConfigError listing those there are.
  const Mount& mount(std::string_view mount_name) const;
};

/// The vehicle itself when its figures make sense; throws ConfigError with the key.
Vehicle validated(const Vehicle& vehicle);

/// Velocity of a point of the body, m/s in body axes.
Eigen::Vector3d pointVelocity(const Kinematics& body, const Eigen::Vector3d& p_body);
/// Where a point of the body is, m in the map.
Eigen::Vector3d pointPosition(const Kinematics& body, const Eigen::Vector3d& p_body);

/// Speeds over ground of the two encoder wheels along the body's x axis, m/s.
struct WheelPair {
  double left = 0.0;
  double right = 0.0;
};
WheelPair wheelGroundSpeeds(const Vehicle& vehicle, const Kinematics& body);

/// Steering angle that drives a path of this curvature (1/m), rad: of the inner bicycle wheel (Ackermann), of
/// front and minus rear wheels (four-wheel), of the joint (articulated); 0 for the others.
double steerAngle(const Vehicle& vehicle, double curvature);

}  // namespace pos::sim
