// Units and table kinds that a mapping file may name.
#include <array>

#include "pos/core/angle.hpp"
#include "pos/io/import_mapping.hpp"

namespace pos::io {
namespace {

struct Unit {
  Quantity quantity;
  std::string_view name;
  double factor;
};

constexpr double kDegree = kPi / 180.0;
constexpr double kStandardGravity = 9.80665;  // m/s^2, exact by definition

constexpr std::array kUnits{
    Unit{Quantity::Time, "s", 1.0},
    Unit{Quantity::Time, "ms", 1e-3},
    Unit{Quantity::Time, "us", 1e-6},
    Unit{Quantity::Time, "ns", 1e-9},
    Unit{Quantity::Length, "m", 1.0},
    Unit{Quantity::Length, "cm", 1e-2},
    Unit{Quantity::Length, "mm", 1e-3},
    Unit{Quantity::Length, "km", 1e3},
    Unit{Quantity::Angle, "rad", 1.0},
    Unit{Quantity::Angle, "mrad", 1e-3},
    Unit{Quantity::Angle, "deg", kDegree},
    Unit{Quantity::AngularRate, "rad/s", 1.0},
    Unit{Quantity::AngularRate, "mrad/s", 1e-3},
    Unit{Quantity::AngularRate, "deg/s", kDegree},
    Unit{Quantity::AngularRate, "deg/h", kDegree / 3600.0},
    Unit{Quantity::Speed, "m/s", 1.0},
    Unit{Quantity::Speed, "cm/s", 1e-2},
    Unit{Quantity::Speed, "mm/s", 1e-3},
    Unit{Quantity::Speed, "km/h", 1.0 / 3.6},
    Unit{Quantity::Acceleration, "m/s^2", 1.0},
    Unit{Quantity::Acceleration, "g", kStandardGravity},
    Unit{Quantity::Acceleration, "mg", 1e-3 * kStandardGravity},
    Unit{Quantity::Power, "dBm", 1.0},
};

constexpr bool kOptional = false;

FieldSpec stamp() {
  return {"stamp", Quantity::Time};
}

TableSpec odometry() {
  return {"odometry",
          {stamp(),
           {"distance", Quantity::Length},
           {"heading", Quantity::Angle},
           {"interval", Quantity::Time, kOptional}}};
}

TableSpec odometryPose() {
  return {"odometry_pose",
          {stamp(),
           {"dx", Quantity::Length},
           {"dy", Quantity::Length},
           {"dyaw", Quantity::Angle},
           {"interval", Quantity::Time, kOptional}}};
}

TableSpec wheelSpeeds() {
  return {"wheel_speeds",
          {stamp(),
           {"left", Quantity::Speed},
           {"right", Quantity::Speed},
           {"yaw_rate", Quantity::AngularRate, kOptional}}};
}

TableSpec wheelTicks() {
  return {"wheel_ticks", {stamp(), {"left"}, {"right"}}};
}

TableSpec imuRates() {
  return {"imu",
          {stamp(),
           {"wx", Quantity::AngularRate},
           {"wy", Quantity::AngularRate},
           {"wz", Quantity::AngularRate},
           {"ax", Quantity::Acceleration},
           {"ay", Quantity::Acceleration},
           {"az", Quantity::Acceleration},
           {"interval", Quantity::Time, kOptional}}};
}

TableSpec imuIncrements() {
  return {"imu_increments",
          {stamp(),
           {"dax", Quantity::Angle},
           {"day", Quantity::Angle},
           {"daz", Quantity::Angle},
           {"dvx", Quantity::Speed},
           {"dvy", Quantity::Speed},
           {"dvz", Quantity::Speed},
           {"interval", Quantity::Time}}};
}

TableSpec ranges() {
  return {"ranges",
          {stamp(),
           {"tag"},
           {"anchor"},
           {"range", Quantity::Length},
           {"sigma", Quantity::Length, kOptional},
           {"rx_power", Quantity::Power, kOptional},
           {"first_path_power", Quantity::Power, kOptional}}};
}

TableSpec gnss() {
  return {"gnss",
          {stamp(),
           {"latitude", Quantity::Angle},
           {"longitude", Quantity::Angle},
           {"altitude", Quantity::Length},
           {"sigma_east", Quantity::Length},
           {"sigma_north", Quantity::Length},
           {"sigma_up", Quantity::Length},
           {"fix_status", Quantity::Plain, kOptional}}};
}

}  // namespace

std::optional<double> unitFactor(Quantity quantity, std::string_view unit) {
  for (const Unit& known : kUnits) {
    if (known.quantity == quantity && known.name == unit) return known.factor;
  }
  return {};
}

std::vector<std::string> unitsOf(Quantity quantity) {
  std::vector<std::string> names;
  for (const Unit& known : kUnits) {
    if (known.quantity == quantity) names.emplace_back(known.name);
  }
  return names;
}

const std::vector<TableSpec>& streamSpecs() {
  static const std::vector<TableSpec> kSpecs{odometry(), odometryPose(),  wheelSpeeds(), wheelTicks(),
                                             imuRates(), imuIncrements(), ranges(),      gnss()};
  return kSpecs;
}

const TableSpec& truthSpec() {
  static const TableSpec kSpec{"truth",
                               {stamp(),
                                {"x", Quantity::Length},
                                {"y", Quantity::Length},
                                {"z", Quantity::Length, kOptional},
                                {"yaw", Quantity::Angle, kOptional},
                                {"qw", Quantity::Plain, kOptional},
                                {"qx", Quantity::Plain, kOptional},
                                {"qy", Quantity::Plain, kOptional},
                                {"qz", Quantity::Plain, kOptional}}};
  return kSpec;
}

const TableSpec& anchorsSpec() {
  static const TableSpec kSpec{"anchors",
                               {{"id"},
                                {"x", Quantity::Length},
                                {"y", Quantity::Length},
                                {"z", Quantity::Length},
                                {"survey_sigma", Quantity::Length, kOptional},
                                {"range_bias", Quantity::Length, kOptional}}};
  return kSpec;
}

const TableSpec& tagsSpec() {
  static const TableSpec kSpec{
      "tags", {{"id"}, {"x", Quantity::Length}, {"y", Quantity::Length}, {"z", Quantity::Length}}};
  return kSpec;
}

}  // namespace pos::io
