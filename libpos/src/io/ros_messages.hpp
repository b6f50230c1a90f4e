#pragma once
/// The ROS 2 messages that a run is told in: their definitions and their CDR bytes. Private to io.

#include <string>

#include "pos/core/estimate.hpp"
#include "pos/io/mcap_writer.hpp"
#include "pos/io/run_folder.hpp"
#include "pos/map/tunnel_map.hpp"
#include "ros_types.hpp"

namespace pos::io::ros {

RosType transformsType();
RosType poseType();
RosType odometryType();
RosType statusType();
RosType markersType();

/// tf2_msgs/TFMessage with one transform, from `parent` to `frame`.
std::string transforms(Stamp stamp, const Pose3& T_parent_frame, const std::string& frame,
                       const std::string& parent = kMapFrame);
/// geometry_msgs/PoseStamped in the map.
std::string pose(Stamp stamp, const Pose3& T_map_body);
/// nav_msgs/Odometry. Its covariance is that of the position and of a small rotation, both in map axes; a
/// twist that is not known has variances of 1e6.
std::string odometry(const Estimate& estimate, const std::string& frame);
/// diagnostic_msgs/DiagnosticArray with one status.
std::string status(const RunEvent& event);
/// visualization_msgs/MarkerArray: centrelines, anchors and chambers with their names.
std::string markers(Stamp stamp, const map::TunnelMap& map);

}  // namespace pos::io::ros
