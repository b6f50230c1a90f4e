// A scenario through the command: files, seeds, faults, and a replay with and without the log between.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "replay/figures.hpp"

namespace pos::replay {
namespace {

using ::testing::HasSubstr;

class Simulate : public ::testing::Test {
 protected:
  RunResult expectOk(const std::vector<std::string>& arguments) const {
    RunResult run = bench_.pos(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run;
  }
  void expectRefusal(const std::vector<std::string>& arguments, int code, const std::string& told) const {
    const RunResult run = bench_.pos(arguments);
    EXPECT_EQ(run.exit_code, code) << run.err;
    EXPECT_THAT(run.err, HasSubstr(told));
  }

  const std::string lane_ = source("configs/scenarios/a1_double_lane_shift.yaml").string();
  const std::string circle_ = source("configs/scenarios/circle_nlos.yaml").string();
  const std::string config_ = source("configs/simulation/circle.yaml").string();
  Bench bench_;
};

}  // namespace

TEST_F(Simulate, LeavesALogThatInfoExplainsWithTruthMapAndRecordOfTheRun) {
  const json made = json::parse(expectOk({"simulate", lane_, "--out", "lane", "--json"}).out);
  const json info = json::parse(expectOk({"info", "lane/log.rawlog", "--json"}).out);
  EXPECT_EQ(info.at("measurements"), made.at("measurements"));
  std::set<std::string> kinds;
  for (const json& sensor : info.at("sensors")) kinds.insert(sensor.at("kind").get<std::string>());
  EXPECT_EQ(kinds, (std::set<std::string>{"imu", "range", "wheel_ticks"})) << "and no truth among them";
  EXPECT_TRUE(info.at("refused").empty());
  EXPECT_EQ(bench_.read("lane/map.yaml"), contents(source("maps/double_lane_shift/map.yaml")));
  const std::string truth = bench_.read("lane/truth.tum");
  EXPECT_EQ(std::count(truth.begin(), truth.end(), '\n'), 602)
      << "a head line, and 30 s at 20 Hz with both ends";
  const json run = json::parse(bench_.read("lane/run.json"));
  EXPECT_EQ(run.at("seed"), 1);
  EXPECT_THAT(run.at("scenario").get<std::string>(), HasSubstr("double_lane_shift"));
}

TEST_F(Simulate, TheSameSeedGivesTheSameBytesAndAnotherSeedOthers) {
  const std::vector<std::string> head{"simulate", lane_, "--set", "duration_s=12", "-q"};
  const auto with = [&](const std::string& out, const std::string& seed) {
    std::vector<std::string> arguments = head;
    arguments.insert(arguments.end(), {"--out", out, "--seed", seed});
    expectOk(arguments);
  };
  with("a", "3");
  with("b", "3");
  with("c", "4");
  EXPECT_NE(bench_.read("a/log.rawlog"), "");
  for (const char* file : {"/log.rawlog", "/truth.tum", "/map.yaml", "/run.json"}) {
    EXPECT_EQ(bench_.read(std::string("a") + file), bench_.read(std::string("b") + file)) << file;
  }
  EXPECT_NE(bench_.read("a/log.rawlog"), bench_.read("c/log.rawlog"));
  EXPECT_EQ(bench_.read("a/truth.tum"), bench_.read("c/truth.tum")) << "the truth has no chance in it";
}

TEST_F(Simulate, AReplayNeedsNoLogBetween) {
  const json direct = json::parse(expectOk({"replay", config_, "--seed", "5", "--json"}).out);
  expectOk({"simulate", circle_, "--seed", "5", "--out", "circle", "-q"});
  const json by_log =
      json::parse(expectOk({"replay", config_, "--seed", "5", "--log", "circle/log.rawlog", "--map",
                            "circle/map.yaml", "--truth", "circle/truth.tum", "--json"})
                      .out);
  const std::string figure = "estimators.strict.errors.xy.rmse";
  EXPECT_GT(at(direct, figure), 0.01);
  EXPECT_NEAR(at(direct, figure), at(by_log, figure), 1e-4) << "stamps to 100 ns, ranges to single precision";
  const json other = json::parse(expectOk({"replay", config_, "--seed", "6", "--json"}).out);
  EXPECT_NE(at(direct, figure), at(other, figure)) << "the run's seed is the simulation's";
}

TEST_F(Simulate, TheCircleKeepsItsFigures) {
  expectFigures("simulation/circle", {replayed(bench_, {config_})});
}

TEST_F(Simulate, AReportIsMadeAgainFromTheScenario) {
  expectOk({"replay", config_, "--set", "scenario.duration_s=20", "--out", "run", "-q"});
  const json run = json::parse(bench_.read("run/run.json"));
  EXPECT_EQ(run.at("inputs").at(0).at("role"), "scenario");
  std::filesystem::remove(bench_.folder() / "run/report.html");
  expectOk({"report", "run"});
  EXPECT_THAT(bench_.read("run/report.html"), HasSubstr("strict"));
}

TEST_F(Simulate, SchemasAreOneDocumentEach) {
  for (const char* kind : {"map", "scenario"}) {
    const json schema = json::parse(expectOk({"config", "schema", kind}).out);
    EXPECT_TRUE(schema.contains("properties")) << kind;
  }
}

TEST_F(Simulate, WhatIsWrongIsToldByPlaceAndKey) {
  expectRefusal({"simulate", lane_}, 2, "--out");
  expectRefusal({"simulate", "nothing.yaml", "--out", "x"}, 3, "nothing.yaml");
  expectRefusal({"simulate", lane_, "--set", "sensors.uwb.sigma_cm=1", "--out", "x"}, 3, "use sigma_m");
  expectRefusal({"simulate", lane_, "--set", "map=missing.yaml", "--out", "x"}, 3, "missing.yaml");
  bench_.write("bad.yaml",
               "schema: 1\nname: bad\nmotion: {type: segments, segments: [{duration_s: 1}]}\n"
               "sensors: [{name: gps, type: gnss, zones: []}]\n");
  expectRefusal({"simulate", "bad.yaml", "--out", "x"}, 3, "bad.yaml");
  expectOk({"simulate", lane_, "--set", "duration_s=1", "--out", "twice", "-q"});
  expectRefusal({"simulate", lane_, "--set", "duration_s=1", "--out", "twice"}, 3, "--force");
  expectOk({"simulate", lane_, "--set", "duration_s=1", "--out", "twice", "--force", "-q"});
  expectRefusal({"replay", config_, "--set", "log.file=a.rawlog"}, 3, "either log or scenario");
}

}  // namespace pos::replay
