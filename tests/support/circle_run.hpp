#pragma once
/// The circle run of J. China Coal Soc. 2024 (doi 10.13225/j.cnki.jccs.2024.0676, Table 2) by formula: 2 m/s
/// along x for 10 s, then once around (20, 20), with an inertial unit and ranges to four anchors. The
/// simulator's scenario is configs/scenarios/circle_nlos.yaml; this one needs no simulator.

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "pos/core/measurement.hpp"
#include "pos/core/pose3.hpp"
#include "pos/core/random.hpp"
#include "pos/estimation/uwb_imu.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::testing {

struct CircleOptions {
  std::uint64_t seed = 1;
  double duration = 72.8;
  int imu_rate = 100;      ///< Hz
  int uwb_every = 10;      ///< inertial samples between epochs
  double uwb_phase = 0.0;  ///< s after a sample
  double range_sigma = 0.30;
  double hidden_share = 0.0;           ///< probability per anchor and 0.5 s; then 0.3 to 1.5 m too long
  double unit_errors = 1.0;            ///< times biases and noise of the inertial unit
  Eigen::Vector3d imu{0.0, 0.0, 0.3};  ///< above the origin: its velocity does not jump at the turn
  Eigen::Vector3d tag{0.0, 0.0, 0.5};
};

inline constexpr double kCircleSpeed = 2.0;
inline constexpr double kCircleTurn = 10.0;  // s, when it begins
inline constexpr double kCircleRate = 0.1;   // rad/s

inline Stamp circleStamp(double t) {
  return stampFromSeconds(1000.0 + t);
}

inline Pose3 circlePose(double t) {
  if (t <= kCircleTurn) return Pose3::fromXyzYawPitchRoll(kCircleSpeed * t, 0, 0, 0, 0, 0);
  const double yaw = kCircleRate * (t - kCircleTurn);
  return Pose3::fromXyzYawPitchRoll(20.0 + 20.0 * std::sin(yaw), 20.0 - 20.0 * std::cos(yaw), 0, yaw, 0, 0);
}

inline std::shared_ptr<const map::TunnelMap> circleMap() {
  auto map = std::make_shared<map::TunnelMap>();
  map->anchors = {
      {1, "A1", {-5, -5, 3}}, {2, "A2", {45, -5, 4}}, {3, "A3", {45, 45, 3}}, {4, "A4", {-5, 45, 4}}};
  return map;
}

/// What the unit feels at `imu`, biases and noise aside; turning or not.
inline ins::ImuIncrement circleIncrement(double t, double dt, const Eigen::Vector3d& imu) {
  if (t < kCircleTurn) return {Eigen::Vector3d::Zero(), dt * Eigen::Vector3d(0, 0, 9.80665), dt};
  const Eigen::Vector3d turn(0, 0, kCircleRate);
  const Eigen::Vector3d force =
      Eigen::Vector3d(0, kCircleSpeed * kCircleRate, 9.80665) + turn.cross(Eigen::Vector3d(turn.cross(imu)));
  return {dt * turn, dt * force, dt};
}

inline std::vector<Measurement> circleRun(const CircleOptions& options) {
  RandomStream noise(options.seed, 1);
  RandomStream radio(options.seed, 2);
  RandomStream hiding(options.seed, 3);
  const auto map = circleMap();
  const double dt = 1.0 / options.imu_rate;
  const Eigen::Vector3d gyro_bias = 5e-4 * options.unit_errors * normals(noise);
  const Eigen::Vector3d force_bias = 0.02 * options.unit_errors * normals(noise);
  std::vector<double> excess(map->anchors.size(), 0.0);
  int block = -1;
  std::vector<Measurement> log;
  const auto range = [&](double t) {
    if (const int now = static_cast<int>(t / 0.5 + 1e-9); now != block) {
      block = now;
      for (double& e : excess) {
        const bool hidden = hiding.bernoulli(options.hidden_share);
        const double size = hiding.uniform(0.3, 1.5);
        e = hidden ? size : 0.0;
      }
    }
    for (std::size_t i = 0; i < map->anchors.size(); ++i) {
      BeaconRange reading;
      reading.tag = 1;
      reading.anchor = map->anchors[i].id;
      reading.tag_body = options.tag;
      reading.range = (circlePose(t) * options.tag - map->anchors[i].p_map).norm() + excess[i] +
                      options.range_sigma * radio.normal();
      log.push_back({circleStamp(t), "uwb", reading});
    }
  };
  const int samples = static_cast<int>(std::lround(options.duration * options.imu_rate));
  range(0.0);
  for (int k = 1; k <= samples; ++k) {
    const double t = k * dt;
    const ins::ImuIncrement felt = circleIncrement(t - 0.5 * dt, dt, options.imu);
    ImuSample imu;
    imu.angular = felt.angle / dt + gyro_bias + 2e-4 / std::sqrt(dt) * options.unit_errors * normals(noise);
    imu.linear =
        felt.velocity / dt + force_bias + 2e-3 / std::sqrt(dt) * options.unit_errors * normals(noise);
    const bool epoch = k % options.uwb_every == 0;
    if (epoch && options.uwb_phase < 0.0) range(t + options.uwb_phase);
    log.push_back({circleStamp(t), "imu", imu});
    if (epoch && options.uwb_phase >= 0.0) range(t + options.uwb_phase);
  }
  return log;
}

/// A filter for it: everything told as it is, and the height held.
inline estimation::UwbImuConfig circleConfig(const CircleOptions& options) {
  estimation::UwbImuConfig config;
  config.start.pose = {0, 0, 0};
  config.start.position_sigma = 0.1;
  config.start.yaw_sigma = 0.035;
  config.first = {estimation::InertialStart::Levelling::InMotion, kCircleSpeed, 0.1, 0.01745, 0.1};
  config.mounts.imu = options.imu;
  config.range_sigma = options.range_sigma;
  config.aids.height_sigma = 0.1;
  config.robust.form = filters::RobustConfig::Form::None;
  return config;
}

}  // namespace pos::testing
