// The verbs around a replay: what one writes, another reads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "replay/figures.hpp"

namespace pos::replay {
namespace {

using ::testing::HasSubstr;

class Verbs : public ::testing::Test {
 protected:
  void SetUp() override {
    if (datasets().empty()) GTEST_SKIP() << "install mrpt-common to run this test: its logs are not there";
  }

  RunResult expectOk(const std::vector<std::string>& arguments) const {
    RunResult run = bench_.pos(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run;
  }

  const std::string config_ = source("configs/uwb_demo/compare.yaml").string();
  Bench bench_;
};

}  // namespace

TEST_F(Verbs, EvaluateReproducesTheFiguresOfReplayFromItsFiles) {
  expectOk({"replay", config_, "--out", "first"});
  const std::string truth = "first/mcl_scan.tum";  // any trajectory of that time serves as the reference here
  const json replayed =
      json::parse(expectOk({"replay", config_, "--truth", truth, "--out", "second", "--json"}).out);
  for (const std::string file : {"second/range_odometry.tum", "second/range_odometry.csv"}) {
    const json judged =
        json::parse(expectOk({"evaluate", file, "--truth", truth, "--max-gap-s", "3", "--json"}).out);
    for (const char* figure : {"errors.xy.rmse", "errors.xy.p95", "errors.along.rmse", "errors.yaw.rmse"}) {
      const std::string path = std::string("estimators.range_odometry.") + figure;
      EXPECT_NEAR(at(judged, path), at(replayed, path), 1e-7) << file << " " << figure;
    }
  }
}

TEST_F(Verbs, ReportIsMadeAgainFromTheRunFolderAlone) {
  expectOk({"replay", config_, "--out", "run"});
  const std::string before = bench_.read("run/report.html");
  std::filesystem::remove(bench_.folder() / "run/report.html");
  expectOk({"report", "run"});
  EXPECT_GT(bench_.read("run/report.html").size(), before.size() / 2);
  EXPECT_THAT(bench_.read("run/report.html"), HasSubstr("range_odometry"));
}

TEST_F(Verbs, InfoExplainsEveryLogOfMrptCommon) {
  std::vector<std::string> arguments{"info"};
  for (const auto& entry : std::filesystem::recursive_directory_iterator(datasets())) {
    if (entry.path().extension() == ".rawlog") arguments.push_back(entry.path().string());
  }
  ASSERT_GE(arguments.size(), 10U);
  const RunResult run = expectOk(arguments);
  for (std::size_t i = 1; i < arguments.size(); ++i) EXPECT_THAT(run.out, HasSubstr(arguments[i]));
}

TEST_F(Verbs, AConvertedLogReplaysToTheSameFigures) {
  const std::string log = (datasets() / "uwb_ro-localization_demo.rawlog").string();
  expectOk({"convert", "log", log, "--out", "copy.rawlog", "-q"});
  expectOk({"replay", config_, "--out", "original"});
  // The copy has no action/observation pairs, so its truth is the original run's trajectory.
  expectOk({"replay", config_, "--log", "copy.rawlog", "--truth", "original/mcl_scan.tum", "--out", "copy"});
  const json again = json::parse(expectOk({"evaluate", "copy/range_odometry.tum", "--truth",
                                           "original/range_odometry.tum", "--max-gap-s", "3", "--json"})
                                     .out);
  EXPECT_LT(at(again, "estimators.range_odometry.errors.xy.rmse"), 1e-4);
}

TEST_F(Verbs, MapAndConfigurationConversionsWork) {
  const std::string map = source("maps/uwb_demo/map.yaml").string();
  expectOk({"convert", "map", map, "--out", "room.beaconmap"});
  expectOk({"convert", "map", map, "--out", "room.gridmap.gz"});
  EXPECT_NE(bench_.read("room.beaconmap"), "");
  EXPECT_NE(bench_.read("room.gridmap.gz"), "");
  expectOk({"config", "init", "--out", "mine.yaml"});
  const RunResult again = bench_.pos({"config", "init", "--out", "mine.yaml"});
  EXPECT_NE(again.exit_code, 0);
  EXPECT_THAT(again.err, HasSubstr("--force"));
  expectOk({"config", "check", "mine.yaml", "--keys-only"});
  EXPECT_FALSE(json::parse(expectOk({"config", "schema"}).out).empty());
  expectOk({"config", "check", config_});
  EXPECT_THAT(expectOk({"version"}).out, HasSubstr("pos "));
}

}  // namespace pos::replay
