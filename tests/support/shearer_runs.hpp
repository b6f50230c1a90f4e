#pragma once
/// The shearer of Zheng et al. 2021, section 4 as scenarios in code (the same as
/// configs/scenarios/shearer_*.yaml), and runs of estimators on them.

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "pos/core/angle.hpp"
#include "pos/estimation/shearer.hpp"
#include "pos/map/tunnel_map.hpp"
#include "pos/sim/scenario.hpp"
#include "pos/sim/simulation.hpp"

namespace pos::testing {

/// Right, forward, up in arc minutes (the paper's axes) as a rotation vector in ours: forward, left, up.
inline Eigen::Vector3d flu(double right, double forward, double up) {
  return radians(1.0 / 60.0) * Eigen::Vector3d(forward, -right, up);
}

struct ShearerScene {
  sim::Scenario scenario;
  std::shared_ptr<const map::TunnelMap> map;
};

struct ShearerSceneOptions {
  sim::ShearerConfig motion = {.passes = 3};
  bool inertial_errors = true;
  bool scanner_errors = true;
  Eigen::Vector3d mount_error = Eigen::Vector3d::Zero();  ///< rad, body axes
  double sigma_range = 0.0;                               ///< m
  bool turning_earth = true;
  double lidar_rate = 25.0;  ///< Hz
};

inline ShearerScene shearerScene(const ShearerSceneOptions& options) {
  auto map = std::make_shared<map::TunnelMap>();
  map->name = "longwall";
  map->origin = map::GeodeticOrigin{.latitude = radians(35.0), .longitude = radians(112.5)};
  sim::Scenario s;
  s.name = "shearer";
  s.start = 1000.0;
  s.vehicle.name = "shearer";
  s.vehicle.steering = sim::Steering::Guided;
  s.vehicle.length = 13.0;
  s.vehicle.width = 2.0;
  s.vehicle.height = 1.6;
  s.vehicle.wheel_radius = 0.15915494309189535;
  s.vehicle.encoder_track = 1.0;
  s.vehicle.max_speed = 0.5;
  s.earth.kind = options.turning_earth ? sim::EarthKind::Level : sim::EarthKind::Flat;
  s.motion = options.motion;
  sim::ImuModel imu{.sensor = "imu", .kind = ImuSample::Kind::Increments};
  if (options.inertial_errors) {
    imu.errors = sim::navigationGrade();
    imu.errors.gyro.bias.y() *= -1.0;  // + in the paper's axes, whose x is our -y
    imu.errors.accelerometer.bias.y() *= -1.0;
  }
  s.sensors.push_back({.name = "imu", .model = imu});
  sim::EncoderModel odometer{.sensor = "odometer",
                             .output = sim::EncoderModel::Output::Increment,
                             .timing = {.rate = 25.0},
                             .ticks_per_turn = 1000.0,
                             .left_radius_error = 2.5e-4,
                             .right_radius_error = 2.5e-4};
  s.sensors.push_back({.name = "odometer", .model = odometer});
  sim::SupportLegSensor legs;
  legs.config.timing.rate = options.lidar_rate;
  legs.config.mount_error = options.mount_error;
  legs.config.scanner.sigma_range = options.sigma_range;
  if (options.scanner_errors) legs.config.scanner.errors = sim::LidarErrors::paper();
  s.sensors.push_back({.name = "lidar", .model = legs});
  return {s, map};
}

/// A shearer that starts at end 1 with this attitude error (rad, n axes: east, north, up; C~ = (I - phi x)
/// C).
inline estimation::ShearerConfig shearerConfig(const Eigen::Vector3d& phi, double yaw_sigma_arcmin = 5.0) {
  estimation::ShearerConfig config;
  // Facing north: east is the body's right, north its forward.
  config.start.pose.yaw = 0.5 * kPi - phi.z();
  config.alignment.pitch = -phi.x();
  config.alignment.roll = -phi.y();
  config.start.yaw_sigma = radians(yaw_sigma_arcmin / 60.0);
  return config;
}
inline Eigen::Vector3d arcmin(double east, double north, double up) {
  return radians(1.0 / 60.0) * Eigen::Vector3d(east, north, up);
}

/// Runs the simulation, every measurement into every estimator; `look` once a second with t and truth.
inline void runShearer(const ShearerScene& scene, std::uint64_t seed,
                       const std::vector<estimation::Estimator*>& estimators,
                       const std::function<void(double, const Pose3&)>& look) {
  sim::Simulation simulation(scene.scenario, scene.map, seed);
  double next = 0.0;
  while (const auto delivery = simulation.next()) {
    const double t = seconds(delivery->measurement.stamp - simulation.start());
    while (t >= next + 1e-9) {
      look(next, simulation.truthPoseAt(simulation.start() + durationFromSeconds(next)));
      next += 1.0;
    }
    for (estimation::Estimator* estimator : estimators) (void)estimator->ingest(delivery->measurement);
  }
}

}  // namespace pos::testing
