#include "ros_sensors.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

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

double orNone(const std::optional<double>& value) {
  return value.value_or(kNone);
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

}  // namespace

RosType sensorType(const Reading& reading) {
  // In the order of the variant.
  constexpr std::array kTypes{odometryType,  wheelSpeedsType, wheelTicksType, imuType,       beaconRangeType,
                              navSatFixType, laserScanType,   poseType,       passageFixType};
  static_assert(kTypes.size() == std::variant_size_v<Reading>);
  return kTypes.at(reading.index())();
}

std::string odometryMessage(const OdometryMessage& message) {
  Matrix<6, 6> twist = Matrix<6, 6>::Zero();
  twist(kPlanar, kPlanar) = message.covariance;
  CdrWriter out;
  header(out, message.head.stamp, kOdometryFrame)
      << std::string(kBodyFrame) << Pose3::fromPlanar(message.pose) << Matrix<6, 6>(Matrix<6, 6>::Zero())
      << Eigen::Vector3d(message.rates[0], message.rates[1], 0.0)
      << Eigen::Vector3d(0.0, 0.0, message.rates[2]) << twist;
  return out.bytes();
}

std::string sensorMessage(Stamp stamp, const Reading& reading, const std::string& frame) {
  CdrWriter out;
  header(out, stamp, frame);
  std::visit(Encode{out}, reading);
  return out.bytes();
}

}  // namespace pos::io::ros
