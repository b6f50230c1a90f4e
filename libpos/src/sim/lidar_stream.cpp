#include "pos/sim/lidar_stream.hpp"

#include <cmath>

#include "pos/core/config_checks.hpp"
#include "pos/sim/ray_cast.hpp"
#include "scanner.hpp"

namespace pos::sim {

LidarConfig validated(LidarConfig config) {
  requireValid(config.timing, config.sensor + ".timing");
  (void)validated(config.scanner, config.sensor + ".scanner");
  require(config.rock_from >= 1 && config.rock_from <= 100, config.sensor + ".rock_from", "1 to 100 percent");
  return config;
}

struct LidarStream::State {
  LidarConfig config;
  std::shared_ptr<const map::OccupancyGrid> grid;
  std::shared_ptr<const Motion> motion;
  Ticker ticker;
  Scanner scanner;
  std::vector<double> truths;

  /// Way along a beam to the rock, m.
  double castOne(const Pose3& T_map_sensor, const Eigen::Vector2d& look) const {
    const Eigen::Vector3d way = T_map_sensor.rotation * Eigen::Vector3d(look.x(), look.y(), 0.0);
    const double in_plan = std::hypot(way.x(), way.y());
    if (in_plan < 1e-6) return kNoReturn;
    const std::optional<double> hit =
        rayCast(*grid, T_map_sensor.translation.head<2>(), std::atan2(way.y(), way.x()),
                config.scanner.range_max * in_plan, config.rock_from);
    return hit ? *hit / in_plan : kNoReturn;
  }

  Scan2D scan(double t) {
    const Pose3 T_map_sensor = poseOf(motion->at(t)) * config.scanner.T_body_sensor;
    for (std::size_t i = 0; i < truths.size(); ++i) {
      truths[i] = castOne(T_map_sensor, scanner.look(static_cast<int>(i)));
    }
    return scanner.sweep(t, truths);
  }
};

LidarStream::LidarStream(const LidarConfig& config, std::shared_ptr<const map::OccupancyGrid> grid,
                         std::shared_ptr<const Motion> motion, const RunSetup& run)
    : state_(new State{.config = validated(config),
                       .grid = std::move(grid),
                       .motion = motion,
                       .ticker = Ticker(config.timing, run, motion->duration()),
                       .scanner = Scanner(config.scanner, config.timing, run),
                       .truths = std::vector<double>(static_cast<std::size_t>(config.scanner.beams))}) {
  require(state_->grid != nullptr, config.sensor, "a map with an occupancy grid");
}

LidarStream::~LidarStream() = default;

std::optional<Delivery> LidarStream::next() {
  while (const std::optional<Tick> tick = state_->ticker.next()) {
    Scan2D scan = state_->scan(tick->t);
    if (!tick->lost) return state_->ticker.sent(tick->t, state_->config.sensor, std::move(scan));
  }
  return {};
}

}  // namespace pos::sim
