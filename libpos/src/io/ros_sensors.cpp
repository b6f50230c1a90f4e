#include "ros_sensors.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "gnss_quality.hpp"
#include "pos/core/angle.hpp"
#include "ros_messages.hpp"
#include "ros_types.hpp"

namespace pos::io::ros {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kOdometryFrame = "odom";

// ---------------------------------------------------------------- definitions

constexpr Part kNavSatStatus{
    "sensor_msgs/NavSatStatus",
    "int8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\nint8 STATUS_GBAS_FIX=2\n"
    "int8 status\nuint16 SERVICE_GPS=1\nuint16 service\n"};

RosType imuType() {
  return typeOf(
      "sensor_msgs/msg/Imu",
      "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
      "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
      "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n",
      {kHeader, kTime, kQuaternion, kVector});
}
RosType navSatFixType() {
  return typeOf(
      "sensor_msgs/msg/NavSatFix",
      "std_msgs/Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\nfloat64 longitude\n"
      "float64 altitude\nfloat64[9] position_covariance\nuint8 COVARIANCE_TYPE_UNKNOWN=0\nuint8 "
      "COVARIANCE_TYPE_KNOWN=3\nuint8 position_covariance_type\n",
      {kHeader, kTime, kNavSatStatus});
}
RosType laserScanType() {
  return typeOf(
      "sensor_msgs/msg/LaserScan",
      "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 "
      "time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] "
      "intensities\n",
      {kHeader, kTime});
}
/// NaN stands for what the sensor did not say.
RosType beaconRangeType() {
  return typeOf("pos_msgs/msg/BeaconRange",
                "std_msgs/Header header\nint32 tag\nint32 anchor\nfloat64 range\nfloat64 sigma\n"
                "geometry_msgs/Vector3 tag_position\nfloat64 rx_power_dbm\nfloat64 first_path_power_dbm\n",
                {kHeader, kTime, kVector});
}
RosType wheelSpeedsType() {
  return typeOf("pos_msgs/msg/WheelSpeeds",
                "std_msgs/Header header\nfloat64 left\nfloat64 right\nfloat64 yaw_rate\n", {kHeader, kTime});
}
RosType wheelTicksType() {
  return typeOf("pos_msgs/msg/WheelTicks", "std_msgs/Header header\nint64 left\nint64 right\n",
                {kHeader, kTime});
}
RosType passageFixType() {
  return typeOf(
      "pos_msgs/msg/PassageFix",
      "std_msgs/Header header\nstring place\ngeometry_msgs/Vector3 position\nfloat64[9] covariance\n"
      "geometry_msgs/Vector3 reader_position\nfloat64 yaw\nfloat64 yaw_sigma\n",
      {kHeader, kTime, kVector});
}

// ---------------------------------------------------------------- values

using ros::operator<<;  // which those below would hide

template <int N>
CdrWriter& operator<<(CdrWriter& out, const Eigen::Matrix<double, N, N>& P) {
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) out << P(i, j);
  }
  return out;
}
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

double orNone(const std::optional<double>& value) {
  return value.value_or(kNone);
}
std::optional<double> unlessNone(double value) {
  return std::isnan(value) ? std::optional<double>{} : value;
}

struct Encode {
  CdrWriter& out;

