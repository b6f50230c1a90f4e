#pragma once
/// A short synthetic run for tests: a vehicle drives an oval in a walled room with four anchors, with
/// odometry, ranges and scans. Truth by formula; noise from explicit seeds. (The real simulator is module
/// `sim`.)

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "pos/core/angle.hpp"
#include "pos/core/measurement.hpp"
#include "pos/core/random.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::testing {

struct SmallRunOptions {
  std::uint64_t seed = 1;
  double duration = 30.0;        ///< s
  double odometry_rate = 10.0;   ///< Hz
  double range_sigma = 0.1;      ///< m
  double distance_noise = 0.03;  ///< m / sqrt(m)
  double lateral_noise = 0.01;   ///< m / sqrt(m)
  double yaw_noise = 0.01;       ///< rad / sqrt(m)
  double gyro_bias = 0.0;        ///< rad/s
  double range_scale = 1.0;
  double range_offset = 0.0;  ///< m
  double latency = 0.0;       ///< s
  double outlier_share = 0.0;
  bool scans = false;
  Eigen::Vector3d tag_body{0.3, 0.0, 1.0};
  /// With a second tag both range to every anchor at one moment, instead of one anchor after another.
  std::optional<Eigen::Vector3d> second_tag = {};
  bool gyro = false;
  bool inertial = false;  ///< a whole inertial unit at five times the odometry's rate
};

inline Stamp runStamp(double t) {
  return stampFromSeconds(1000.0 + t);
}

/// An oval of 12 x 5 m about the room's centre at about 1 m/s; yaw along the track.
inline Pose2 truthAt(double t) {
  const double phase = 0.2 * t;
  const double dx = -6.0 * std::sin(phase);
  const double dy = 2.5 * std::cos(phase);
  return {10.0 + 6.0 * std::cos(phase), 5.0 + 2.5 * std::sin(phase), std::atan2(dy, dx)};
}

/// Room of 20 x 10 m with a pillar near one corner, cells of 0.1 m, and four anchors (ids 1..4).
inline std::shared_ptr<const map::TunnelMap> smallMap() {
  auto map = std::make_shared<map::TunnelMap>();
  map->name = "small room";
  map->anchors = {{1, "A1", {0.5, 0.5, 2.0}},
                  {2, "A2", {19.5, 0.7, 2.0}},
                  {3, "A3", {19.3, 9.5, 1.8}},
                  {4, "A4", {0.4, 9.4, 2.2}}};
  map::OccupancyGrid grid;
  grid.columns = 202;
  grid.rows = 102;
  grid.resolution = 0.1;
  grid.x_min = grid.y_min = -0.1;
  grid.occupancy.assign(202 * 102, 0);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const bool wall = row == 0 || column == 0 || row == grid.rows - 1 || column == grid.columns - 1;
      const bool pillar = column > 150 && column <= 170 && row > 60 && row <= 70;
      if (wall || pillar) grid.occupancy[static_cast<std::size_t>(row * grid.columns + column)] = 100;
    }
  }
  map->grid = grid;
  return map;
}

/// Distance along a ray to the first occupied cell, by small steps; slow and simple.
inline double castRay(const map::OccupancyGrid& grid, const Eigen::Vector2d& from, double angle,
                      double range_max) {
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  for (double d = 0.0; d < range_max; d += 0.02) {
    const Eigen::Vector2d p = from + d * direction;
    const int column = static_cast<int>(std::floor((p.x() - grid.x_min) / grid.resolution));
    const int row = static_cast<int>(std::floor((p.y() - grid.y_min) / grid.resolution));
    if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows || grid.at(column, row) == 100)
      return d;
  }
  return range_max;
}

inline Scan2D scanAt(const map::OccupancyGrid& grid, const Pose2& pose, RandomStream& random) {
  Scan2D scan;
  scan.T_body_sensor = Pose3::fromXyzYawPitchRoll(0.1, 0.0, 0.3, 0.0, 0.0, 0.0);
  constexpr int kBeams = 91;
  scan.angle_first = -0.5 * kPi;
  scan.angle_step = kPi / (kBeams - 1);
  scan.range_max = 30.0;
  const Eigen::Vector2d from = pose * Eigen::Vector2d(0.1, 0.0);
  for (int i = 0; i < kBeams; ++i) {
    const double d = castRay(grid, from, pose.yaw + scan.angle_first + i * scan.angle_step, scan.range_max);
    scan.ranges.push_back(static_cast<float>(std::max(0.05, d + random.normal(0.0, 0.03))));
    scan.valid.push_back(1);
  }
  return scan;
}

