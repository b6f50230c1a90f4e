// The keys of JSON lines.
#include "json_line_readings.hpp"
#include "pos/core/error.hpp"

namespace pos::io::json_lines {
namespace {

using Quality = GnssFix::Quality;

OptionTable<OdometryLine> odometryOptions() {
  return OptionTable<OdometryLine>("odometry",
                                   "Motion since the sensor's previous line, in the previous body frame.")
      .number("x_m", &OdometryLine::x, anything(), "Forward.")
      .required()
      .number("y_m", &OdometryLine::y, anything(), "To the left.")
      .number("yaw_deg", &OdometryLine::yaw, anything(), "Turn to the left.")
      .number("interval_s", &OdometryLine::interval, atLeast(0), "Time the motion took.")
      .numbers("covariance", &OdometryLine::covariance, anything(),
               "9 numbers, row by row, of x, y (m) and yaw (rad).");
}

OptionTable<SpeedsLine> speedsOptions() {
  return OptionTable<SpeedsLine>("wheel_speeds", "Speed of wheels over ground.")
      .number("left_m_per_s", &SpeedsLine::left, anything(), "Left side.")
      .required()
      .number("right_m_per_s", &SpeedsLine::right, anything(), "Right side.")
      .required()
      .number("yaw_rate_deg_per_s", &SpeedsLine::yaw_rate, anything(), "Of a gyro, where there is one.");
}

OptionTable<TicksLine> ticksOptions() {
  return OptionTable<TicksLine>("wheel_ticks", "Encoder counters since they were switched on.")
      .integer("left", &TicksLine::left, anything(), "Left side.")
      .required()
      .integer("right", &TicksLine::right, anything(), "Right side.")
      .required();
}

OptionTable<ImuLine> imuOptions() {
  return OptionTable<ImuLine>("imu",
                              "An inertial sample in body axes: rates, or increments with their interval.")
      .numbers("rates_deg_per_s", &ImuLine::rates, anything(), "Angular rates about x, y, z.")
      .numbers("force_m_per_s2", &ImuLine::force, anything(), "Specific force; at rest it points up.")
      .numbers("turn_deg", &ImuLine::angles, anything(), "Turn over the interval.")
      .numbers("velocity_m_per_s", &ImuLine::velocity, anything(), "Velocity gained over the interval.")
      .number("interval_s", &ImuLine::interval, moreThan(0), "Interval of the sample.");
}

OptionTable<BeaconRange> rangeOptions() {
  return OptionTable<BeaconRange>("range", "A range between a tag on the vehicle and an anchor.")
      .integer("anchor", &BeaconRange::anchor, anything(), "Number of the anchor.")
      .required()
      .integer("tag", &BeaconRange::tag, anything(), "Number of the tag.")
      .number("range_m", &BeaconRange::range, moreThan(0), "The range.")
      .required()
      .number("sigma_m", &BeaconRange::sigma, moreThan(0), "Standard deviation that the radio claims.")
      .numbers("tag_body_m", &BeaconRange::tag_body, anything(),
               "Place of the tag on the vehicle: forward, left, up.")
      .number("rx_power_dbm", &BeaconRange::rx_power_dbm, anything(), "Power received.")
      .number("first_path_power_dbm", &BeaconRange::first_path_power_dbm, anything(), "Of the first path.");
}

OptionTable<GnssLine> gnssOptions() {
  return OptionTable<GnssLine>("gnss", "A satellite fix, WGS84.")
      .number("latitude_deg", &GnssLine::latitude, between(-90, 90), "North.")
      .required()
      .number("longitude_deg", &GnssLine::longitude, between(-360, 360), "East.")
      .required()
      .number("altitude_m", &GnssLine::altitude, anything(), "Above the ellipsoid.")
      .required()
      .numbers("covariance", &GnssLine::covariance, anything(),
               "9 numbers in m^2, row by row, of east, north, up.")
      .required()
      .choice("quality", &GnssLine::quality,
              {{"none", Quality::None},
               {"autonomous", Quality::Autonomous},
               {"differential", Quality::Differential},
               {"rtk_float", Quality::RtkFloat},
               {"rtk_fixed", Quality::RtkFixed}},
              "Kind of the solution.");
}

OptionTable<ScanLine> scanOptions() {
  return OptionTable<ScanLine>("scan", "One sweep of a planar laser scanner.")
      .numbers("sensor_m", &ScanLine::position, anything(), "Place of the scanner on the vehicle.")
      .numbers("sensor_angles_deg", &ScanLine::angles, anything(), "Its yaw, pitch and roll.")
      .number("angle_first_deg", &ScanLine::first, anything(), "Direction of the first beam.")
      .required()
      .number("angle_step_deg", &ScanLine::step, anything(), "From beam to beam, positive to the left.")
      .required()
      .number("range_max_m", &ScanLine::range_max, moreThan(0), "Reach of the scanner.")
      .required()
      .numbers("ranges_m", &ScanLine::ranges, atLeast(0), "One for each beam, 0 where nothing came back.")
      .required();
}

OptionTable<TruthLine> truthOptions() {
  return OptionTable<TruthLine>("truth", "A reference pose; recorded, never given to an estimator.")
      .numbers("position_m", &TruthLine::position, anything(), "Map coordinates.")
      .required()
      .numbers("angles_deg", &TruthLine::angles, anything(), "Yaw, pitch and roll.");
}

OptionTable<PassageLine> passageOptions() {
  return OptionTable<PassageLine>("passage", "The vehicle passed, or sits in, a known place.")
      .text("place", &PassageLine::place, "Id of the chamber, portal or reader.")
      .required()
      .numbers("position_m", &PassageLine::position, anything(), "Map coordinates.")
      .required()
      .numbers("covariance", &PassageLine::covariance, anything(), "9 numbers in m^2, row by row.")
      .required()
      .numbers("sensor_m", &PassageLine::sensor, anything(), "Place on the vehicle that the position is of.")
      .number("yaw_deg", &PassageLine::yaw, anything(), "Heading, where it is known.")
      .number("yaw_sigma_deg", &PassageLine::yaw_sigma, moreThan(0), "Its standard deviation.");
}

}  // namespace

OptionTable<Line> lineOptions() {
  return OptionTable<Line>("line", "One measurement; stamp_s comes with it.")
      .text("sensor", &Line::sensor, "Label of the sensor.")
      .required()
      .selector("reading", "What was measured.")
      .alternative("odometry", &Line::reading, odometryOptions(), "")
      .alternative("wheel_speeds", &Line::reading, speedsOptions(), "")
      .alternative("wheel_ticks", &Line::reading, ticksOptions(), "")
      .alternative("imu", &Line::reading, imuOptions(), "")
      .alternative("range", &Line::reading, rangeOptions(), "")
      .alternative("gnss", &Line::reading, gnssOptions(), "")
      .alternative("scan", &Line::reading, scanOptions(), "")
      .alternative("truth", &Line::reading, truthOptions(), "")
      .alternative("passage", &Line::reading, passageOptions(), "");
}

}  // namespace pos::io::json_lines
