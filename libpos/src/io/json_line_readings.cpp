#include "json_line_readings.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/error.hpp"

namespace pos::io::json_lines {
namespace {

using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Matrix<3, 3> matrixOf(const Numbers& numbers) {
  if (numbers.size() == 9) return Eigen::Map<const Rows>(numbers.data());
  throw ConfigError(Complaint{.what = "a covariance has 9 numbers, row by row",
                              .key = "covariance",
                              .got = std::to_string(numbers.size()) + " numbers"});
}
Numbers numbersOf(const Matrix<3, 3>& matrix) {
  const Rows rows = matrix;
  return {rows.data(), rows.data() + rows.size()};
}

std::optional<Duration> durationOf(const std::optional<double>& interval) {
  if (!interval) return std::nullopt;
  if (*interval < 4.6e9) return durationFromSeconds(*interval);
  throw ConfigError(Complaint{.what = "the interval is too long", .key = "interval_s"});
}
std::optional<double> secondsOf(const std::optional<Duration>& interval) {
  return interval ? std::optional(seconds(*interval)) : std::nullopt;
}

Pose3 poseOf(const Eigen::Vector3d& position, const Eigen::Vector3d& angles) {
  return Pose3::fromXyzYawPitchRoll(position.x(), position.y(), position.z(), angles.x(), angles.y(),
                                    angles.z());
}
Eigen::Vector3d anglesOf(const Pose3& pose) {
  const Eigen::Matrix3d R = pose.rotation.toRotationMatrix();
  return {std::atan2(R(1, 0), R(0, 0)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
          std::atan2(R(2, 1), R(2, 2))};
}

struct ToReading {
  Reading operator()(const OdometryLine& line) const {
    OdometryIncrement reading{.increment = {line.x, line.y, line.yaw}, .interval = durationOf(line.interval)};
    if (line.covariance) reading.covariance = matrixOf(*line.covariance);
    return reading;
  }
  Reading operator()(const SpeedsLine& line) const {
    return WheelSpeeds{line.left, line.right, line.yaw_rate};
  }
  Reading operator()(const TicksLine& line) const { return WheelTicks{line.left, line.right}; }
  Reading operator()(const ImuLine& line) const {
    if (line.rates && line.force && !line.angles && !line.velocity) {
      return ImuSample{ImuSample::Kind::Rates, *line.rates, *line.force, durationOf(line.interval)};
    }
    if (line.angles && line.velocity && !line.rates && !line.force) {
      return ImuSample{ImuSample::Kind::Increments, *line.angles, *line.velocity, durationOf(line.interval)};
    }
    throw ConfigError(
        Complaint{.what = "an inertial sample is either rates or increments",
                  .key = "imu",
                  .expected = "rates_deg_per_s and force_m_per_s2, or turn_deg and velocity_m_per_s"});
  }
  Reading operator()(const BeaconRange& line) const { return line; }
  Reading operator()(const GnssLine& line) const {
    return GnssFix{line.latitude, line.longitude, line.altitude, matrixOf(line.covariance), line.quality};
  }
  Reading operator()(const ScanLine& line) const {
    Scan2D scan{.T_body_sensor = poseOf(line.position, line.angles),
                .angle_first = line.first,
                .angle_step = line.step,
                .range_max = line.range_max};
    for (const double range : line.ranges) {
      scan.ranges.push_back(static_cast<float>(range));
      scan.valid.push_back(range > 0.0 && range <= line.range_max ? 1 : 0);
    }
    return scan;
  }
  Reading operator()(const TruthLine& line) const { return PoseTruth{poseOf(line.position, line.angles)}; }
  Reading operator()(const PassageLine& line) const {
    return PassageFix{line.place,  line.position, matrixOf(line.covariance),
                      line.sensor, line.yaw,      line.yaw_sigma};
  }
};

using Held = decltype(Line::reading);

struct ToLine {
  Held operator()(const OdometryIncrement& r) const {
    return OdometryLine{r.increment.x, r.increment.y, r.increment.yaw, secondsOf(r.interval),
                        r.covariance ? std::optional(numbersOf(*r.covariance)) : std::nullopt};
  }
  Held operator()(const WheelSpeeds& r) const { return SpeedsLine{r.left, r.right, r.yaw_rate}; }
  Held operator()(const WheelTicks& r) const { return TicksLine{r.left, r.right}; }
  Held operator()(const ImuSample& r) const {
    ImuLine line{.interval = secondsOf(r.interval)};
    const bool rates = r.kind == ImuSample::Kind::Rates;
    (rates ? line.rates : line.angles) = r.angular;
    (rates ? line.force : line.velocity) = r.linear;
    return line;
  }
  Held operator()(const BeaconRange& r) const { return r; }
  Held operator()(const GnssFix& r) const {
    return GnssLine{r.latitude, r.longitude, r.altitude, numbersOf(r.covariance_enu), r.quality};
  }
  Held operator()(const Scan2D& r) const {
    ScanLine line{.position = r.T_body_sensor.translation,
                  .angles = anglesOf(r.T_body_sensor),
                  .first = r.angle_first,
                  .step = r.angle_step,
                  .range_max = r.range_max};
    for (std::size_t i = 0; i < r.ranges.size(); ++i)
      line.ranges.push_back(r.valid[i] != 0 ? static_cast<double>(r.ranges[i]) : 0.0);
    return line;
  }
  Held operator()(const PoseTruth& r) const {
    return TruthLine{r.T_map_body.translation, anglesOf(r.T_map_body)};
  }
  Held operator()(const PassageFix& r) const {
    return PassageLine{r.place, r.p_map, numbersOf(r.covariance), r.p_body, r.yaw, r.yaw_sigma};
  }
};

}  // namespace

Measurement measurementOf(Stamp stamp, const Line& line) {
  return {stamp, line.sensor, std::visit(ToReading{}, line.reading)};
}

Line lineOf(const Measurement& measurement) {
  const std::string sensor(measurement.sensor.empty() ? readingName(measurement.reading)
                                                      : measurement.sensor);
  return {sensor, std::visit(ToLine{}, measurement.reading)};
}

}  // namespace pos::io::json_lines