/// What a level inertial unit at the body's origin feels, by differences of the formula.
inline ImuSample imuAt(double t) {
  constexpr double h = 1e-3;
  const Pose2 before = truthAt(t - h);
  const Pose2 now = truthAt(t);
  const Pose2 after = truthAt(t + h);
  const Eigen::Vector2d acceleration =
      (after.translation() - 2.0 * now.translation() + before.translation()) / (h * h);
  const Eigen::Vector2d force = rotation2(-now.yaw) * acceleration;
  ImuSample imu;
  imu.angular.z() = wrapAngle(after.yaw - before.yaw) / (2.0 * h);
  imu.linear = {force.x(), force.y(), 9.80665};
  return imu;
}

/// All measurements, ordered by stamp. Ranges come one anchor after another between the odometry samples.
inline std::vector<Measurement> smallRun(const SmallRunOptions& options) {
  RandomStream random(options.seed, 1);
  const auto map = smallMap();
  std::vector<Measurement> log;
  const double dt = 1.0 / options.odometry_rate;
  const auto steps = static_cast<int>(options.duration * options.odometry_rate);
  for (int k = 1; k <= steps; ++k) {
    const double t = k * dt;
    const Pose2 exact = inverse(truthAt(t - dt)) * truthAt(t);
    const double root = std::sqrt(exact.translation().norm());
    OdometryIncrement odometry;
    odometry.increment = {exact.x + random.normal(0.0, options.distance_noise * root),
                          exact.y + random.normal(0.0, options.lateral_noise * root),
                          exact.yaw + options.gyro_bias * dt + random.normal(0.0, options.yaw_noise * root)};
    odometry.interval = durationFromSeconds(dt);
    log.push_back({runStamp(t), "wheels", odometry});

    if (options.inertial) {
      for (int j = 1; j <= 5; ++j)
        log.push_back({runStamp(t - dt + 0.2 * j * dt), "imu", imuAt(t - dt + (0.2 * j - 0.1) * dt)});
    }
    if (options.gyro) {
      ImuSample imu;
      imu.angular.z() = wrapAngle(truthAt(t + 1e-3).yaw - truthAt(t - 1e-3).yaw) / 2e-3;
      log.push_back({runStamp(t), "imu", imu});
    }
    const double heard = t + 0.4 * dt;
    const auto ranged = [&](const map::Anchor& anchor, TagId tag, const Eigen::Vector3d& tag_body) {
      const Pose3 T_map_body = Pose3::fromPlanar(truthAt(heard - options.latency));
      const double distance = (T_map_body * tag_body - anchor.p_map).norm();
      BeaconRange range;
      range.tag = tag;
      range.anchor = anchor.id;
      range.tag_body = tag_body;
      range.range =
          options.range_scale * distance + options.range_offset + random.normal(0.0, options.range_sigma);
      if (random.bernoulli(options.outlier_share))
        range.range += random.uniform(3.0, 20.0) * (random.bernoulli(0.5) ? 1.0 : -1.0);
      range.range = std::max(range.range, 0.05);
      log.push_back({runStamp(heard), "uwb", range});
    };
    if (options.second_tag) {
      for (const map::Anchor& anchor : map->anchors) {
        ranged(anchor, 0, options.tag_body);
        ranged(anchor, 1, *options.second_tag);
      }
    } else {
      ranged(map->anchors[static_cast<std::size_t>(k) % map->anchors.size()], 0, options.tag_body);
    }
    if (options.scans && k % 5 == 0)
      log.push_back({runStamp(heard), "laser", scanAt(*map->grid, truthAt(heard), random)});
  }
  if (options.inertial) {
    std::stable_sort(log.begin(), log.end(), [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  }
  return log;
}

}  // namespace pos::testing
