#pragma once
/// What sensors say as ROS 2 messages, and back. Readings that ROS has no message for have one of ours
/// (pos_msgs). Private to io.

#include <string>
#include <string_view>
#include <vector>

#include "cdr.hpp"
#include "pos/core/measurement.hpp"
#include "pos/io/mcap_writer.hpp"

namespace pos::io::ros {

/// sensor_msgs, nav_msgs, geometry_msgs where they fit, by the kind of the reading.
RosType sensorType(const Reading& reading);

/// A message's head.
struct Head {
  Stamp stamp = {};
  std::string frame = {};
};

/// nav_msgs/Odometry with what a log of increments knows: a planar pose in the frame "odom" that adds them
/// up, and the mean velocity over the last one with its covariance.
struct OdometryMessage {
  Head head;
  Pose2 pose = {};                                 ///< m, rad
  Vector<3> rates = Vector<3>::Zero();             ///< m/s, m/s, rad/s
  Matrix<3, 3> covariance = Matrix<3, 3>::Zero();  ///< of the rates; 0 where it is not known
};
std::string odometryMessage(const OdometryMessage& message);
OdometryMessage odometryFrom(std::string_view cdr);

/// The other readings; IMU increments must have their interval. `frame` is where the sensor sits.
std::string sensorMessage(Stamp stamp, const Reading& reading, const std::string& frame);

/// A reading with its message's head; readings without a value that pos needs come back as nothing, with why.
struct Decoded {
  Head head;
  std::optional<Reading> reading = {};
  std::string lack = {};
};
/// `type` is one of sensorType's names but for odometry's. Throws BadCdr.
Decoded sensorFrom(std::string_view type, std::string_view cdr);
/// Whether sensorFrom takes messages of this type.
bool isSensorType(std::string_view type);

/// A tf2_msgs/TFMessage.
struct Transform {
  std::string parent;
  std::string child;
  Pose3 T_parent_child;
};
std::vector<Transform> transformsFrom(std::string_view cdr);

}  // namespace pos::io::ros
