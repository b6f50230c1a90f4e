#pragma once
/// The end of a longwall face at a gate road, for the tests of registration and creep.

#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include "pos/core/angle.hpp"
#include "pos/core/random.hpp"
#include "pos/lidar/icp.hpp"
#include "pos/sim/lidar_stream.hpp"

namespace pos::lidar::scene {

/// Standing.
class Stand : public sim::Motion {
 public:
  explicit Stand(const Pose2& T_map_body) : T_map_body_(T_map_body) {}
  sim::Kinematics at(double) const override {
    sim::Kinematics k;
    k.p_map = {T_map_body_.x, T_map_body_.y, 0.0};
    k.R_map_body = Eigen::AngleAxisd(T_map_body_.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return k;
  }
  double duration() const override { return 0.0; }
  double travelled(double) const override { return 0.0; }
  const std::vector<double>& breaks() const override { return breaks_; }

 private:
  Pose2 T_map_body_;
  std::vector<double> breaks_ = {};
};

/// Free where `open(x, y)` says so; cells of 0.5 m over x and y from -40 to 40.
template <class Open>
std::shared_ptr<const map::OccupancyGrid> rockAround(Open open) {
  auto grid = std::make_shared<map::OccupancyGrid>();
  *grid = {.x_min = -40.0, .y_min = -40.0, .resolution = 0.5, .columns = 160, .rows = 160};
  for (int row = 0; row < grid->rows; ++row) {
    for (int column = 0; column < grid->columns; ++column) {
      const bool free = open(-40.0 + 0.5 * (column + 0.5), -40.0 + 0.5 * (row + 0.5));
      grid->occupancy.push_back(free ? 0 : 100);
    }
  }
  return grid;
}

/// A gate road of 5 m along x that meets the face (9 m wide, along y) about x = -1.5, as maps/longwall.
inline std::shared_ptr<const map::OccupancyGrid> gateAndFace() {
  return rockAround([](double x, double y) { return std::abs(y) < 2.5 || std::abs(x + 1.5) < 4.5; });
}
/// The gate road alone: two parallel walls.
inline std::shared_ptr<const map::OccupancyGrid> gateAlone() {
  return rockAround([](double, double y) { return std::abs(y) < 2.5; });
}

/// The scanner's nominal fan, 0 to 180 degrees to the left.
inline sim::LidarConfig fan(double sigma = 0.0) {
  sim::LidarConfig config;
  config.scanner.sigma_range = sigma;
  return config;
}

inline Scan2D sweepAt(const Pose2& T_map_body, const std::shared_ptr<const map::OccupancyGrid>& grid,
                      const sim::LidarConfig& config, std::uint64_t seed = 1) {
  sim::LidarStream stream(config, grid, std::make_shared<Stand>(T_map_body), {.seed = seed});
  return std::get<Scan2D>(stream.next()->measurement.reading);
}

}  // namespace pos::lidar::scene
