/// Honesty of the interacting models (section C3, property 5 of the specification): in a world where only one
/// of the two sensors speaks, and is as good as the filter is told, the combination claims what is true.
#include <gtest/gtest.h>

#include <cstdio>

#include "pos/core/chi_square.hpp"
#include "pos/core/square.hpp"
#include "pos/estimation/seamless_core.hpp"
#include "support/circle_run.hpp"
#include "support/honest_world.hpp"

namespace pos::estimation {
namespace {

enum class World { RadioOnly, SatellitesOnly };

constexpr double kRangeSigma = 0.1;
constexpr double kFixSigma = 0.3;
const Eigen::Vector3d kLever(0.6, 0.0, 0.4);

SeamlessConfig configOf(const ins::EskfProcess& process) {
  SeamlessConfig config;
  config.variant = SeamlessConfig::Variant::Imm;
  config.imu.gyro_density = process.gyro_density;
  config.imu.accelerometer_density = process.accelerometer_density;
  config.imu.gyro_bias_walk = process.gyro_bias_walk;
  config.imu.accelerometer_bias_walk = process.accelerometer_bias_walk;
  config.standstill.gravity = process.gravity;
  config.gnss.surprise = GnssUse::Surprise::Believe;
  config.uwb.sigma = kRangeSigma;
  config.uwb.robust.form = filters::RobustConfig::Form::None;
  return config;
}

struct Honesty {
  std::vector<double> nees;  // every 2 s
  std::vector<double> nees_position;
};

Honesty honestRun(World which, std::uint64_t seed) {
  testing::HonestWorld world(seed);
  SeamlessCore core(configOf(world.process()));
  const auto stamp = [](int k) { return stampFromSeconds(1000.0) + durationFromSeconds(0.01 * k); };
  core.start(stamp(0), world.start());
  const auto map = testing::circleMap();
  Honesty told;
  for (int k = 1; k <= 1000; ++k) {
    (void)core.propagate(world.moved(), stamp(k));
    if (k % 10 != 0) continue;
    const EskfState& truth = world.truth();
    if (which != World::SatellitesOnly) {
      for (const map::Anchor& anchor : map->anchors) {
        const double range = seenRange(truth, kLever, anchor.p_map, 0.0).distance;
        (void)core.take({kLever, anchor.p_map, anchor.id, range + kRangeSigma * world.normal()}, 0.0);
      }
    }
    if (which != World::RadioOnly) {
      const Eigen::Vector3d antenna = truth.p_map + truth.q_map_body * kLever + kFixSigma * world.normal3();
      (void)core.take(antenna, square(kFixSigma) * Matrix<3, 3>::Identity(), kLever);
    }
    if (k % 200 != 0) continue;
    const Belief<EskfState> belief = core.closed().combined();
    told.nees.push_back(world.nees(belief));
    told.nees_position.push_back(world.neesOfPosition(belief));
  }
  return told;
}

class SingleMode : public ::testing::TestWithParam<World> {};

TEST_P(SingleMode, IsHonestInAllFifteenStates) {
  constexpr int kRuns = 200;
  std::vector<double> nees(5, 0.0);
  std::vector<double> position(5, 0.0);
  for (int run = 0; run < kRuns; ++run) {
    const Honesty told = honestRun(GetParam(), static_cast<std::uint64_t>(run + 1));
    for (std::size_t i = 0; i < nees.size(); ++i) {
      nees[i] += told.nees[i] / kRuns;
      position[i] += told.nees_position[i] / kRuns;
    }
  }
  // Five moments are looked at, each twice: one in a thousand each.
  const Interval all = meanChiSquareBounds(0.999, 15.0, kRuns);
  const Interval three = meanChiSquareBounds(0.999, 3.0, kRuns);
  for (std::size_t i = 0; i < nees.size(); ++i) {
    EXPECT_GT(nees[i], all.low) << i;
    EXPECT_LT(nees[i], all.high) << i;
    EXPECT_GT(position[i], three.low) << i;
    EXPECT_LT(position[i], three.high) << i;
  }
  std::printf(
      "NEES of 15 states %.2f %.2f %.2f %.2f %.2f (%.2f to %.2f), of the position %.2f %.2f %.2f %.2f %.2f\n",
      nees[0], nees[1], nees[2], nees[3], nees[4], all.low, all.high, position[0], position[1], position[2],
      position[3], position[4]);
}

INSTANTIATE_TEST_SUITE_P(SeamlessStatistics, SingleMode,
                         ::testing::Values(World::RadioOnly, World::SatellitesOnly),
                         [](const auto& instance) {
                           return instance.param == World::RadioOnly ? "Radio" : "Satellites";
                         });

}  // namespace
}  // namespace pos::estimation
