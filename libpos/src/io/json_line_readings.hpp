#pragma once
/// How readings are spelt in JSON lines. Private to io.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pos/core/measurement.hpp"
#include "pos/io/options.hpp"

namespace pos::io::json_lines {

using Numbers = std::vector<double>;

struct OdometryLine {
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;
  std::optional<double> interval = {};
  std::optional<Numbers> covariance = {};
};
struct SpeedsLine {
  double left = 0.0;
  double right = 0.0;
  std::optional<double> yaw_rate = {};
};
struct TicksLine {
  std::int64_t left = 0;
  std::int64_t right = 0;
};
struct ImuLine {
  std::optional<Eigen::Vector3d> rates = {};
  std::optional<Eigen::Vector3d> force = {};
  std::optional<Eigen::Vector3d> angles = {};
  std::optional<Eigen::Vector3d> velocity = {};
  std::optional<double> interval = {};
};
struct GnssLine {
  double latitude = 0.0;
  double longitude = 0.0;
  double altitude = 0.0;
  Numbers covariance = {};
  GnssFix::Quality quality = GnssFix::Quality::Autonomous;
};
struct ScanLine {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();  // yaw, pitch, roll
  double first = 0.0;
  double step = 0.0;
  double range_max = 0.0;
  Numbers ranges = {};
};
struct TruthLine {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();  // yaw, pitch, roll
};
struct PassageLine {
  std::string place = {};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Numbers covariance = {};
  Eigen::Vector3d sensor = Eigen::Vector3d::Zero();
  std::optional<double> yaw = {};
  std::optional<double> yaw_sigma = {};
};

/// All keys of a line but the stamp.
struct Line {
  std::string sensor = {};
  std::variant<OdometryLine, SpeedsLine, TicksLine, ImuLine, BeaconRange, GnssLine, ScanLine, TruthLine,
               PassageLine>
      reading = {};
};

OptionTable<Line> lineOptions();

/// Throws ConfigError for keys that do not go together.
Measurement measurementOf(Stamp stamp, const Line& line);
Line lineOf(const Measurement& measurement);

}  // namespace pos::io::json_lines
