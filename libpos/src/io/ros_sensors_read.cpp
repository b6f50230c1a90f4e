#include <array>
#include <cmath>
#include <stdexcept>

#include "gnss_quality.hpp"
#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"
#include "ros_sensors.hpp"
#include "ros_types.hpp"

namespace pos::io::ros {
namespace {

template <int N>
CdrReader& operator>>(CdrReader& in, Eigen::Matrix<double, N, N>& P) {
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) in >> P(i, j);
  }
  return in;
}
CdrReader& operator>>(CdrReader& in, Eigen::Vector3d& v) {
  return in >> v.x() >> v.y() >> v.z();
}
CdrReader& operator>>(CdrReader& in, Pose3& T) {
  in >> T.translation >> T.rotation.x() >> T.rotation.y() >> T.rotation.z() >> T.rotation.w();
  if (std::abs(T.rotation.norm() - 1.0) > 1e-3 || !T.translation.allFinite())
    throw BadCdr("a pose that is none");
  if (std::abs(T.rotation.squaredNorm() - 1.0) > 1e-12) T.rotation.normalize();
  return in;
}

Head headFrom(CdrReader& in) {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  Head head;
  in >> sec >> nanosec >> head.frame;
  head.stamp = Stamp{std::chrono::seconds(sec) + std::chrono::nanoseconds(nanosec)};
  return head;
}

std::optional<double> unlessNone(double value) {
  return std::isnan(value) ? std::optional<double>{} : value;
}

using Body = void (*)(CdrReader&, Decoded&);

void readImu(CdrReader& in, Decoded& out) {
  std::array<double, 4> rotation{};
  Matrix<3, 3> covariance;
  Matrix<3, 3> of_rates;
  Matrix<3, 3> of_force;
  ImuSample sample;
  for (double& value : rotation) in >> value;
  in >> covariance >> sample.angular >> of_rates >> sample.linear >> of_force;
  if (of_rates(0, 0) == -1.0 || of_force(0, 0) == -1.0) {
    out.lack = "without angular velocity or linear acceleration";
    return;
  }
  out.reading = sample;
}

/// A ground-based augmentation is a differential fix or one by carrier phase: the variance to the east tells.
GnssFix::Quality qualityOf(int status, const std::optional<double>& variance) {
  using Quality = GnssFix::Quality;
  constexpr double kFixed = 0.1;  // m
  constexpr double kFloat = 0.5;
  if (status < 0) return Quality::None;
  if (status == 0) return Quality::Autonomous;
  if (status == 1 || !variance) return Quality::Differential;
  if (*variance <= kFixed * kFixed) return Quality::RtkFixed;
  return *variance <= kFloat * kFloat ? Quality::RtkFloat : Quality::Differential;
}

void readFix(CdrReader& in, Decoded& out) {
  std::int8_t status = 0;
  std::uint16_t service = 0;
  std::uint8_t type = 0;
  GnssFix fix;
  in >> status >> service >> fix.latitude >> fix.longitude >> fix.altitude >> fix.covariance_enu >> type;
  fix.latitude = radians(fix.latitude);
  fix.longitude = radians(fix.longitude);
  const bool known = type != 0;
  fix.quality = qualityOf(status, known ? std::optional(fix.covariance_enu(0, 0)) : std::nullopt);
  if (!known) fix.covariance_enu = defaultCovariance(fix.quality, 1.0);
  out.reading = fix;
}

void readScan(CdrReader& in, Decoded& out) {
  std::array<float, 7> head{};  // first, last, step, time between beams, between scans, least, largest
  for (float& value : head) in >> value;
  Scan2D scan;
  scan.angle_first = static_cast<double>(head[0]);
  scan.angle_step = static_cast<double>(head[2]);
  scan.range_max = static_cast<double>(head[6]);
  const std::uint32_t beams = in.count(sizeof(float));
  scan.ranges.resize(beams);
  scan.valid.resize(beams);
  for (std::uint32_t i = 0; i < beams; ++i) {
    float range = 0.0F;
    in >> range;
    const bool valid = std::isfinite(range) && range > 0.0F && range >= head[5] && range <= head[6];
    scan.ranges[i] = valid ? range : 0.0F;
    scan.valid[i] = valid ? 1 : 0;
  }
  out.reading = std::move(scan);
}

