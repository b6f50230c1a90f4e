/// Option tables of laser scanners.
#include <algorithm>
#include <cmath>

#include "scenario_options.hpp"

namespace pos::io {
namespace detail {

/// Yaw, pitch and roll (z-y-x), rad.
template <>
struct NumberList<Eigen::Quaterniond> {
  static constexpr std::size_t kCount = 3;
  static Eigen::Quaterniond of(const std::vector<double>& values) {
    return Pose3::fromXyzYawPitchRoll(0, 0, 0, values[0], values[1], values[2]).rotation;
  }
  static std::vector<double> values(const Eigen::Quaterniond& q) {
    const Eigen::Matrix3d R = q.toRotationMatrix();
    return {std::atan2(R(1, 0), R(0, 0)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
            std::atan2(R(2, 1), R(2, 2))};
  }
};

}  // namespace detail

namespace {

using namespace pos::sim;

OptionTable<Dust> dustOptions() {
  return OptionTable<Dust>("dust", "Dust in the air for a while.")
      .table("time", &Dust::when, spanOptions("time", "When."), "When.")
      .required()
      .number("drop_probability", &Dust::drop_probability, between(0, 1), "Of a beam, then.");
}

OptionTable<LidarErrors> lidarErrorOptions() {
  return OptionTable<LidarErrors>("errors", "Systematic errors; angles in degrees as in the paper.")
      .number("a1", &LidarErrors::a1, anything(), "True angle = a1 m^2 + a2 m + a3 of a measured m, in deg.")
      .number("a2", &LidarErrors::a2, anything(), "The same.")
      .number("a3", &LidarErrors::a3, anything(), "The same.")
      .number("scale", &LidarErrors::scale, between(-0.5, 0.5), "Measured range = (1 + scale) true + offset.")
      .number("offset_m", &LidarErrors::offset, between(-10, 10), "The same.");
}

/// The keys of a scanner that `member` gives.
template <class T, class Member>
void addScanner(OptionTable<T>& table, Member member) {
  addPlace(
      table, [member](auto& s) -> auto& { return std::invoke(member, s).T_body_sensor.translation; },
      "Where it sits,");
  table
      .numbers(
          "yaw_pitch_roll_deg",
          [member](auto& s) -> auto& { return std::invoke(member, s).T_body_sensor.rotation; },
          between(-360, 360), "How it is turned against the body.")
      .number(
          "angle_first_deg", [member](auto& s) -> auto& { return std::invoke(member, s).angle_first; },
          between(-360, 360), "Of the first beam.")
      .number(
          "angle_step_deg", [member](auto& s) -> auto& { return std::invoke(member, s).angle_step; },
          between(-90, 90), "From beam to beam.")
      .integer(
          "beams", [member](auto& s) -> auto& { return std::invoke(member, s).beams; }, between(1, 100000),
          "In a sweep.")
      .number(
          "range_min_m", [member](auto& s) -> auto& { return std::invoke(member, s).range_min; }, atLeast(0),
          "Nearest that is seen.")
      .number(
          "range_max_m", [member](auto& s) -> auto& { return std::invoke(member, s).range_max; }, moreThan(0),
          "Farthest that is seen.")
      .number(
          "sigma_range_m", [member](auto& s) -> auto& { return std::invoke(member, s).sigma_range; },
          between(0, 10), "Noise of a range.")
      .number(
          "sigma_angle_deg", [member](auto& s) -> auto& { return std::invoke(member, s).sigma_angle; },
          between(0, 90), "Noise of a beam's angle.")
      .number(
          "drop_probability", [member](auto& s) -> auto& { return std::invoke(member, s).drop_probability; },
          between(0, 1), "Of a beam.")
      .list(
          "dust", [member](auto& s) -> auto& { return std::invoke(member, s).dust; }, dustOptions(),
          "Dust in the air.")
      .table(
          "errors", [member](auto& s) -> auto& { return std::invoke(member, s).errors; }, lidarErrorOptions(),
          "Systematic errors.");
}

OptionTable<SupportRow> rowOptions() {
  return OptionTable<SupportRow>("row", "The supports along the face.")
      .integer("count", &SupportRow::count, between(1, 100000), "How many.")
      .number("spacing_m", &SupportRow::spacing, moreThan(0), "From one to the next.")
      .number("station_first_m", &SupportRow::station_first, anything(), "Of the first, along the face.")
      .numbers("origin_m", &SupportRow::origin_map, anything(), "x and y of station 0.")
      .numbers("along", &SupportRow::along_map, between(-1, 1), "Unit vector along which stations rise.")
      .number("radius_m", &SupportRow::radius, moreThan(0), "Of a leg.")
      .number("tilt_deg", &SupportRow::tilt, between(-80, 80), "Of a leg off the vertical.")
      .number("tilt_heading_deg", &SupportRow::tilt_heading, between(-360, 360),
              "In which its upper end leans; 0 is east, towards the coal.")
      .number("station_slack_m", &SupportRow::station_slack, atLeast(0),
              "How far a support may stray along the face.");
}

}  // namespace

OptionTable<LidarConfig> lidarOptions() {
  OptionTable<LidarConfig> table("lidar", "A planar laser scanner among the walls of the map's grid.");
  addTiming(table, &LidarConfig::timing);
  addScanner(table, &LidarConfig::scanner);
  return table.integer("rock_from", &LidarConfig::rock_from, between(1, 100),
                       "Occupancy in percent that stops a beam.");
}

OptionTable<SupportLegSensor> supportLegOptions() {
  OptionTable<SupportLegSensor> table("support_legs", "A laser scanner among the legs of the supports.");
  addTiming(
      table, [](auto& s) -> auto& { return s.config.timing; });
  addScanner(
      table, [](auto& s) -> auto& { return s.config.scanner; });
  return table
      .choice(
          "model", [](auto& s) -> auto& { return s.config.model; },
          {{"points", LegModel::Points}, {"legs", LegModel::Legs}},
          "Legs as measured points, one beam each, or whole sweeps over round legs.")
      .numbers(
          "mount_error_deg", [](auto& s) -> auto& { return s.config.mount_error; }, between(-10, 10),
          "The scanner is truly turned by this rotation vector more, in its own axes.")
      .table(
          "row", [](auto& s) -> auto& { return s.config.row; }, rowOptions(), "The supports along the face.")
      .number(
          "reach_m", [](auto& s) -> auto& { return s.config.reach; }, moreThan(0),
          "Along the face; legs farther off are not simulated.")
      .number("lateral_m", &SupportLegSensor::lateral, anything(),
              "Legs stand this far west of the conveyor's line.");
}

}  // namespace pos::io
