/// Readings to MRPT observations.
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBeaconRanges.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <cmath>
#include <limits>

#include "mrpt_conversion.hpp"
#include "mrpt_values.hpp"
#include "pos/core/error.hpp"

namespace pos::io {
namespace {

using namespace mrpt::obs;

constexpr double kDegreesPerRad = 180.0 / kPi;

std::vector<double> rowsOf(const Matrix<3, 3>& P) {
  std::vector<double> rows;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rows.push_back(P(row, column));
  }
  return rows;
}

std::vector<double> valuesOf(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

std::optional<Companion> unlessEmpty(Companion companion) {
  if (companion.empty()) return {};
  return companion;
}

std::uint8_t nmeaQuality(GnssFix::Quality quality) {
  constexpr std::array<std::uint8_t, 5> kNmea{0, 1, 2, 5, 4};  // in the enum's order
  return kNmea[static_cast<std::size_t>(quality)];
}

struct StoreReading {
  Stored operator()(const ImuSample& reading) const {
    auto observation = std::make_shared<CObservationIMU>();
    Companion extra("imu");
    Eigen::Vector3d rate = reading.angular;
    Eigen::Vector3d force = reading.linear;
    if (reading.interval) extra.putInteger("interval_ns", reading.interval->count());
    if (reading.kind == ImuSample::Kind::Increments) {
      extra.put("angle_increment", valuesOf(reading.angular));
      extra.put("velocity_increment", valuesOf(reading.linear));
      const double dt = reading.interval ? seconds(*reading.interval) : 0.0;
      rate = dt > 0.0 ? Eigen::Vector3d(rate / dt) : Eigen::Vector3d::Zero();
      force = dt > 0.0 ? Eigen::Vector3d(force / dt) : Eigen::Vector3d::Zero();
    }
    observation->set(IMU_WX, rate.x());
    observation->set(IMU_WY, rate.y());
    observation->set(IMU_WZ, rate.z());
    observation->set(IMU_X_ACC, force.x());
    observation->set(IMU_Y_ACC, force.y());
    observation->set(IMU_Z_ACC, force.z());
    return {observation, unlessEmpty(extra)};
  }

  Stored operator()(const BeaconRange& reading) const {
    auto observation = std::make_shared<CObservationBeaconRanges>();
    Companion extra("range");
    observation->minSensorDistance = 0.0F;
    observation->maxSensorDistance = std::numeric_limits<float>::max();
    observation->stdError = static_cast<float>(reading.sigma.value_or(0.0));
    CObservationBeaconRanges::TMeasurement measured;
    measured.beaconID = reading.anchor;
    measured.sensedDistance = static_cast<float>(reading.range);
    if (reading.tag_body) {
      const auto& place = *reading.tag_body;
      measured.sensorLocationOnRobot = {place.x(), place.y(), place.z()};
      if (place.isZero(0.0)) extra.put("tag_body", valuesOf(place));
    }
    observation->sensedData.push_back(measured);
    if (reading.rx_power_dbm) extra.put("rx_power_dbm", *reading.rx_power_dbm);
    if (reading.first_path_power_dbm) extra.put("first_path_power_dbm", *reading.first_path_power_dbm);
    return {observation, unlessEmpty(extra)};
  }

  Stored operator()(const GnssFix& reading) const {
    auto observation = std::make_shared<CObservationGPS>();
    gnss::Message_NMEA_GGA gga;
    gga.fields.latitude_degrees = reading.latitude * kDegreesPerRad;
    gga.fields.longitude_degrees = reading.longitude * kDegreesPerRad;
    gga.fields.altitude_meters = reading.altitude;
    gga.fields.fix_quality = nmeaQuality(reading.quality);
    observation->setMsg(gga);
    observation->has_satellite_timestamp = true;
    Companion extra("gnss");
    extra.put("covariance_enu", rowsOf(reading.covariance_enu));
    return {observation, extra};
  }

  Stored operator()(const Scan2D& reading) const {
    auto observation = std::make_shared<CObservation2DRangeScan>();
    const std::size_t beams = reading.ranges.size();
    const double span = reading.angle_step * static_cast<double>(beams - 1);
    const double middle = reading.angle_first + 0.5 * span;
    Companion extra("scan");
    Pose3 T_body_sensor = reading.T_body_sensor;
    if (std::abs(middle) > 1e-6) {
      // MRPT's scans are symmetric about the sensor's x axis: turn the sensor instead.
      extra.put("middle_angle", middle);
      T_body_sensor = T_body_sensor * Pose3::fromXyzYawPitchRoll(0.0, 0.0, 0.0, middle, 0.0, 0.0);
    }
    observation->sensorPose = poseToMrpt(T_body_sensor);
    observation->aperture = static_cast<float>(std::abs(span));
    observation->rightToLeft = reading.angle_step >= 0.0;
    observation->maxRange = static_cast<float>(reading.range_max);
    observation->resizeScan(beams);
    for (std::size_t i = 0; i < beams; ++i) {
      observation->setScanRange(i, reading.ranges[i]);
      observation->setScanRangeValidity(i, reading.valid[i] != 0);
    }
    return {observation, unlessEmpty(extra)};
  }

  Stored operator()(const PoseTruth& reading) const {
    auto observation = std::make_shared<CObservationRobotPose>();
    observation->pose = gaussianToMrpt(reading.T_map_body, {});
    return {observation, {}};
  }

  Stored operator()(const PassageFix& reading) const {
    auto observation = std::make_shared<CObservationRobotPose>();
    const Pose3 mean = Pose3::fromXyzYawPitchRoll(reading.p_map.x(), reading.p_map.y(), reading.p_map.z(),
                                                  reading.yaw.value_or(0.0), 0.0, 0.0);
    const double yaw_sigma = reading.yaw_sigma.value_or(reading.yaw ? 0.0 : kPi);
    observation->pose = gaussianToMrpt(mean, {reading.covariance, yaw_sigma * yaw_sigma});
    observation->sensorPose.setFromValues(reading.p_body.x(), reading.p_body.y(), reading.p_body.z());
    Companion extra("passage");
    extra.putWord("place", reading.place);
    if (reading.yaw) extra.put("yaw", *reading.yaw);
    if (reading.yaw_sigma) extra.put("yaw_sigma", *reading.yaw_sigma);
    return {observation, extra};
  }

  template <typename Wheels>
  Stored operator()(const Wheels&) const {
    throw ContractError("odometry and wheel readings are stored with their sensor's accumulated pose");
  }
};

}  // namespace

std::string labelWithTag(const std::string& sensor, TagId tag) {
  const LabelledTag own = labelledTag(sensor);
  if (tag == 0 && own.sensor == sensor) return sensor;
  return sensor + ";tag=" + std::to_string(tag);
}

Stored stored(const Measurement& measurement) {
  Stored result = std::visit(StoreReading{}, measurement.reading);
  const auto* range = std::get_if<BeaconRange>(&measurement.reading);
  result.carrier->sensorLabel =
      range != nullptr ? labelWithTag(measurement.sensor, range->tag) : measurement.sensor;
  result.carrier->timestamp = stampToMrpt(measurement.stamp);
  return result;
}

mrpt::obs::CObservation::Ptr absoluteOdometry(const Pose2& total) {
  auto observation = std::make_shared<CObservationOdometry>();
  observation->odometry = poseToMrpt(total);
  return observation;
}

Stored stored(const WheelTicks& reading, const Pose2& total) {
  auto observation = std::make_shared<CObservationOdometry>();
  observation->odometry = poseToMrpt(total);
  observation->hasEncodersInfo = true;
  observation->encoderLeftTicks = static_cast<std::int32_t>(reading.left);
  observation->encoderRightTicks = static_cast<std::int32_t>(reading.right);
  Companion extra("wheel_ticks");
  extra.putInteger("left", reading.left);
  extra.putInteger("right", reading.right);
  return {observation, extra};
}

Stored stored(const WheelSpeeds& reading, const Pose2& total) {
  auto observation = std::make_shared<CObservationOdometry>();
  observation->odometry = poseToMrpt(total);
  observation->hasVelocities = true;
  observation->velocityLocal = {0.5 * (reading.left + reading.right), 0.0, reading.yaw_rate.value_or(0.0)};
  Companion extra("wheel_speeds");
  extra.put("left", reading.left);
  extra.put("right", reading.right);
  if (reading.yaw_rate) extra.put("yaw_rate", *reading.yaw_rate);
  return {observation, extra};
}

}  // namespace pos::io
