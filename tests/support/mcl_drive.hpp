#pragma once
/// A simulated drive past four anchors, for the particle filter's tests.

#include <gtest/gtest.h>

#include "pos/estimation/mcl.hpp"
#include "support/mcl_scene.hpp"

namespace pos::estimation::scene {

inline const Pose2 kStart{5.0, 2.0, 0.3};
inline const Pose2 kStep{0.4, 0.0, 0.05};
inline constexpr double kPeriod = 0.5;

inline MclConfig rangeConfig() {
  MclConfig config;
  config.start = {.mode = StartMode::Known, .pose = kStart, .position_sigma = 0.5, .yaw_sigma = 0.2};
  config.range = {.sigma = 0.15, .outlier_probability = 0.05, .range_max = 40.0, .correlation_length = 0.0};
  config.particles = {.min = 1500, .max = 5000};
  return config;
}

struct Sim {
  std::shared_ptr<const map::TunnelMap> map = scene::anchors();
  Pose2 truth = kStart;
  Stamp stamp = stampFromSeconds(100.0);
  OdometryNoise noise;
  double range_sigma = 0.15;
  RandomStream random{1, 77};

  explicit Sim(std::uint64_t seed) : random(seed, 77) {}

  Measurement move() {
    truth = truth * kStep;
    stamp += durationFromSeconds(kPeriod);
    return {stamp, "odometry", noisyOdometry(kStep, noise, kPeriod, random)};
  }
  Measurement range(std::size_t anchor, double error) const {
    return {stamp, "uwb", rangeTo(map->anchors[anchor], truth, error)};
  }
  std::vector<Measurement> ranges() {
    std::vector<Measurement> all;
    for (std::size_t a = 0; a < map->anchors.size(); ++a)
      all.push_back(range(a, random.normal(0.0, range_sigma)));
    return all;
  }
};

inline void feed(Mcl& mcl, const Measurement& measurement) {
  EXPECT_NE(mcl.ingest(measurement).verdict, Verdict::Degenerate);
}

inline void drive(Mcl& mcl, Sim& sim, int steps) {
  for (int k = 0; k < steps; ++k) {
    feed(mcl, sim.move());
    for (const Measurement& range : sim.ranges()) feed(mcl, range);
  }
}

inline Pose2 meanOf(const Mcl& mcl, Stamp stamp) {
  return mcl.estimateAt(stamp)->T_map_body.planar();
}

inline Belief<Pose2> belief(const Pose2& mean, double position, double yaw) {
  return {mean, Vector<3>(position * position, position * position, yaw * yaw).asDiagonal()};
}

}  // namespace pos::estimation::scene
