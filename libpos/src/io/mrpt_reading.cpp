/// MRPT observations to readings.
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBeaconRanges.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <charconv>
#include <cmath>

#include "gnss_quality.hpp"
#include "mrpt_conversion.hpp"
#include "mrpt_values.hpp"

namespace pos::io {
namespace {

using namespace mrpt::obs;

constexpr std::string_view kTagMark = ";tag=";
constexpr double kRadPerDegree = kPi / 180.0;

/// An enum read from a file may hold any number; looking at it as its enum would be undefined.
template <typename Enum>
std::underlying_type_t<Enum> rawValue(const Enum& stored) {
  std::underlying_type_t<Enum> value{};
  static_assert(sizeof(value) == sizeof(stored));
  std::memcpy(&value, &stored, sizeof(value));
  return value;
}

GnssFix::Quality qualityOf(unsigned nmea) {
  switch (nmea) {
    case 1:
    case 3:  // PPS
    case 8:  // simulator
      return GnssFix::Quality::Autonomous;
    case 2:
      return GnssFix::Quality::Differential;
    case 4:
      return GnssFix::Quality::RtkFixed;
    case 5:
      return GnssFix::Quality::RtkFloat;
    default:  // 0 none, 6 dead reckoning, 7 typed in by hand: no satellite measurement
      return GnssFix::Quality::None;
  }
}

bool isIdentity(const mrpt::math::CMatrixDouble33& R) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (R(row, column) != (row == column ? 1.0 : 0.0)) return false;
    }
  }
  return true;
}

template <typename Record>
Extra<WheelTicks> ticksIn(const Record& record, std::int64_t largest) {
  const Flag flag = flagOf(record.hasEncodersInfo);
  if (flag == Flag::No) return {};
  const WheelTicks ticks{record.encoderLeftTicks, record.encoderRightTicks};
  const bool absurd = std::abs(ticks.left) > largest || std::abs(ticks.right) > largest;
  if (flag == Flag::Garbage || absurd) return {.value = {}, .garbage = true};
  return {.value = ticks};
}

/// 0 or a plain number of sensible size: uninitialised memory is mostly denormal, huge or no number.
bool credible(double value, double largest) {
  return value == 0.0 || (std::isfinite(value) && std::abs(value) <= largest && std::abs(value) >= 1e-9);
}

template <typename Record>
Extra<WheelSpeeds> speedsIn(const Record& record) {
  constexpr double kFastest = 100.0;  // m/s and rad/s
  const Flag flag = flagOf(record.hasVelocities);
  if (flag == Flag::No) return {};
  const auto& v = record.velocityLocal;
  const bool believable = credible(v.vx, kFastest) && credible(v.vy, kFastest) && credible(v.omega, kFastest);
  if (flag == Flag::Garbage || !believable) return {.value = {}, .garbage = true};
  if (v.vy != 0.0) return {};
  return {.value = WheelSpeeds{v.vx, v.vx, v.omega}};
}

}  // namespace

LabelledTag labelledTag(const std::string& label) {
  const auto mark = label.rfind(kTagMark);
  if (mark == std::string::npos) return {label, 0};
  TagId tag = 0;
  const char* first = label.data() + mark + kTagMark.size();
  const char* last = label.data() + label.size();
  if (std::from_chars(first, last, tag).ptr != last || first == last) return {label, 0};
  return {label.substr(0, mark), tag};
}

std::optional<ImuSample> imuSample(const CObservationIMU& observation) {
  for (const int channel : {IMU_X_ACC, IMU_Y_ACC, IMU_Z_ACC, IMU_WX, IMU_WY, IMU_WZ}) {
    if (flagOf(observation.dataIsPresent[static_cast<std::size_t>(channel)]) != Flag::Yes) return {};
  }
  const auto& raw = observation.rawMeasurements;
  ImuSample sample;
  sample.angular = {raw[IMU_WX], raw[IMU_WY], raw[IMU_WZ]};  // stored z, y, x
  sample.linear = {raw[IMU_X_ACC], raw[IMU_Y_ACC], raw[IMU_Z_ACC]};
  if (!isIdentity(observation.sensorPose.getRotationMatrix())) {
    const Eigen::Quaterniond body_from_sensor = poseFromMrpt(observation.sensorPose).rotation;
    sample.angular = body_from_sensor * sample.angular;
    sample.linear = body_from_sensor * sample.linear;
  }
  return sample;
}

std::vector<BeaconRange> beaconRanges(const CObservationBeaconRanges& observation, TagId tag) {
  std::vector<BeaconRange> ranges;
  ranges.reserve(observation.sensedData.size());
  for (const auto& stored : observation.sensedData) {
    BeaconRange range;
    range.tag = tag;
    range.anchor = stored.beaconID;
    range.range = static_cast<double>(stored.sensedDistance);
    if (observation.stdError != 0.0F) range.sigma = static_cast<double>(observation.stdError);
    const auto& place = stored.sensorLocationOnRobot;
    const Eigen::Vector3d tag_body{place.x(), place.y(), place.z()};
    if (!tag_body.isZero(0.0)) range.tag_body = tag_body;
    ranges.push_back(range);
  }
  return ranges;
}

