#pragma once
/// The parts that ROS 2 message definitions are made of, and how their values are stored. Private to io.

#include <Eigen/Geometry>
#include <array>
#include <initializer_list>
#include <string>

#include "cdr.hpp"
#include "pos/core/pose3.hpp"
#include "pos/core/stamp.hpp"
#include "pos/io/mcap_writer.hpp"

namespace pos::io::ros {

/// The frame that poses of the map are told in, and that of the vehicle's body.
inline constexpr const char* kMapFrame = "map";
inline constexpr const char* kBodyFrame = "base_link";

/// Where x, y and the turn about z stand in a pose's or a twist's six.
inline constexpr std::array<int, 3> kPlanar{0, 1, 5};

struct Part {
  const char* name;
  const char* fields;
};

inline constexpr Part kTime{"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"};
inline constexpr Part kDuration{"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"};
inline constexpr Part kHeader{"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"};
inline constexpr Part kColour{"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"};
inline constexpr Part kPoint{"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"};
inline constexpr Part kVector{"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"};
inline constexpr Part kQuaternion{"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"};
inline constexpr Part kPose{"geometry_msgs/Pose",
                            "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"};
inline constexpr Part kPoseCovariance{"geometry_msgs/PoseWithCovariance",
                                      "geometry_msgs/Pose pose\nfloat64[36] covariance\n"};
inline constexpr Part kTwist{"geometry_msgs/Twist",
                             "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"};
inline constexpr Part kTwistCovariance{"geometry_msgs/TwistWithCovariance",
                                       "geometry_msgs/Twist twist\nfloat64[36] covariance\n"};
inline constexpr Part kTransform{"geometry_msgs/Transform",
                                 "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"};
inline constexpr Part kTransformStamped{
    "geometry_msgs/TransformStamped",
    "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"};
inline constexpr Part kKeyValue{"diagnostic_msgs/KeyValue", "string key\nstring value\n"};
inline constexpr Part kStatus{
    "diagnostic_msgs/DiagnosticStatus",
    "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\nbyte level\nstring name\nstring "
    "message\nstring hardware_id\ndiagnostic_msgs/KeyValue[] values\n"};
inline constexpr Part kMarker{
    "visualization_msgs/Marker",
    "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\n"
    "geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool "
    "frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring text\nstring "
    "mesh_resource\nbool mesh_use_embedded_materials\n"};

/// A message of these fields, with the definitions of its parts behind it.
RosType typeOf(const char* name, const char* fields, std::initializer_list<Part> parts);

CdrWriter& operator<<(CdrWriter& out, const Eigen::Vector3d& v);
CdrWriter& operator<<(CdrWriter& out, const Eigen::Quaterniond& q);
CdrWriter& operator<<(CdrWriter& out, const Matrix<6, 6>& P);
CdrWriter& operator<<(CdrWriter& out, const Pose3& T);
/// std_msgs/Header.
CdrWriter& header(CdrWriter& out, Stamp stamp, const std::string& frame = kMapFrame);

}  // namespace pos::io::ros