  void operator()(const OdometryIncrement&) const { throw ContractError("odometry has a writer of its own"); }
  void operator()(const WheelSpeeds& r) const { out << r.left << r.right << orNone(r.yaw_rate); }
  void operator()(const WheelTicks& r) const { out << r.left << r.right; }
  void operator()(const ImuSample& r) const {
    const bool whole = r.kind == ImuSample::Kind::Rates;
    const double dt = whole ? 1.0 : seconds(r.interval.value());
    Matrix<3, 3> absent = Matrix<3, 3>::Zero();
    const Matrix<3, 3> unknown = Matrix<3, 3>::Zero();
    absent(0, 0) = -1.0;
    out << Eigen::Quaterniond::Identity() << absent << Eigen::Vector3d(r.angular / dt) << unknown
        << Eigen::Vector3d(r.linear / dt) << unknown;
  }
  void operator()(const BeaconRange& r) const {
    out << r.tag << r.anchor << r.range << orNone(r.sigma)
        << Eigen::Vector3d(r.tag_body.value_or(Eigen::Vector3d::Constant(kNone))) << orNone(r.rx_power_dbm)
        << orNone(r.first_path_power_dbm);
  }
  void operator()(const GnssFix& r) const {
    constexpr std::array<std::int8_t, 5> kStatus{-1, 0, 1, 2, 2};  // in the order of Quality
    constexpr std::uint16_t kGps = 1;
    constexpr std::uint8_t kKnown = 3;
    out << kStatus.at(static_cast<std::size_t>(r.quality)) << kGps << degrees(r.latitude)
        << degrees(r.longitude) << r.altitude << r.covariance_enu << kKnown;
  }
  void operator()(const Scan2D& r) const {
    const auto beams = static_cast<double>(r.ranges.size());
    const float unknown = 0.0F;
    out << static_cast<float>(r.angle_first)
        << static_cast<float>(r.angle_first + r.angle_step * (beams - 1.0))
        << static_cast<float>(r.angle_step) << unknown << unknown << 0.0F << static_cast<float>(r.range_max);
    out.count(r.ranges.size());
    for (std::size_t i = 0; i < r.ranges.size(); ++i)
      out << (r.valid[i] != 0 ? r.ranges[i] : std::numeric_limits<float>::infinity());
    out.count(0);
  }
  void operator()(const PoseTruth& r) const { out << r.T_map_body; }
  void operator()(const PassageFix& r) const {
    out << r.place << r.p_map << r.covariance << r.p_body << orNone(r.yaw) << orNone(r.yaw_sigma);
  }
};

// ---------------------------------------------------------------- reading

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

void readFix(CdrReader& in, Decoded& out) {
  std::int8_t status = 0;
  std::uint16_t service = 0;
  std::uint8_t type = 0;
  GnssFix fix;
  in >> status >> service >> fix.latitude >> fix.longitude >> fix.altitude >> fix.covariance_enu >> type;
  fix.latitude = radians(fix.latitude);
  fix.longitude = radians(fix.longitude);
  // A ground-based augmentation is a differential fix or one by carrier phase: the covariance tells.
  constexpr double kFixed = 0.1;  // m
  constexpr double kFloat = 0.5;
  const double sigma = std::sqrt(std::max(0.0, fix.covariance_enu(0, 0)));
  const bool known = type != 0;
  using Quality = GnssFix::Quality;
  fix.quality = status < 0              ? Quality::None
                : status == 0           ? Quality::Autonomous
                : status == 1 || !known ? Quality::Differential
                : sigma <= kFixed       ? Quality::RtkFixed
                : sigma <= kFloat       ? Quality::RtkFloat
                                        : Quality::Differential;
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

RosType sensorType(const Reading& reading) {
  // In the order of the variant.
  constexpr std::array kTypes{odometryType,  wheelSpeedsType, wheelTicksType, imuType,       beaconRangeType,
                              navSatFixType, laserScanType,   poseType,       passageFixType};
  static_assert(kTypes.size() == std::variant_size_v<Reading>);
  return kTypes.at(reading.index())();
}

std::string odometryMessage(const OdometryMessage& message) {
  const std::array<int, 3> rows{0, 1, 5};
  Matrix<6, 6> twist = Matrix<6, 6>::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      twist(rows[i], rows[j]) =
          message.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
  CdrWriter out;
  header(out, message.head.stamp, kOdometryFrame)
      << std::string(kBodyFrame) << Pose3::fromPlanar(message.pose) << Matrix<6, 6>(Matrix<6, 6>::Zero())
      << Eigen::Vector3d(message.rates[0], message.rates[1], 0.0)
      << Eigen::Vector3d(0.0, 0.0, message.rates[2]) << twist;
  return out.bytes();
}

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
  const std::array<int, 3> rows{0, 1, 5};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      message.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          of_twist(rows[i], rows[j]);
    }
  }
  return message;
}

std::string sensorMessage(Stamp stamp, const Reading& reading, const std::string& frame) {
  CdrWriter out;
  header(out, stamp, frame);
  std::visit(Encode{out}, reading);
  return out.bytes();
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