void readRange(CdrReader& in, Decoded& out) {
  BeaconRange r;
  double sigma = 0.0;
  double power = 0.0;
  double first_path = 0.0;
  Eigen::Vector3d tag;
  in >> r.tag >> r.anchor >> r.range >> sigma >> tag >> power >> first_path;
  r.sigma = unlessNone(sigma);
  if (!tag.hasNaN()) r.tag_body = tag;
  r.rx_power_dbm = unlessNone(power);
  r.first_path_power_dbm = unlessNone(first_path);
  out.reading = r;
}

void readSpeeds(CdrReader& in, Decoded& out) {
  WheelSpeeds r;
  double yaw_rate = 0.0;
  in >> r.left >> r.right >> yaw_rate;
  r.yaw_rate = unlessNone(yaw_rate);
  out.reading = r;
}

void readTicks(CdrReader& in, Decoded& out) {
  WheelTicks r;
  in >> r.left >> r.right;
  out.reading = r;
}

void readPose(CdrReader& in, Decoded& out) {
  PoseTruth r;
  in >> r.T_map_body;
  out.reading = r;
}

void readPassage(CdrReader& in, Decoded& out) {
  PassageFix r;
  double yaw = 0.0;
  double sigma = 0.0;
  in >> r.place >> r.p_map >> r.covariance >> r.p_body >> yaw >> sigma;
  r.yaw = unlessNone(yaw);
  r.yaw_sigma = unlessNone(sigma);
  out.reading = r;
}

struct Known {
  std::string_view type;
  Body read;
};
constexpr std::array<Known, 8> kKnown{{{"sensor_msgs/msg/Imu", readImu},
                                       {"sensor_msgs/msg/NavSatFix", readFix},
                                       {"sensor_msgs/msg/LaserScan", readScan},
                                       {"geometry_msgs/msg/PoseStamped", readPose},
                                       {"pos_msgs/msg/BeaconRange", readRange},
                                       {"pos_msgs/msg/WheelSpeeds", readSpeeds},
                                       {"pos_msgs/msg/WheelTicks", readTicks},
                                       {"pos_msgs/msg/PassageFix", readPassage}}};

Body bodyOf(std::string_view type) {
  for (const Known& known : kKnown) {
    if (known.type == type) return known.read;
  }
  return nullptr;
}

}  // namespace

OdometryMessage odometryFrom(std::string_view cdr) {
  CdrReader in(cdr);
  OdometryMessage message;
  message.head = headFrom(in);
  std::string child;
  Pose3 T;
  Matrix<6, 6> of_pose;
  Matrix<6, 6> of_twist;
  Eigen::Vector3d linear;
  Eigen::Vector3d angular;
  in >> child >> T >> of_pose >> linear >> angular >> of_twist;
  message.pose = T.planar();
  message.rates = {linear.x(), linear.y(), angular.z()};
  message.covariance = of_twist(kPlanar, kPlanar);
  return message;
}

bool isSensorType(std::string_view type) {
  return bodyOf(type) != nullptr;
}

Decoded sensorFrom(std::string_view type, std::string_view cdr) {
  const Body read = bodyOf(type);
  ensure(read != nullptr, "a message of no sensor");
  CdrReader in(cdr);
  Decoded result;
  result.head = headFrom(in);
  read(in, result);
  return result;
}

std::vector<Transform> transformsFrom(std::string_view cdr) {
  CdrReader in(cdr);
  std::vector<Transform> all(in.count(64));
  for (Transform& transform : all) {
    transform.parent = headFrom(in).frame;
    in >> transform.child >> transform.T_parent_child;
  }
  return all;
}

}  // namespace pos::io::ros