std::optional<std::string> outsideLimits(const CObservationBeaconRanges& observation,
                                         const BeaconRange& range) {
  if (range.anchor == INVALID_BEACON_ID) return "range without an anchor's number";
  const auto highest = static_cast<double>(observation.maxSensorDistance);
  const auto lowest = static_cast<double>(observation.minSensorDistance);
  if (highest > 0.0 && range.range > highest) return "range above the sensor's stated maximum";
  if (range.range > 0.0 && range.range < lowest) return "range below the sensor's stated minimum";
  return {};
}

std::optional<GnssFix> gnssFix(const CObservationGPS& observation) {
  if (!observation.hasMsgClass<gnss::Message_NMEA_GGA>()) return {};
  const auto gga = observation.getMsgByClass<gnss::Message_NMEA_GGA>().fields;
  GnssFix fix;
  fix.latitude = gga.latitude_degrees * kRadPerDegree;
  fix.longitude = gga.longitude_degrees * kRadPerDegree;
  fix.altitude = gga.altitude_meters + gga.geoidal_distance;  // mean sea level to ellipsoid
  fix.quality = qualityOf(gga.fix_quality);
  const auto hdop = static_cast<double>(gga.HDOP);
  const bool stated = flagOf(gga.thereis_HDOP) == Flag::Yes && hdop > 0.0 && std::isfinite(hdop);
  fix.covariance_enu = defaultCovariance(fix.quality, stated ? hdop : 1.0);
  return fix;
}

std::optional<Scan2D> scan2D(const CObservation2DRangeScan& observation) {
  if (observation.deltaPitch != 0.0) return {};
  Scan2D scan;
  const std::size_t beams = observation.getScanSize();
  const auto aperture = static_cast<double>(observation.aperture);
  const double sense = flagOf(observation.rightToLeft) == Flag::No ? -1.0 : 1.0;
  scan.T_body_sensor = poseFromMrpt(observation.sensorPose);
  scan.angle_first = -0.5 * sense * aperture;
  scan.angle_step = beams > 1 ? sense * aperture / static_cast<double>(beams - 1) : 0.0;
  scan.range_max = static_cast<double>(observation.maxRange);
  scan.ranges.reserve(beams);
  scan.valid.reserve(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const float range = observation.getScanRange(i);
    const bool plausible = std::isfinite(range) && range > 0.0F && range <= observation.maxRange;
    scan.ranges.push_back(range);
    scan.valid.push_back(observation.getScanRangeValidity(i) && plausible ? 1 : 0);
  }
  return scan;
}

PoseTruth poseTruth(const CObservationRobotPose& observation) {
  return {poseFromMrpt(observation.pose.mean)};
}

std::optional<PassageFix> passageFix(const CObservationRobotPose& observation, const Companion& companion) {
  const auto place = companion.word("place");
  if (!place) return {};
  PassageFix fix;
  fix.place = *place;
  fix.p_map = poseFromMrpt(observation.pose.mean).translation;
  fix.covariance = levelCovariance(observation.pose).position;
  fix.p_body = poseFromMrpt(observation.sensorPose).translation;
  fix.yaw = companion.number("yaw");
  fix.yaw_sigma = companion.number("yaw_sigma");
  return fix;
}

bool isScanMatching(const CActionRobotMovement2D& action) {
  return rawValue(action.estimationMethod) != CActionRobotMovement2D::emOdometry;
}

OdometryIncrement odometryIncrement(const CActionRobotMovement2D& action) {
  OdometryIncrement reading;
  const auto* gaussian = dynamic_cast<const mrpt::poses::CPosePDFGaussian*>(action.poseChange.get());
  if (isScanMatching(action) && action.poseChange.get() != nullptr) {
    reading.increment = poseFromMrpt(action.poseChange->getMeanVal());
  } else {
    reading.increment = poseFromMrpt(action.rawOdometryIncrementReading);
  }
  if (gaussian != nullptr) {
    Matrix<3, 3> P;  // P = covariance of [x y yaw]
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) P(row, column) = gaussian->cov(row, column);
    }
    reading.covariance = P;
  }
  return reading;
}

Extra<WheelTicks> ticksOf(const CObservationOdometry& observation) {
  return ticksIn(observation, std::numeric_limits<std::int32_t>::max());
}

Extra<WheelTicks> ticksOf(const CActionRobotMovement2D& action) {
  return ticksIn(action, 1'000'000);
}

Extra<WheelSpeeds> speedsOf(const CObservationOdometry& observation) {
  return speedsIn(observation);
}

Extra<WheelSpeeds> speedsOf(const CActionRobotMovement2D& action) {
  return speedsIn(action);
}

}  // namespace pos::io
