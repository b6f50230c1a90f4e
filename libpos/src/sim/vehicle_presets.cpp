#include "pos/core/angle.hpp"
#include "pos/sim/vehicle.hpp"

namespace pos::sim {

Vehicle ackermannCar() {
  return {.name = "ackermann_car",
          .steering = Steering::FrontAckermann,
          .length = 5.0,
          .width = 2.0,
          .height = 1.9,
          .clearance = 0.25,
          .centre_x = 1.5,
          .wheelbase = 3.0,
          .front_track = 1.7,
          .rear_track = 1.7,
          .wheel_radius = 0.45,
          .wheel_width = 0.25,
          .max_speed = 25.0 / 3.6,
          .max_steer = radians(35.0),
          .encoder_track = 1.7,
          .mounts = {{"tag", {1.5, 0.0, 1.9}},
                     {"imu", {0.3, 0.0, 0.6}},
                     {"gnss", {1.5, 0.0, 1.95}},
                     {"lidar", {3.6, 0.0, 1.0}}}};
}

Vehicle wlr5a() {
  return {
      .name = "wlr5a",
      .steering = Steering::FourWheel,
      .length = 4.6,
      .width = 2.2,
      .height = 0.75,
      .clearance = 0.30,
      .wheelbase = 2.02,
      .front_track = 1.90,
      .rear_track = 1.90,
      .wheel_radius = 0.45,
      .wheel_width = 0.30,
      .max_speed = 5.0,
      .max_steer = radians(30.0),
      .encoder_axle_x = -1.01,
      .encoder_track = 1.90,
      .mounts = {
          {"tag_left", {0.0, 0.375, 0.75}}, {"tag_right", {0.0, -0.375, 0.75}}, {"imu", {0.0, 0.0, 0.5}}}};
}

Vehicle differentialCar() {
  return {.name = "differential_car",
          .steering = Steering::Differential,
          .length = 0.30,
          .width = 0.24,
          .height = 0.15,
          .clearance = 0.03,
          .centre_x = 0.08,
          .front_track = 0.20,
          .rear_track = 0.20,
          .wheel_radius = 0.05,
          .wheel_width = 0.025,
          .max_speed = 1.0,
          .encoder_track = 0.20,
          .mounts = {{"imu", {0.0, 0.0, 0.0}}, {"tag", {0.0, 0.0, 0.15}}}};
}

Vehicle intelligentMineI() {
  return {.name = "intelligent_mine_1",
          .steering = Steering::FrontAckermann,
          .length = 1.860,
          .width = 1.245,
          .height = 0.500,
          .clearance = 0.10,
          .centre_x = 0.600,
          .wheelbase = 1.200,
          .front_track = 1.136,
          .rear_track = 1.130,
          .wheel_radius = 0.20,
          .wheel_width = 0.11,
          .max_speed = 40.0 / 3.6,
          .max_steer = radians(32.0),
          .encoder_track = 1.130,
          .mounts = {{"imu", {0.6, 0.0, 0.3}},
                     {"tag", {0.6, 0.0, 0.5}},
                     {"gnss", {0.3, 0.0, 0.55}},
                     {"lidar", {1.2, 0.0, 0.5}}}};
}

Vehicle articulatedLoader() {
  return {.name = "articulated_loader",
          .steering = Steering::Articulated,
          .length = 9.7,
          .width = 2.6,
          .height = 2.4,
          .clearance = 0.40,
          .centre_x = 1.9,
          .wheelbase = 3.4,
          .front_track = 2.0,
          .rear_track = 2.0,
          .wheel_radius = 0.78,
          .wheel_width = 0.60,
          .max_speed = 25.0 / 3.6,
          .max_steer = radians(42.0),
          .encoder_track = 2.0,
          .mounts = {{"imu", {-0.5, 0.0, 1.2}}, {"tag", {-1.0, 0.8, 2.4}}, {"lidar", {-2.8, 0.0, 1.8}}}};
}

Vehicle shearer() {
  return {.name = "shearer",
          .steering = Steering::Guided,
          .length = 13.0,
          .width = 2.0,
          .height = 1.6,
          .max_speed = 0.5,
          .mounts = {{"imu", {0.0, 0.0, 0.0}}, {"lidar", {0.0, 0.0, 0.0}}}};
}

std::vector<Vehicle> vehiclePresets() {
  return {ackermannCar(), wlr5a(), differentialCar(), intelligentMineI(), articulatedLoader(), shearer()};
}

}  // namespace pos::sim
