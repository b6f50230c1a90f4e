#include "imu_errors.hpp"

#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"

namespace pos::sim {
namespace {

constexpr double kGravity = 9.80665;  // m/s^2 of the data sheets' g

enum Purpose : std::uint32_t { kConstants = 1, kNoise = 2, kDrift = 3 };

std::uint32_t purposeOf(Purpose purpose, TriadNoise::Part part) {
  return static_cast<std::uint32_t>(part) * Ticker::kFirstPurpose + purpose;
}

/// I + small angles between the axes, times I + scale.
Eigen::Matrix3d gainMatrix(const TriadErrors& errors, RandomStream& random) {
  Eigen::Matrix3d tilts = Eigen::Matrix3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (row != column) tilts(row, column) = errors.misalignment_sigma * random.normal();
    }
  }
  const Eigen::Vector3d scale = Eigen::Vector3d::Ones() + errors.scale + errors.scale_sigma * normals(random);
  return tilts * scale.asDiagonal();
}

void requireUsable(const TriadErrors& errors, const std::string& key) {
  if (!errors.bias.allFinite()) refuse("the bias is no number", key + ".bias", "", "three numbers");
  if (!errors.moving_bias.allFinite())
    refuse("the bias is no number", key + ".moving_bias", "", "three numbers");
  if (!errors.scale.allFinite()) refuse("the scale is no number", key + ".scale", "", "three numbers");
  requireNotNegative(errors.bias_sigma, key + ".bias_sigma");
  requireNotNegative(errors.noise_density, key + ".noise_density");
  requireNotNegative(errors.instability_sigma, key + ".instability_sigma");
  requirePositive(errors.instability_time, key + ".instability_time");
  requireNotNegative(errors.walk_density, key + ".walk_density");
  requireNotNegative(errors.scale_sigma, key + ".scale_sigma");
  requireNotNegative(errors.misalignment_sigma, key + ".misalignment_sigma");
  requireNotNegative(errors.quantum, key + ".quantum");
  requireNotNegative(errors.limit, key + ".limit");
}

}  // namespace

TriadNoise::TriadNoise(const TriadErrors& errors, Part part, const Timing& timing, const RunSetup& run)
    : errors_(errors),
      noise_(randomStream(run, timing, purposeOf(kNoise, part))),
      drift_(randomStream(run, timing, purposeOf(kDrift, part))) {
  RandomStream constants = randomStream(run, timing, purposeOf(kConstants, part));
  bias_ = errors.bias + errors.bias_sigma * normals(constants);
  gain_ = gainMatrix(errors, constants);
  instability_ = errors.instability_sigma * normals(drift_);
}

void TriadNoise::drift(double dt) {
  if (errors_.instability_sigma > 0.0) {
    const double kept = std::exp(-dt / errors_.instability_time);
    const double fresh =
        errors_.instability_sigma * std::sqrt(-std::expm1(-2.0 * dt / errors_.instability_time));
    instability_ = kept * instability_ + fresh * normals(drift_);
  }
  if (errors_.walk_density > 0.0) walk_ += errors_.walk_density * std::sqrt(dt) * normals(drift_);
}

Eigen::Vector3d TriadNoise::reading(const Eigen::Vector3d& average, double dt, ImuSample::Kind kind,
                                    Ride ride) {
  drift(dt);
  Eigen::Vector3d value = gain_ * average + bias_ + instability_ + walk_;
  if (ride == Ride::Moving) value += errors_.moving_bias;
  if (errors_.noise_density > 0.0) value += errors_.noise_density / std::sqrt(dt) * normals(noise_);
  if (errors_.limit > 0.0) value = value.cwiseMax(-errors_.limit).cwiseMin(errors_.limit);
  return rounded(kind == ImuSample::Kind::Increments ? (value * dt).eval() : value, kind);
}

Eigen::Vector3d TriadNoise::rounded(const Eigen::Vector3d& value, ImuSample::Kind kind) {
  if (errors_.quantum <= 0.0) return value;
  const auto whole = [this](const Eigen::Vector3d& exact) -> Eigen::Vector3d {
    return errors_.quantum * (exact / errors_.quantum).array().round().matrix();
  };
  if (kind == ImuSample::Kind::Rates) return whole(value);
  // A counter loses nothing: what was not given out now comes with the next increment.
  Eigen::Vector3d given = whole(value + remainder_);
  remainder_ += value - given;
  return given;
}

ImuErrors perfectImu() {
  return {};
}

ImuErrors automotiveMems() {
  return {.gyro = {.bias_sigma = 5e-4, .noise_density = 2e-4, .walk_density = 1e-6},
          .accelerometer = {.bias_sigma = 0.02, .noise_density = 2e-3, .walk_density = 1e-4}};
}

ImuErrors laboratoryMems() {
  return {.gyro = {.bias_sigma = radians(0.02), .noise_density = radians(0.01)},
          .accelerometer = {.bias_sigma = 2e-3 * kGravity, .noise_density = 200e-6 * kGravity}};
}

ImuErrors navigationGrade() {
  return {.gyro = {.bias = Eigen::Vector3d::Constant(radians(0.05) / 3600.0),
                   .noise_density = radians(0.01) / 60.0},
          .accelerometer = {.bias = Eigen::Vector3d::Constant(50e-6 * kGravity),
                            .noise_density = 10e-6 * kGravity}};
}

ImuModel validated(const ImuModel& model) {
  if (model.sensor.empty()) refuse("the sensor has no name", "sensor", "", "a name");
  validated(model.timing);
  if (!model.p_body.allFinite()) refuse("the place is no place", "p_body", "", "x, y, z in metres");
  requireUsable(model.errors.gyro, "errors.gyro");
  requireUsable(model.errors.accelerometer, "errors.accelerometer");
  return model;
}

}  // namespace pos::sim
