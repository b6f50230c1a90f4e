#pragma once
/// Vehicles of every kind of steering for the tests of the simulator. Their figures are those that the tests'
/// own oracles use; the vehicles of the experiments are in configs/vehicles.

#include "pos/core/angle.hpp"
#include "pos/sim/vehicle.hpp"

namespace pos::sim::samples {

inline Vehicle frontSteered() {
  return {.name = "front_steered",
          .steering = Steering::FrontAckermann,
          .length = 5.0,
          .width = 2.0,
          .height = 1.9,
          .wheelbase = 3.0,
          .wheel_radius = 0.45,
          .max_speed = 7.0,
          .max_steer = radians(35.0),
          .encoder_track = 1.7};
}

/// The encoders sit on a steered axle.
inline Vehicle fourWheelSteered() {
  return {.name = "four_wheel_steered",
          .steering = Steering::FourWheel,
          .length = 4.6,
          .width = 2.2,
          .height = 0.75,
          .wheelbase = 2.02,
          .wheel_radius = 0.45,
          .max_speed = 5.0,
          .max_steer = radians(30.0),
          .encoder_axle_x = -1.01,
          .encoder_track = 1.90,
          .mounts = {{"tag_left", {0.0, 0.375, 0.75}}, {"imu", {0.0, 0.0, 0.5}}}};
}

inline Vehicle differential() {
  return {.name = "differential",
          .steering = Steering::Differential,
          .length = 0.30,
          .width = 0.24,
          .height = 0.15,
          .wheel_radius = 0.05,
          .max_speed = 1.0,
          .encoder_track = 0.20};
}

inline Vehicle articulated() {
  return {.name = "articulated",
          .steering = Steering::Articulated,
          .length = 9.7,
          .width = 2.6,
          .height = 2.4,
          .wheelbase = 3.4,
          .wheel_radius = 0.78,
          .max_speed = 7.0,
          .max_steer = radians(42.0),
          .encoder_track = 2.0};
}

/// Without wheels.
inline Vehicle guided() {
  return {.name = "guided",
          .steering = Steering::Guided,
          .length = 13.0,
          .width = 2.0,
          .height = 1.6,
          .max_speed = 0.5};
}

}  // namespace pos::sim::samples
