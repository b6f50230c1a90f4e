#pragma once
/// A shearer among the legs of its supports, for the tests of what finds them.

#include <Eigen/Geometry>
#include <memory>
#include <variant>
#include <vector>

#include "pos/core/angle.hpp"
#include "pos/core/random.hpp"
#include "pos/lidar/legs.hpp"
#include "pos/sim/leg_stream.hpp"

namespace pos::lidar::scene {

/// Drives, or stands, from station `y` along x = 0, facing north.
struct Cut {
  double y = 0.0;         // m
  double speed = 0.0;     // m/s
  double duration = 0.0;  // s
};

class CutMotion : public sim::Motion {
 public:
  explicit CutMotion(const Cut& cut) : cut_(cut) {}
  sim::Kinematics at(double t) const override {
    sim::Kinematics k;
    k.p_map = {0.0, cut_.y + cut_.speed * t, 0.0};
    k.v_map = {0.0, cut_.speed, 0.0};
    k.R_map_body = Eigen::AngleAxisd(0.5 * kPi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return k;
  }
  double duration() const override { return cut_.duration; }
  double travelled(double t) const override { return cut_.speed * t; }
  const std::vector<double>& breaks() const override { return breaks_; }

 private:
  Cut cut_;
  std::vector<double> breaks_ = {};
};

/// The scanner of the scenarios: 0 to 180 degrees by 0.25, 10 mm and 0.02 degrees of noise.
inline sim::LegConfig scanner(double sigma_range = 0.010, double sigma_angle = 3.5e-4) {
  sim::LegConfig config;
  config.model = sim::LegModel::Legs;
  config.scanner.range_max = 15.0;
  config.scanner.sigma_range = sigma_range;
  config.scanner.sigma_angle = sigma_angle;
  return config;
}

inline std::vector<Scan2D> sweeps(const sim::LegConfig& config, const sim::LegPlacer& leg, const Cut& cut,
                                  std::uint64_t seed = 1) {
  sim::LegStream stream(config, leg, std::make_shared<CutMotion>(cut), {.seed = seed});
  std::vector<Scan2D> all;
  while (const auto delivery = stream.next()) all.push_back(std::get<Scan2D>(delivery->measurement.reading));
  return all;
}

/// Sweeps of the plain row, supports 4 m to the left.
inline std::vector<Scan2D> rowSweeps(const sim::LegConfig& config, const Cut& cut, std::uint64_t seed = 1) {
  return sweeps(config, sim::straightRow(config.row, 4.0, 1.0, {}), cut, seed);
}

/// Where the leg of `support` is in the l frame of a scanner at station `y` on x = 0.
inline Eigen::Vector2d legAt(int support, double y, const sim::SupportRow& row = {}) {
  return {row.station_first + support * row.spacing - y, 4.0};
}

/// Points on the near side of a round leg, one every `step` rad of the beams; noise along the beams.
inline std::vector<Eigen::Vector2d> arc(const sim::LegCylinder& leg, double first, double step, double sigma,
                                        RandomStream& random) {
  const sim::LegSlice slice(leg);
  const double bearing = std::atan2(leg.point.y(), leg.point.x());
  std::vector<Eigen::Vector2d> points;
  for (double angle = bearing - 0.3 + first; angle < bearing + 0.3; angle += step) {
    const double noise = sigma * random.normal();
    const Eigen::Vector2d look(std::cos(angle), std::sin(angle));
    if (const auto range = slice.beamRange(look)) points.push_back((*range + noise) * look);
  }
  return points;
}

}  // namespace pos::lidar::scene
