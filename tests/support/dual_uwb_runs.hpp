#pragma once
/// The two drives of Yuan et al. 2022 (spec A, sections 3.1 and 3.2) by formula, and what two tags, a gyro
/// and the wheels measure on them. Noise from explicit seeds.

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "pos/core/measurement.hpp"
#include "pos/core/random.hpp"
#include "pos/estimation/configs.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::testing {

/// A drive along straights and arcs; every piece is integrated in closed form.
class ArcDrive {
 public:
  struct Piece {
    double duration = 0.0;
    double acceleration = 0.0;  ///< m/s^2, on straights only
    double yaw_rate = 0.0;      ///< rad/s, at constant speed only
  };
  struct State {
    Pose2 pose;
    double speed = 0.0;
    double yaw_rate = 0.0;
  };

  explicit ArcDrive(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {}

  double duration() const {
    double total = 0.0;
    for (const Piece& piece : pieces_) total += piece.duration;
    return total;
  }

  State at(double t) const {
    State state;
    for (const Piece& piece : pieces_) {
      const double dt = std::clamp(t, 0.0, piece.duration);
      const double way = state.speed * dt + 0.5 * piece.acceleration * dt * dt;
      const double turn = piece.yaw_rate * dt;
      const double chord = std::abs(turn) < 1e-9 ? 1.0 : std::sin(0.5 * turn) / (0.5 * turn);
      state.pose.x += way * chord * std::cos(state.pose.yaw + 0.5 * turn);
      state.pose.y += way * chord * std::sin(state.pose.yaw + 0.5 * turn);
      state.pose.yaw = wrapAngle(state.pose.yaw + turn);
      state.speed += piece.acceleration * dt;
      state.yaw_rate = piece.yaw_rate;
      if (t <= piece.duration) return state;
      t -= piece.duration;
    }
    state.yaw_rate = 0.0;
    return state;
  }

 private:
  std::vector<Piece> pieces_;
};

struct DualUwbSite {
  std::vector<map::Anchor> anchors;
  std::vector<Eigen::Vector2d> roadway;  ///< corners
};

/// Both ends of the line lie in the L-shaped roadway, and so does the line: nothing of it in the rock of A2.
inline bool clearOfCornerRock(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  for (int k = 1; k < 400; ++k) {
    const Eigen::Vector2d p = a + (b - a) * (k / 400.0);
    if (p.x() < 6.0 - 1e-9 && p.y() < -4.0 - 1e-9) return false;
  }
  return true;
}

inline DualUwbSite doubleLaneSite() {
  return {{{1, "UWB_1", {0, 4, 0}},
           {2, "UWB_2", {29, 4, 0}},
           {3, "UWB_3", {29, -4, 0}},
           {4, "UWB_4", {0, -4, 0}}},
          {{-2, 4}, {31, 4}, {31, -4}, {-2, -4}}};
}
inline ArcDrive doubleLaneDrive() {
  constexpr double r2 = 0.98626;
  return ArcDrive({{5, 0, 0},
                   {1, 1, 0},
                   {2, 0, 0},
                   {2, 0, -0.2},
                   {2, 0, 0},
                   {2, 0, 0.2},
                   {5, 0, 0},
                   {r2, 0, 0.4 / r2},
                   {5.0 - 2.0 * r2, 0, 0},
                   {r2, 0, -0.4 / r2},
                   {6, 0, 0}});
}

inline DualUwbSite quarterTurnSite() {
  return {{{1, "UWB_1", {0, 4, 0}},
           {2, "UWB_2", {14, 4, 0}},
           {3, "UWB_3", {14, -15, 0}},
           {4, "UWB_4", {6, -15, 0}},
           {5, "UWB_5", {6, -4, 0}},
           {6, "UWB_6", {0, -4, 0}}},
          {{-2, 4}, {14, 4}, {14, -16}, {6, -16}, {6, -4}, {-2, -4}}};
}
inline ArcDrive quarterTurnDrive() {
  constexpr double v = 0.3 * kPi;
  constexpr double ramp = 1.14554;
  return ArcDrive({{12, 0, 0}, {ramp, v / ramp, 0}, {8.0 - ramp, 0, 0}, {5, 0, -kPi / 10}, {10, 0, 0}});
}

struct DualUwbRunOptions {
  std::uint64_t seed = 1;
  double range_sigma = 0.05;  ///< m
  double rate = 10.0;         ///< Hz, per link
  double tag_offset = 0.0;    ///< s, the second tag ranges this much later
  bool stamps_tell = true;    ///< the second tag's stamps tell so
  double gyro_rate = 0.0;     ///< Hz, 0 = none
  double gyro_noise = 0.0;    ///< rad/s, of each sample
  double gyro_bias = 0.0;     ///< rad/s
  double wheel_rate = 0.0;    ///< Hz, 0 = none
  double wheel_sigma = 0.02;  ///< m/s
  bool corner_rock = false;   ///< rock hides anchors (A2)
  Eigen::Vector3d left{0.0, 0.375, 0.0};
  Eigen::Vector3d right{0.0, -0.375, 0.0};
  /// Changes a range, or drops it by returning a negative one: (t, tag, anchor, range).
  std::function<double(double, int, AnchorId, double)> fault = {};
};

inline Stamp dualStamp(double t) {
  return stampFromSeconds(2000.0 + t);
}

inline std::vector<Measurement> dualUwbRun(const DualUwbSite& site, const ArcDrive& drive,
                                           const DualUwbRunOptions& options) {
  RandomStream random(options.seed, 11);
  std::vector<Measurement> log;
  const double duration = drive.duration();
  const int epochs = static_cast<int>(duration * options.rate);
  for (int k = 0; k <= epochs; ++k) {
    for (int tag = 0; tag < 2; ++tag) {
      const double t = k / options.rate + (tag == 1 ? options.tag_offset : 0.0);
      const Eigen::Vector3d mount = tag == 0 ? options.left : options.right;
      const Eigen::Vector2d p = drive.at(t).pose * Eigen::Vector2d(mount.head<2>());
      for (const map::Anchor& anchor : site.anchors) {
        const Eigen::Vector2d a = anchor.p_map.head<2>();
        const double noise = random.normal(0.0, options.range_sigma);
        if (options.corner_rock && !clearOfCornerRock(a, p)) continue;
        double range = std::hypot((p - a).norm(), anchor.p_map.z() - mount.z()) + noise;
        if (options.fault) range = options.fault(t, tag, anchor.id, range);
        if (range < 0.0) continue;
        BeaconRange reading;
        reading.tag = tag;
        reading.anchor = anchor.id;
        reading.range = range;
        reading.tag_body = mount;
        log.push_back({dualStamp(options.stamps_tell ? t : k / options.rate), "uwb", reading});
      }
    }
  }
  for (int k = 0; options.gyro_rate > 0.0 && k <= static_cast<int>(duration * options.gyro_rate); ++k) {
    const double t = k / options.gyro_rate;
    ImuSample imu;
    imu.angular.z() = drive.at(t).yaw_rate + options.gyro_bias + random.normal(0.0, options.gyro_noise);
    log.push_back({dualStamp(t), "imu", imu});
  }
  for (int k = 0; options.wheel_rate > 0.0 && k <= static_cast<int>(duration * options.wheel_rate); ++k) {
    const double t = k / options.wheel_rate;
    const double speed = drive.at(t).speed + random.normal(0.0, options.wheel_sigma);
    log.push_back({dualStamp(t), "wheels", WheelSpeeds{speed, speed, {}}});
  }
  std::stable_sort(log.begin(), log.end(),
                   [](const Measurement& a, const Measurement& b) { return a.stamp < b.stamp; });
  return log;
}

inline std::shared_ptr<const map::TunnelMap> dualUwbMap(const DualUwbSite& site) {
  auto map = std::make_shared<map::TunnelMap>();
  map->name = "site";
  map->anchors = site.anchors;
  return map;
}

/// The filter as spec 2.6 and 2.7 have it: started at rest from the ranges, noise as simulated.
inline estimation::DualUwbConfig dualUwbConfig(const DualUwbRunOptions& options) {
  estimation::DualUwbConfig config;
  config.range_sigma = options.range_sigma;
  config.tags = {{0, options.left}, {1, options.right}};
  config.still_at_start = 2.0;
  config.max_speed = 2.0;
  return config;
}

/// Errors of an estimator along a run, asked after every epoch of ranges.
struct DualUwbScore {
  double x = 0.0;            ///< m, rms
  double y = 0.0;            ///< m, rms
  double yaw = 0.0;          ///< rad, rms
  double yaw_turning = 0.0;  ///< rad, rms while the vehicle turns
  double x_max = 0.0;
  double y_max = 0.0;
  double yaw_max = 0.0;
  double nees = 0.0;   ///< mean, 3 dof
  double speed = 0.0;  ///< m/s, rms
  double rate = 0.0;   ///< rad/s, rms
  int answers = 0;
};

}  // namespace pos::testing
