#pragma once
/// Simulated planar laser scanner in an occupancy grid.

#include <memory>
#include <vector>

#include "pos/map/tunnel_map.hpp"
#include "pos/sim/lidar_errors.hpp"
#include "pos/sim/motion.hpp"
#include "pos/sim/timing.hpp"

namespace pos::sim {

/// Beams lost to dust while it hangs in the air.
struct Dust {
  TimeSpan when = {};
  double drop_probability = 0.5;  ///< of a beam, in place of the scanner's own
};

/// What scanner and air do to any scan.
struct ScannerConfig {
  Pose3 T_body_sensor = {};
  double angle_first = 0.0;       ///< rad, sensor frame
  double angle_step = 0.0043633;  ///< rad, signed (0.25 deg)
  int beams = 721;
  double range_min = 0.05;        ///< m
  double range_max = 30.0;        ///< m
  double sigma_range = 0.010;     ///< m
  double sigma_angle = 0.0;       ///< rad
  double drop_probability = 0.0;  ///< of a beam
  std::vector<Dust> dust = {};
  LidarErrors errors = {};
};

/// Throws ConfigError naming `key` and the first field that cannot be.
ScannerConfig validated(ScannerConfig config, const std::string& key);

struct LidarConfig {
  std::string sensor = "lidar";
  Timing timing = {.rate = 25.0};
  ScannerConfig scanner = {};
  int rock_from = 50;  ///< percent, occupancy that stops a beam
};

LidarConfig validated(LidarConfig config);

/// The sweep is taken at one moment. Walls are upright: a beam of a tilted scanner meets the rock where its
/// plan does; floor and roof are not seen.
class LidarStream : public SensorStream {
 public:
  LidarStream(const LidarConfig& config, std::shared_ptr<const map::OccupancyGrid> grid,
              std::shared_ptr<const Motion> motion, const RunSetup& run);
  ~LidarStream() override;
  std::optional<Delivery> next() override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pos::sim
