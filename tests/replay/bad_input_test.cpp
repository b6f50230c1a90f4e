// What a user sees when an input is wrong: one short message with place and remedy, and the documented exit
// code.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "replay/figures.hpp"

namespace pos::replay {
namespace {

using ::testing::HasSubstr;

class BadInput : public ::testing::Test {
 protected:
  void SetUp() override {
    if (datasets().empty())
      GTEST_SKIP() << "install mrpt-common to run this test: its UWB demo log is not there";
  }

  RunResult expectRefusal(std::vector<std::string> arguments, int exit_code, const std::string& words) const {
    const RunResult run = bench_.pos(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_THAT(run.err, HasSubstr("error: "));
    EXPECT_THAT(run.err, HasSubstr(words));
    EXPECT_LE(run.errLines(), 25);
    return run;
  }

  const std::string config_ = source("configs/uwb_demo/unknown_heading.yaml").string();
  Bench bench_;
};

TEST_F(BadInput, ACutLogGivesTheResultsBeforeTheDamage) {
  const std::string log = contents(datasets() / "uwb_ro-localization_demo.rawlog");
  bench_.write("half.rawlog", log.substr(0, log.size() / 2));
  expectRefusal({"replay", config_, "--log", "half.rawlog", "--out", "run"}, 5, "the log is damaged");
  const json summary = json::parse(bench_.read("run/summary.json"));
  EXPECT_TRUE(summary.at("run").at("log_end").at("damaged").get<bool>());
  EXPECT_GT(at(summary, "estimators.range_odometry.estimates"), 100.0);
  EXPECT_THAT(bench_.read("run/events.csv"), HasSubstr("log_damaged"));
}

TEST_F(BadInput, AFileThatIsNoLogIsNamed) {
  bench_.write("empty.rawlog", "");
  bench_.write("text.rawlog", "this is a text\n");
  expectRefusal({"replay", config_, "--log", "empty.rawlog"}, 5, "the rawlog is empty");
  expectRefusal({"replay", config_, "--log", "text.rawlog"}, 5, "no MRPT rawlog");
  expectRefusal({"replay", config_, "--log", "missing.rawlog"}, 5, "does not exist");
  expectRefusal({"replay", config_, "--truth", "missing.tum"}, 5, "does not exist");
}

TEST_F(BadInput, FlippedBytesGiveTheResultsBeforeTheDamage) {
  std::string log = contents(datasets() / "uwb_ro-localization_demo.rawlog");
  for (std::size_t i = log.size() / 2; i < log.size() / 2 + 64; ++i) log[i] = static_cast<char>(~log[i]);
  bench_.write("flipped.rawlog", log);
  expectRefusal({"replay", config_, "--log", "flipped.rawlog", "--out", "run"}, 5, "the log is damaged");
  EXPECT_GT(bench_.read("run/range_odometry.tum").size(), 1000U);
}

TEST_F(BadInput, ConfigurationAndMapAreToldByLineAndKey) {
  const std::string good = contents(config_);
  bench_.write("twice.yaml", good + "\nname: again\n");
  expectRefusal({"config", "check", "twice.yaml", "--keys-only"}, 3, "twice.yaml:");
  std::string typed = good;
  typed.replace(typed.find("type: range_odometry"), 20, "type: range_odometer");
  bench_.write("typed.yaml", typed);
  expectRefusal({"config", "check", "typed.yaml", "--keys-only"}, 3, "range_odometry");
  bench_.write("map.yaml",
               "schema: 1\nname: two\nanchors:\n  - {id: 4, name: A, x_m: 0, y_m: 0, z_m: 0}\n"
               "  - {id: 4, name: B, x_m: 1, y_m: 0, z_m: 0}\n");
  expectRefusal({"replay", config_, "--map", "map.yaml"}, 3, "map.yaml:5");
}

TEST_F(BadInput, AWrongKeyOrFileOfTheConfigurationIsNamed) {
  expectRefusal({"replay", config_, "--map", "missing.yaml"}, 3, "--map: the file does not exist");
  const std::string key = "estimators.range_odometry.";
  expectRefusal({"replay", config_, "--set", key + "range_sigm_m=1"}, 3, "did you mean range_sigma_m?");
  expectRefusal({"replay", config_, "--set", key + "range_sigma_cm=1"}, 3, "use range_sigma_m");
  expectRefusal({"replay", config_, "--set", key + "range_sigma_m=-1"}, 3, "too small");
}

TEST_F(BadInput, AWrongCommandLineIsUsageWithAHint) {
  expectRefusal({}, 2, "pos needs a verb");
  expectRefusal({"replya"}, 2, "did you mean replay?");
  expectRefusal({"replay", config_, "--jsn"}, 2, "did you mean --json?");
  expectRefusal({"replay", config_, "--seed", "-1"}, 2, "whole number");
  expectRefusal({"replay", config_, "--require", "p95_xyz<1"}, 2, "did you mean p95_xy?");
}

TEST_F(BadInput, AMissedRequirementAndAForeignTruthAreToldAfterTheRun) {
  expectRefusal({"replay", config_, "--require", "p95_xy<0.01"}, 4, "1 of 1 required limits missed");
  bench_.write("truth.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
  expectRefusal({"replay", config_, "--truth", "truth.tum", "--out", "run"}, 5, "no moment in common");
  EXPECT_NE(bench_.read("run/range_odometry.tum"), "");
  expectRefusal({"replay", config_, "--out", "run"}, 3, "--force");
}

TEST_F(BadInput, TheSameCommandGivesTheSameBytesAndAnotherSeedOthers) {
  const std::string config = source("configs/uwb_demo/compare.yaml").string();
  for (const char* out : {"a", "b"}) EXPECT_EQ(bench_.pos({"replay", config, "--out", out}).exit_code, 0);
  EXPECT_EQ(bench_.pos({"replay", config, "--out", "c", "--set", "seed=2"}).exit_code, 0);
  for (const char* file :
       {"/mcl_ranges.tum", "/mcl_ranges.csv", "/range_odometry.csv", "/mcl_scan.tum", "/events.csv"}) {
    EXPECT_EQ(bench_.read(std::string("a") + file), bench_.read(std::string("b") + file)) << file;
    EXPECT_NE(bench_.read(std::string("a") + file), "") << file;
  }
  EXPECT_NE(bench_.read("a/mcl_ranges.tum"), bench_.read("c/mcl_ranges.tum"));
}

TEST(ConfigDoc, EqualsTheReferenceInTheDocuments) {
  const Bench bench;
  EXPECT_EQ(bench.pos({"config", "doc"}).out, contents(source("docs/reference/configuration.md")))
      << "run: pos config doc --out docs/reference/configuration.md";
}

}  // namespace
}  // namespace pos::replay
