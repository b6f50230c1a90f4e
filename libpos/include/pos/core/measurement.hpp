#pragma once
/// What a sensor said. Recorded, simulated and live data look the same from here on.
///
/// Units are SI (m, s, rad). Body frame is FLU (x forward, y left, z up), map frame is ENU.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pos/core/pose2.hpp"
#include "pos/core/pose3.hpp"
#include "pos/core/stamp.hpp"

namespace pos {

/// The radio's own number of a fixed anchor (MRPT: beacon ID).
using AnchorId = std::int32_t;
/// The radio's own number of a tag on the vehicle.
using TagId = std::int32_t;

/// Motion of the body since the previous increment of the same sensor, T_previous_now.
struct OdometryIncrement {
  Pose2 increment = {};
  /// Time the motion took; absent when the log does not say (then: since the previous increment).
  std::optional<Duration> interval = {};
  /// Covariance of the increment's tangent [x, y, yaw] in the previous body frame, where the log gives one.
  std::optional<Matrix<3, 3>> covariance = {};
};

/// Speed of wheels over ground (m/s), or of a body whose yaw rate a gyro gives (rad/s).
struct WheelSpeeds {
  double left = 0.0;
  double right = 0.0;
  std::optional<double> yaw_rate = {};
};

/// Cumulative encoder counters; they wrap at the counter's width, which the vehicle's configuration gives.
struct WheelTicks {
  std::int64_t left = 0;
  std::int64_t right = 0;
};

/// One inertial sample in body axes.
struct ImuSample {
  enum class Kind { Rates, Increments };
  Kind kind = Kind::Rates;
  /// rad/s (Rates) or rad over the interval (Increments).
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
  /// Specific force, m/s^2 (Rates) or m/s over the interval (Increments). At rest it points up.
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  std::optional<Duration> interval = {};
};

/// One radio range between a tag on the vehicle and an anchor of the map.
struct BeaconRange {
  TagId tag = 0;
  AnchorId anchor = 0;
  double range = 0.0;  ///< m
  /// Standard deviation the log claims, m. Estimators use their own model unless told to trust it.
  std::optional<double> sigma = {};
  /// Where the tag sits on the body (m, FLU), where the log says so.
  std::optional<Eigen::Vector3d> tag_body = {};
  std::optional<double> rx_power_dbm = {};
  std::optional<double> first_path_power_dbm = {};
};

/// A satellite position fix.
struct GnssFix {
  double latitude = 0.0;                               ///< rad, WGS84
  double longitude = 0.0;                              ///< rad, WGS84
  double altitude = 0.0;                               ///< m above the ellipsoid
  Matrix<3, 3> covariance_enu = Matrix<3, 3>::Zero();  ///< m^2, east north up
  enum class Quality { None, Autonomous, Differential, RtkFloat, RtkFixed } quality = Quality::Autonomous;
};

/// One sweep of a planar laser scanner. Beam i looks along `angle_first + i * angle_step` in the sensor
/// frame.
struct Scan2D {
  Pose3 T_body_sensor = {};
  double angle_first = 0.0;              ///< rad
  double angle_step = 0.0;               ///< rad, signed
  double range_max = 0.0;                ///< m
  std::vector<float> ranges = {};        ///< m
  std::vector<std::uint8_t> valid = {};  ///< 1 where the beam came back
};

/// Reference pose recorded with the log. Never given to an estimator; the evaluation reads it.
struct PoseTruth {
  Pose3 T_map_body = {};
};

/// The vehicle passed, or sits in, a known place: a refuge chamber, a portal reader, a dual-UWB pose. The
/// point `p_body` of the vehicle was at `p_map`.
struct PassageFix {
  std::string place = {};
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();   ///< m
  Matrix<3, 3> covariance = Matrix<3, 3>::Zero();    ///< m^2, map axes
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< m, FLU: the reader's antenna; 0 is the body's origin
  std::optional<double> yaw = {};                    ///< rad
  std::optional<double> yaw_sigma = {};              ///< rad
};

using Reading = std::variant<OdometryIncrement, WheelSpeeds, WheelTicks, ImuSample, BeaconRange, GnssFix,
                             Scan2D, PoseTruth, PassageFix>;

/// One reading with its stamp (moment of measurement) and the label of the sensor that gave it.
struct Measurement {
  Stamp stamp = {};
  std::string sensor = {};
  Reading reading = {};
};

/// The kind's name in configs, tables and messages: "odometry", "range", "scan", ...
std::string_view readingName(const Reading& reading);
/// All those names, in the variant's order.
const std::vector<std::string_view>& readingNames();

/// What is wrong with the reading (NaN, negative range, mismatched sizes, a covariance that is none), or
/// nothing. Refused at io and again at ingest.
std::optional<std::string> defect(const Measurement& measurement);

}  // namespace pos
