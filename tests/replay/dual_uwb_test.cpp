// The experiments of `dual_uwb`: the scenarios with one seed each, and the recording with two tags,
// uncalibrated and calibrated.
#include <gtest/gtest.h>

#include "replay/figures.hpp"

namespace pos::replay {
namespace {

class DualUwbScenario : public ::testing::TestWithParam<const char*> {
 protected:
  Bench bench_;
};

TEST_P(DualUwbScenario, KeepsItsFigures) {
  const std::string run = std::string("experiments/dual_uwb/") + GetParam();
  expectFigures(run, {replayed(bench_, {source("configs/" + run + ".yaml").string()})});
}

INSTANTIATE_TEST_SUITE_P(Experiments, DualUwbScenario,
                         ::testing::Values("double_lane", "double_lane_ideal", "quarter_turn",
                                           "quarter_turn_ideal", "nlos_episode", "anchor_dropout",
                                           "collinear_anchors", "tag_time_offset", "unequal_levers",
                                           "stationary"),
                         [](const auto& named) { return std::string(named.param); });

class DualUwbRecording : public ::testing::Test {
 protected:
  void SetUp() override {
    if (recordings().empty()) GTEST_SKIP() << "set POS_DATA_DIR to a folder that holds lias_fast as CSV";
    expectOk({"convert", "csv", source("configs/import/lias.yaml").string(), "--data",
              (recordings() / "lias_fast").string(), "--out", "lias"});
  }
  void expectOk(const std::vector<std::string>& arguments) const {
    const RunResult run = bench_.pos(arguments);
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  std::vector<std::string> withLog(std::vector<std::string> arguments) const {
    for (const char* more :
         {"--log", "lias/log.rawlog", "--map", "lias/map.yaml", "--truth", "lias/truth.tum"})
      arguments.emplace_back(more);
    return arguments;
  }
  Bench bench_;
};

TEST_F(DualUwbRecording, KeepsItsFiguresWithoutAnyTruth) {
  const std::string run = "experiments/dual_uwb/real_tags";
  expectFigures(run, {replayed(bench_, withLog({source("configs/" + run + ".yaml").string()}))});
}

TEST_F(DualUwbRecording, KeepsItsFiguresCalibratedAtTheFirstFifteenSeconds) {
  expectOk(withLog({"calibrate", "ranges", source("configs/experiments/dual_uwb/real_tags.yaml").string(),
                    "--first-s", "15", "--out", "biases.yaml"}));
  const std::string run = "experiments/dual_uwb/real_tags_calibrated";
  std::vector<std::string> arguments = withLog({source("configs/" + run + ".yaml").string()});
  for (const char* estimator : {"rigid", "rigid_three_tags", "filter", "filter_bias_states"}) {
    arguments.insert(arguments.end(),
                     {"--set", std::string("estimators.") + estimator +
                                   ".range_bias_table=" + (bench_.folder() / "biases.yaml").string()});
  }
  expectFigures(run, {replayed(bench_, arguments)});
}

}  // namespace
}  // namespace pos::replay
