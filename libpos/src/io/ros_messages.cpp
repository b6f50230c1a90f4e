#include "ros_messages.hpp"

#include <algorithm>
#include <cmath>

#include "pos/map/centreline.hpp"
#include "ros_types.hpp"

namespace pos::io::ros {
namespace {

// ---------------------------------------------------------------- markers

enum class Shape : std::int32_t { Sphere = 2, LineStrip = 4, Text = 9 };
constexpr double kUnknown = 1e6;  // variance

struct Marker {
  std::string group;
  Shape shape = Shape::Sphere;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  double size = 0.5;  ///< m
  std::array<float, 4> colour{};
  std::vector<Eigen::Vector3d> points = {};
  std::string text = {};
};

void put(CdrWriter& out, Stamp stamp, int id, const Marker& m) {
  const std::int32_t add = 0;
  header(out, stamp) << m.group << static_cast<std::int32_t>(id) << static_cast<std::int32_t>(m.shape) << add;
  out << Pose3{m.at, Eigen::Quaterniond::Identity()} << Eigen::Vector3d(m.size, m.size, m.size);
  for (const float channel : m.colour) out << channel;
  out << std::int32_t{0} << std::uint32_t{0} << false;  // for ever, in the frame as it is
  out.count(m.points.size());
  for (const Eigen::Vector3d& point : m.points) out << point;
  out.count(0) << m.text << std::string() << false;
}

std::vector<Eigen::Vector3d> drawn(const map::Centreline& line) {
  constexpr double kStep = 2.0;  // m
  const int steps = std::max(1, static_cast<int>(std::ceil(line.length() / kStep)));
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k <= steps; ++k)
    points.push_back(line.at(line.chainageStart() + line.length() * k / steps).p_map);
  return points;
}

constexpr std::array<float, 4> kGrey{0.5F, 0.5F, 0.5F, 1.0F};
constexpr std::array<float, 4> kBlue{0.1F, 0.4F, 0.9F, 1.0F};
constexpr std::array<float, 4> kGreen{0.1F, 0.6F, 0.3F, 1.0F};
const Eigen::Vector3d kAbove(0.0, 0.0, 1.0);  // m, a name over its object

std::vector<Marker> markersOf(const map::TunnelMap& map) {
  std::vector<Marker> all;
  for (const map::Roadway& roadway : map.roadways) {
    const map::Centreline line(roadway);
    all.push_back({.group = "roadways",
                   .shape = Shape::LineStrip,
                   .size = 0.3,
                   .colour = kGrey,
                   .points = drawn(line)});
    const double middle = 0.5 * (line.chainageStart() + line.chainageEnd());
    all.push_back({.group = "roadway_names",
                   .shape = Shape::Text,
                   .at = line.at(middle).p_map + kAbove,
                   .size = 1.5,
                   .colour = kGrey,
                   .text = roadway.id});
  }
  for (const map::Anchor& anchor : map.anchors) {
    all.push_back({.group = "anchors", .at = anchor.p_map, .colour = kBlue});
    all.push_back({.group = "anchor_names",
                   .shape = Shape::Text,
                   .at = anchor.p_map + kAbove,
                   .size = 0.8,
                   .colour = kBlue,
                   .text = std::to_string(anchor.id)});
  }
  for (const map::Chamber& chamber : map.chambers) {
    const map::Roadway* const roadway = map.findRoadway(chamber.place.roadway);
    if (roadway == nullptr) continue;
    const Eigen::Vector3d at = map::Centreline(*roadway).at(chamber.place.chainage).p_map;
    all.push_back({.group = "chambers", .at = at, .size = 1.0, .colour = kGreen});
    all.push_back({.group = "chamber_names",
                   .shape = Shape::Text,
                   .at = at + kAbove,
                   .size = 1.0,
                   .colour = kGreen,
                   .text = chamber.id});
  }
  return all;
}

}  // namespace

RosType transformsType() {
  return typeOf("tf2_msgs/msg/TFMessage", "geometry_msgs/TransformStamped[] transforms\n",
                {kTransformStamped, kHeader, kTime, kTransform, kVector, kQuaternion});
}
RosType poseType() {
  return typeOf("geometry_msgs/msg/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n",
                {kHeader, kTime, kPose, kPoint, kQuaternion});
}
RosType odometryType() {
  return typeOf(
      "nav_msgs/msg/Odometry",
      "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
      "geometry_msgs/TwistWithCovariance twist\n",
      {kHeader, kTime, kPoseCovariance, kPose, kPoint, kQuaternion, kTwistCovariance, kTwist, kVector});
}
RosType statusType() {
  return typeOf("diagnostic_msgs/msg/DiagnosticArray",
                "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n",
                {kHeader, kTime, kStatus, kKeyValue});
}
RosType markersType() {
  return typeOf("visualization_msgs/msg/MarkerArray", "visualization_msgs/Marker[] markers\n",
                {kMarker, kHeader, kTime, kDuration, kPose, kPoint, kQuaternion, kVector, kColour});
}

std::string transforms(Stamp stamp, const Pose3& T_parent_frame, const std::string& frame,
                       const std::string& parent) {
  CdrWriter out;
  header(out.count(1), stamp, parent) << frame;
  return (out << T_parent_frame).bytes();
}

std::string pose(Stamp stamp, const Pose3& T_map_body) {
  CdrWriter out;
  return (header(out, stamp) << T_map_body).bytes();
}

std::string odometry(const Estimate& estimate, const std::string& frame) {
  Matrix<6, 6> J = Matrix<6, 6>::Identity();
  J.bottomRightCorner<3, 3>() = estimate.T_map_body.rotation.toRotationMatrix();
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
  Matrix<6, 6> twist = kUnknown * Matrix<6, 6>::Identity();
  if (estimate.twist) {
    linear.head<2>() = estimate.twist->rates.head<2>();
    angular.z() = estimate.twist->rates[2];
    twist(kPlanar, kPlanar) = estimate.twist->covariance;
  }
  CdrWriter out;
  header(out, estimate.stamp) << frame << estimate.T_map_body
                              << Matrix<6, 6>(J * estimate.covariance * J.transpose()) << linear << angular
                              << twist;
  return out.bytes();
}

std::string status(const RunEvent& event) {
  constexpr std::uint8_t kWarn = 1;
  CdrWriter out;
  header(out, event.stamp).count(1) << kWarn << (event.estimator + ": " + event.kind) << event.detail
                                    << event.sensor;
  return out.count(0).bytes();
}

std::string markers(Stamp stamp, const map::TunnelMap& map) {
  const std::vector<Marker> all = markersOf(map);
  CdrWriter out;
  out.count(all.size());
  int id = 0;
  for (const Marker& marker : all) put(out, stamp, id++, marker);
  return out.bytes();
}

}  // namespace pos::io::ros
