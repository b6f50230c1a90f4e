#pragma once
/// A small made-up world for the particle filter's tests: four anchors, a walled room, a vehicle on a bend.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "pos/core/random.hpp"
#include "pos/estimation/odometry_sigma.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::estimation::scene {

inline std::shared_ptr<const map::TunnelMap> anchors() {
  map::TunnelMap map;
  const std::vector<Eigen::Vector3d> places{
      {-2.0, -3.0, 2.0}, {22.0, -2.0, 2.5}, {21.0, 16.0, 1.5}, {-3.0, 14.0, 3.0}};
  for (const Eigen::Vector3d& p : places) {
    const auto id = static_cast<AnchorId>(map.anchors.size() + 1);
    map.anchors.push_back({.id = id, .name = "a" + std::to_string(id), .p_map = p});
  }
  return std::make_shared<const map::TunnelMap>(map);
}

/// A room of 12 m x 8 m with a block in it and a niche, so that no two places look alike; walls are 1 cell
/// thick. The grid is turned and shifted in the map.
inline map::OccupancyGrid room() {
  map::OccupancyGrid grid{.T_map_grid = {100.0, -50.0, 0.4},
                          .x_min = -1.0,
                          .y_min = -1.0,
                          .resolution = 0.1,
                          .columns = 140,
                          .rows = 100,
                          .occupancy = {}};
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const bool inside = column >= 10 && column < 130 && row >= 10 && row < 90;
      const bool wall = column >= 9 && column <= 130 && row >= 9 && row <= 90 && !inside;
      const bool block = column >= 75 && column < 90 && row >= 55 && row < 75;
      const bool niche = column >= 10 && column < 22 && row >= 10 && row < 40;
      grid.occupancy.push_back(wall || block || niche ? 100 : inside ? 0 : map::OccupancyGrid::kUnknown);
    }
  }
  return grid;
}

inline std::shared_ptr<const map::TunnelMap> roomMap() {
  map::TunnelMap map;
  map.grid = room();
  return std::make_shared<const map::TunnelMap>(map);
}

inline bool isRock(const map::OccupancyGrid& grid, const Eigen::Vector2d& p_map) {
  const Eigen::Vector2d p = inverse(grid.T_map_grid) * p_map;
  const int column = static_cast<int>(std::floor((p.x() - grid.x_min) / grid.resolution));
  const int row = static_cast<int>(std::floor((p.y() - grid.y_min) / grid.resolution));
  if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows) return true;
  return grid.at(column, row) == 100;
}

/// 120 beams all around, by marching through the grid in steps of 5 mm.
inline Scan2D scanFrom(const map::OccupancyGrid& grid, const Pose2& T_map_body, double sigma,
                       RandomStream& random) {
  Scan2D scan;
  scan.T_body_sensor = Pose3::fromXyzYawPitchRoll(0.2, 0.1, 0.5, 0.3, 0.0, 0.0);
  scan.angle_first = -kPi;
  scan.angle_step = 2.0 * kPi / 120.0;
  scan.range_max = 30.0;
  const Pose2 T_map_sensor = T_map_body * scan.T_body_sensor.planar();
  for (int i = 0; i < 120; ++i) {
    const double angle = scan.angle_first + i * scan.angle_step + T_map_sensor.yaw;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    double range = 0.0;
    while (!isRock(grid, T_map_sensor.translation() + range * along)) range += 0.005;
    scan.ranges.push_back(static_cast<float>(std::max(0.0, range + random.normal(0.0, sigma))));
    scan.valid.push_back(1);
  }
  return scan;
}

inline BeaconRange rangeTo(const map::Anchor& anchor, const Pose2& T_map_body, double error) {
  BeaconRange range;
  range.anchor = anchor.id;
  range.tag_body = Eigen::Vector3d(0.4, -0.2, 1.1);
  const Eigen::Vector2d tag = T_map_body * Eigen::Vector2d(0.4, -0.2);
  range.range = (anchor.p_map - Eigen::Vector3d(tag.x(), tag.y(), 1.1)).norm() + error;
  return range;
}

/// Odometry that is wrong as its noise model says.
inline OdometryIncrement noisyOdometry(const Pose2& step, const OdometryNoise& noise, double dt,
                                       RandomStream& random) {
  const Vector<3> sigma = incrementSigma(noise, step, dt);
  const double a = random.normal();
  const double b = random.normal();
  const double c = random.normal();
  OdometryIncrement odometry;
  odometry.increment = plus(step, sigma.cwiseProduct(Vector<3>(a, b, c)));
  odometry.interval = durationFromSeconds(dt);
  return odometry;
}

}  // namespace pos::estimation::scene
