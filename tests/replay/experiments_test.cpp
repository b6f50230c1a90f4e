// Configurations that simulate their input, judged like the recordings.
#include <gtest/gtest.h>

#include "replay/figures.hpp"

namespace pos::replay {
namespace {

class SimulatedRuns : public ::testing::TestWithParam<const char*> {
 protected:
  Bench bench_;
};

TEST_P(SimulatedRuns, KeepsItsFigures) {
  const std::string run = GetParam();
  expectFigures(run, {replayed(bench_, {source("configs/" + run + ".yaml").string()})});
}

INSTANTIATE_TEST_SUITE_P(
    Configs, SimulatedRuns,
    ::testing::Values("simulation/circle", "uwb_demo/campaign", "experiments/double_lane_baseline",
                      "experiments/encoders_sins/slip", "experiments/encoders_sins/heading",
                      "experiments/encoders_sins/loop", "experiments/encoders_sins/lockout",
                      "experiments/encoders_sins/vehicle_scale", "experiments/encoders_sins/dual_tag_start",
                      "experiments/encoders_sins/real_odometry", "experiments/seamless/circle_nlos",
                      "experiments/seamless/circle_los", "experiments/shearer/clip", "uwb_imu/uwb_demo"),
    [](const auto& named) {
      std::string name = named.param;
      for (char& c : name) c = c == '/' ? '_' : c;
      return name;
    });

/// Hours of simulation, of which the first minutes are enough to see that they run.
class LongRuns : public ::testing::TestWithParam<const char*> {
 protected:
  Bench bench_;
};

TEST_P(LongRuns, BeginAsTheyShould) {
  const std::string run = std::string("experiments/shearer/") + GetParam();
  expectFigures(
      run,
      {replayed(bench_, {source("configs/" + run + ".yaml").string(), "--set", "scenario.duration_s=120"})});
}

INSTANTIATE_TEST_SUITE_P(Shearer, LongRuns,
                         ::testing::Values("modes", "features", "distance", "picm", "bend_creep", "yaw_prior",
                                           "legs"),
                         [](const auto& named) { return std::string(named.param); });

}  // namespace
}  // namespace pos::replay
