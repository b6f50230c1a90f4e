/// What companion lines add to readings.
#include "mrpt_conversion.hpp"

namespace pos::io {
namespace {

Matrix<3, 3> matrixFrom(const std::vector<double>& rows) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

Eigen::Vector3d vectorFrom(const std::vector<double>& values) {
  return {values[0], values[1], values[2]};
}

std::optional<Duration> durationFrom(const Companion& companion) {
  const auto count = companion.integer("interval_ns");
  return count ? std::optional(Duration{*count}) : std::nullopt;
}

}  // namespace

OdometryIncrement completed(OdometryIncrement reading, const Companion& companion) {
  reading.interval = durationFrom(companion);
  if (const auto rows = companion.numbers("covariance", 9)) reading.covariance = matrixFrom(*rows);
  return reading;
}

ImuSample completed(ImuSample reading, const Companion& companion) {
  reading.interval = durationFrom(companion);
  const auto angle = companion.numbers("angle_increment", 3);
  const auto velocity = companion.numbers("velocity_increment", 3);
  if (angle && velocity) {
    reading.kind = ImuSample::Kind::Increments;
    reading.angular = vectorFrom(*angle);
    reading.linear = vectorFrom(*velocity);
  }
  return reading;
}

BeaconRange completed(BeaconRange reading, const Companion& companion) {
  reading.rx_power_dbm = companion.number("rx_power_dbm");
  reading.first_path_power_dbm = companion.number("first_path_power_dbm");
  if (const auto place = companion.numbers("tag_body", 3)) reading.tag_body = vectorFrom(*place);
  return reading;
}

GnssFix completed(GnssFix reading, const Companion& companion) {
  if (const auto rows = companion.numbers("covariance_enu", 9)) reading.covariance_enu = matrixFrom(*rows);
  return reading;
}

Scan2D completed(Scan2D reading, const Companion& companion) {
  const double middle = companion.number("middle_angle").value_or(0.0);
  reading.T_body_sensor =
      reading.T_body_sensor * Pose3::fromXyzYawPitchRoll(0.0, 0.0, 0.0, -middle, 0.0, 0.0);
  reading.angle_first += middle;
  return reading;
}

std::optional<WheelTicks> wheelTicks(const Companion& companion) {
  const auto left = companion.integer("left");
  const auto right = companion.integer("right");
  if (!left || !right) return {};
  return WheelTicks{*left, *right};
}

std::optional<WheelSpeeds> wheelSpeeds(const Companion& companion) {
  const auto left = companion.number("left");
  const auto right = companion.number("right");
  if (!left || !right) return {};
  return WheelSpeeds{*left, *right, companion.number("yaw_rate")};
}

}  // namespace pos::io
